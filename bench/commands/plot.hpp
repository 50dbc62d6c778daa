#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace drape::bench {

/// Draws an HDF5 file by one of the scripts beside this header; the pictures are written beside the file. Returns what the
/// script says: the pictures' names, or, since results are complete without pictures, why there are none.
std::string plot(std::string_view script, const std::filesystem::path& file);

}  // namespace drape::bench
