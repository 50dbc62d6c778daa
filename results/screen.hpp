#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

#include "results/table.hpp"

namespace drape::results {

/// What users read tables on.
struct Screen {
  std::size_t columns = std::numeric_limits<std::size_t>::max();
  bool colours = false;
};

/// The table as to_text() has it, in lines that fit the screen. Where they do not, texts and titles are broken into several
/// lines, and columns are left out until the others fit: notes first, then by their roles, but the first column of a role after
/// the others of all roles, and keys never. A last line names what is left out. With colours, what is good is green and what is
/// not is red: outcomes, verdicts, and errors of runs that failed.
std::string to_text(const Table& table, const Screen& screen);

/// The text in a cell. `number` is a format for doubles: "{}" gives the shortest text that reads back as the same number.
std::string to_text(const Datum& cell, std::string_view number);

}  // namespace drape::results
