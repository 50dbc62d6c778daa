#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace drape::base {

/// A file that cannot be written or read. The message names it and says what is wrong.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws FileError unless there is no such file yet and its folder lets us create one.
void require_creatable(const std::filesystem::path& file);

/// Creates a folder and those it lies in, unless they are there. Throws FileError, with `advice` at its end.
void create_folder(const std::filesystem::path& folder, std::string_view advice = {});

/// Throws FileError if there is something in the folder, which need not exist. `content`: what it is wanted for.
void require_empty_folder(const std::filesystem::path& folder, std::string_view content);

/// Whether publish() may take the place of a file that is already there.
enum class Existing { refuse, replace };

/// Makes `content` the file in one step: at any time, even after a crash, readers find all of it or the previous file.
/// Throws FileError and leaves nothing half-written, neither in the file nor beside it.
void publish(const std::filesystem::path& file, std::span<const std::byte> content, Existing existing);

/// Makes a new or empty folder one with these files, all of them or none. Throws FileError and leaves nothing beside it.
void publish_folder(const std::filesystem::path& folder, const std::map<std::string, std::string>& files);

}  // namespace drape::base
