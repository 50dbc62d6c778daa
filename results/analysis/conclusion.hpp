#pragma once

#include <span>

#include "results/file/run_file.hpp"

namespace drape::results {

/// What some files come to, in words: a sentence a row. Every number in it is in their runs and tables.
Table conclusion(std::span<const Recording> recordings);

}  // namespace drape::results
