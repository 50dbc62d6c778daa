#pragma once

#include <string_view>

namespace drape::model {

/// The line, counted from 1, on which a TOML text nests lists and tables, or the parts of a key, deeper than `most`; 0 if there
/// is none. What reads TOML calls itself for each level, and would end with its stack.
int line_nested_deeper(std::string_view toml, int most);

}  // namespace drape::model
