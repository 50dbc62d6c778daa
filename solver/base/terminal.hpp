#pragma once

#include <string>
#include <string_view>

namespace drape::base {

/// Columns of the terminal behind a file descriptor, 80 if it is none or does not say.
int columns_of(int descriptor);

/// Whether it is a terminal that shows colours, and its user wants them: the environment has no NO_COLOR (no-color.org).
bool wants_colours(int descriptor);

/// The text broken at spaces into lines of at most `width` columns, those after the first behind `indent` spaces more. Longer
/// words stay whole, and so do line breaks.
std::string wrapped(std::string_view text, int width, int indent = 0);

}  // namespace drape::base
