#include "bench/report/base64.hpp"

#include <algorithm>

namespace drape::bench {

std::string base64(std::span<const std::byte> bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
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

}  // namespace drape::bench
