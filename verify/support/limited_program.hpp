#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "verify/support/bench_integrators.hpp"

namespace drape::verify {

/// What the program does with input that may mean harm; expects it to end by itself within a minute, with exit code 0, 1 or 2,
/// at most one line on standard error and at most 300 MiB of memory.
ProgramResult run_limited(const BenchIntegrators& program, const Words& words);

std::vector<std::byte> content_of(const std::filesystem::path& file);

}  // namespace drape::verify
