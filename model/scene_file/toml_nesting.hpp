#pragma once

#include <toml++/toml.h>

#include <string_view>

namespace drape::model {

/// The line, counted from 1, on which a TOML text nests lists and tables, or the parts of a key, deeper than `most`; 0 if there
/// is none. What reads TOML calls itself for each level, and would end with its stack.
int line_nested_deeper(std::string_view toml, int most);

/// Levels that files of ours may have.
constexpr int most_toml_levels = 16;

/// The table of a text. Throws SceneError with origin and line, which says `nested_deeper` of more than these levels, and else
/// what is not TOML.
toml::table parse_toml(std::string_view text, std::string_view origin, std::string_view nested_deeper);

}  // namespace drape::model
