#include "solver/base/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

namespace drape::base {
namespace {

constexpr int usual_columns = 80;

/// Bytes that begin a character of UTF-8.
int width_of(std::string_view text) {
  return static_cast<int>(std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

int columns_of(int descriptor) {
  winsize size{};
  return ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual_columns;
}

bool wants_colours(int descriptor) {
  const auto value_of = [](const char* variable) {
    const char* value = std::getenv(variable);
    return std::string_view(value == nullptr ? "" : value);
  };
  const std::string_view kind = value_of("TERM");
  return isatty(descriptor) == 1 && !kind.empty() && kind != "dumb" && value_of("NO_COLOR").empty();
}

std::string wrapped(std::string_view text, int width, int indent) {
  const std::string line_break = '\n' + std::string(static_cast<std::size_t>(indent), ' ');
  std::string lines;
  int column = 0;
  while (!text.empty()) {
    const auto end = text.find_first_of(" \n");
    const std::string_view word = text.substr(0, end);
    const bool fits = column == 0 || column + 1 + width_of(word) <= width;
    lines += column == 0 ? "" : fits ? " " : line_break;
    lines += word;
    column = (fits ? column + (column > 0) : 0) + width_of(word);
    const bool broken = end != std::string_view::npos && text[end] == '\n';
    if (broken) {
      lines += line_break;
      column = 0;
    }
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

}  // namespace drape::base
