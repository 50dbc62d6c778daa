#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string_view>

namespace drape::base {

/// What names of rows that plugins add are made of.
constexpr std::string_view row_name_rule = "expected a name of small letters, digits and '-', 60 at most";

/// Whether a text is such a name: it stands on command lines, in files and in keys of scenes.
inline bool is_row_name(std::string_view text) {
  constexpr std::size_t longest = 60;
  const auto plain = [](unsigned char c) { return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '-'; };
  return !text.empty() && text.size() <= longest && std::ranges::all_of(text, plain);
}

}  // namespace drape::base
