#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace drape::base {

/// A file that is not read; what() says why, but not which file.
struct UnreadableFile : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws UnreadableFile unless this is a regular file of at most this number of bytes: devices and pipes never end, or never
/// begin.
void require_input_file(const std::filesystem::path& file, std::uintmax_t most_bytes);

/// The bytes of a regular file. Throws UnreadableFile, also if the file is larger than this or grows beyond it.
std::string content_of(const std::filesystem::path& file, std::uintmax_t most_bytes);

/// "4 MB" of 2^20 bytes each, rounded up.
std::string in_megabytes(std::uintmax_t bytes);

}  // namespace drape::base
