#pragma once

#include "results/table.hpp"

/// Files of schema versions 4 and 5 do not say which columns are outcomes, what their figures take columns for, for whom a
/// table is, and whether its rows depend on times: it is known by names and texts.
namespace drape::results {

/// Gives a table of such a file what a newer one says.
void complete(Table& table);

}  // namespace drape::results
