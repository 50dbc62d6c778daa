#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drape::results {

/// All deviations of a file from the layout in results/README.md, one sentence each, beginning with the path in the file: what
/// is missing, what is too many, wrong types, shapes and units, missing descriptions, and shapes that do not belong together.
/// Empty for a good file. Throws FileError if it cannot be read as HDF5.
std::vector<std::string> validate(const std::filesystem::path& path);

}  // namespace drape::results
