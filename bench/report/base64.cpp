#include "bench/report/base64.hpp"

#include <algorithm>
#include <stdexcept>

namespace drape::bench {
namespace {

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

std::string base64(std::span<const std::byte> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const auto at = [&](std::size_t i) { return i < bytes.size() ? std::to_integer<unsigned>(bytes[i]) : 0U; };
    const unsigned group = at(k) << 16 | at(k + 1) << 8 | at(k + 2);
    const std::size_t kept = std::min<std::size_t>(bytes.size() - k, 3) + 1;  // digits that carry bits of the bytes
    for (std::size_t i = 0; i < 4; ++i) text += i < kept ? digits[group >> (18 - 6 * i) & 63] : '=';
  }
  return text;
}

std::vector<std::byte> bytes_of_base64(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() * 3 / 4);
  unsigned group = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const std::size_t digit = digits.find(text[k]);
    if (digit == std::string_view::npos) throw std::invalid_argument("expected a text in base 64");
    group = group << 6 | static_cast<unsigned>(digit);
    if (k % 4 > 0) bytes.push_back(static_cast<std::byte>(group >> (6 - 2 * (k % 4)) & 255));
  }
  return bytes;
}

}  // namespace drape::bench
