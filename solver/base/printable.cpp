#include "solver/base/printable.hpp"

#include <algorithm>
#include <array>

namespace drape::base {
namespace {

constexpr std::string_view digits = "0123456789abcdef";

/// The first character of a UTF-8 text; of no bytes if it has none that is valid.
struct Character {
  char32_t code = 0;
  std::size_t bytes = 0;
};

Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  if (byte(0) < 0x80) return {byte(0), 1};
  const std::size_t bytes = byte(0) >= 0xf8 ? 0 : byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : byte(0) >= 0xc0 ? 2 : 0;
  if (bytes == 0 || bytes > text.size()) return {};
  char32_t code = byte(0) & (0x7fu >> bytes);
  for (std::size_t k = 1; k < bytes; ++k) {
    if ((byte(k) & 0xc0u) != 0x80) return {};
    code = code << 6 | (byte(k) & 0x3fu);
  }
  constexpr std::array<char32_t, 5> least{0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  return code < least[bytes] || code > 0x10ffff || surrogate ? Character{} : Character{code, bytes};
}

/// Ranges of characters that are not shown but act: C0 and C1 controls, marks and overrides of direction, separators of lines
/// and paragraphs, and characters without width.
constexpr std::pair<char32_t, char32_t> acting[] = {{0x0, 0x1f},      {0x7f, 0x9f},     {0x61c, 0x61c},
                                                    {0x180e, 0x180e}, {0x200b, 0x200f}, {0x2028, 0x202e},
                                                    {0x2060, 0x206f}, {0xfeff, 0xfeff}, {0xfff9, 0xfffb}};

bool acts(char32_t code) {
  return std::ranges::any_of(acting, [=](const auto& range) { return range.first <= code && code <= range.second; });
}

void append_escape(std::string& out, char32_t code) {
  switch (code) {
    case '\n': out += "\\n"; return;
    case '\r': out += "\\r"; return;
    case '\t': out += "\\t"; return;
    default: break;
  }
  out += "\\u";
  for (int shift = 12; shift >= 0; shift -= 4) out += digits[code >> shift & 0xf];
}

std::string escaped(std::string_view text, bool keep_line_feeds) {
  std::string out;
  while (!text.empty()) {
    const auto [code, bytes] = first_character(text);
    if (bytes == 0) {
      const auto byte = static_cast<unsigned char>(text.front());
      out.append("\\x").append(1, digits[byte >> 4]).append(1, digits[byte & 0xf]);
    } else if (acts(code) && !(keep_line_feeds && code == '\n')) {
      append_escape(out, code);
    } else {
      out += text.substr(0, bytes);
    }
    text.remove_prefix(std::max<std::size_t>(bytes, 1));
  }
  return out;
}

bool begins_character(unsigned char byte) { return (byte & 0xc0u) != 0x80; }

}  // namespace

std::string printable(std::string_view text) { return escaped(text, false); }

std::string printable_lines(std::string_view text) { return escaped(text, true); }

std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, begins_character));
}

std::string shortened(std::string text, std::size_t most) {
  const std::size_t length = characters(text);
  if (length <= most) return text;
  std::size_t end = 0;
  for (std::size_t seen = 0; seen <= most; ++end) seen += begins_character(static_cast<unsigned char>(text[end])) ? 1 : 0;
  text.resize(end - 1);
  return text + "... (" + std::to_string(length) + " characters)";
}

std::string quoted(std::string_view text) {
  constexpr std::size_t most = 200;
  return shortened(printable(text), most);
}

}  // namespace drape::base
