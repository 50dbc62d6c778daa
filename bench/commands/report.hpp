#pragma once

#include <filesystem>
#include <vector>

namespace drape::bench {

/// Writes a page about recorded files to index.html in the folder, which is made if need be, and prints what they come to and
/// where the page is. Throws base::FileError.
void report(const std::vector<std::filesystem::path>& files, const std::filesystem::path& folder);

}  // namespace drape::bench
