#pragma once

#include <filesystem>
#include <string>

namespace drape::verify {

/// All that is in a file of results but times: facts that do not depend on the start, runs with the number of their times, and
/// tables without their columns of times.
std::string all_but_times(const std::filesystem::path& file);

}  // namespace drape::verify
