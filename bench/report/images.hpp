#pragma once

#include <cstddef>
#include <filesystem>

namespace drape::bench {

/// Writes every figure of a report's page as SVG and PNG (900 pixels wide, of PNG 2700; on white) to a folder, all or none: the
/// page draws them itself, in Chromium. Older pictures in the folder are replaced. Returns how many figures there are. Throws
/// std::invalid_argument if there is no Chromium, base::FileError if there is anything but pictures in the folder or it
/// cannot be written, std::runtime_error if Chromium has not drawn them, Interrupted.
std::size_t write_images(const std::filesystem::path& page, const std::filesystem::path& folder);

}  // namespace drape::bench
