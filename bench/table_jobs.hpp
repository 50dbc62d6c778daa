#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/studies.hpp"

namespace drape::bench {

/// Computes all tables; after each it is on disk in `out`. Progress on a terminal.
std::vector<results::Table> compute(const std::vector<TableJob>& jobs, const std::filesystem::path& out,
                                    const std::string& command_line);

}  // namespace drape::bench
