#pragma once

#include <span>
#include <string>

#include "results/run_record.hpp"

namespace drape::results {

/// One line per run, aligned for people: the columns that matter most, four digits. A run that failed shows how and when in
/// place of its error; an error below ten times its reference's own is shown as less than that. Columns that no run has a
/// value for are left out.
std::string to_table(std::span<const RunRecord> runs);

/// All columns with a header (RFC 4180, but lines end with a line feed). Numbers read back as the same numbers; a cell is
/// empty where there is no value.
std::string to_csv(std::span<const RunRecord> runs);

/// A list of objects with the columns of to_csv() as keys; null where there is no value or no finite one.
std::string to_json(std::span<const RunRecord> runs);

}  // namespace drape::results
