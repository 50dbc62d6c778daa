#include "solver/base/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include "solver/base/descriptor.hpp"
#include "solver/base/temporary.hpp"

namespace drape::base {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void refuse_existing(const fs::path& file) {
  throw FileError(fmt::format("{} exists; choose another --out or remove it", file.string()));
}

/// Throws FileError if the system cannot say, as of a name that is too long.
bool is_there(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (status.type() == fs::file_type::none)
    throw FileError(fmt::format("{}: cannot be used ({})", path.string(), error.message()));
  return fs::exists(status);
}

/// The file under another name in the same folder: only within a file system can it be renamed.
Temporary temporary_beside(const fs::path& file) {
  try {
    return {folder_of(file), Temporary::Kind::file};
  } catch (const std::system_error& error) {
    errno = error.code().value();
    fail_to_create_beside(file);
  }
}

}  // namespace

void require_creatable(const fs::path& file) {
  if (is_there(file)) refuse_existing(file);
  const Temporary attempt =
      temporary_beside(file);  // the only test that knows of rights, full and read-only file systems alike
}

void create_folder(const fs::path& folder, std::string_view advice) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError(fmt::format("{}: cannot be created ({}){}", folder.string(), error.message(), advice));
}

void require_empty_folder(const fs::path& folder, std::string_view content) {
  std::error_code none;  // then there is nothing in it
  if (is_there(folder) && !(fs::is_directory(folder, none) && fs::is_empty(folder, none)))
    throw FileError(fmt::format("{}: expected a new or empty folder for {}", folder.string(), content));
  fs::path existing = folder;
  while (!is_there(existing)) existing = folder_of(existing);
  const TemporaryFolder attempt(existing);  // trying is the only test that knows of rights, full and read-only file systems
}

void publish_folder(const fs::path& folder, const std::map<std::string, std::string>& files) {
  const fs::path absolute = fs::absolute(folder).lexically_normal();
  const fs::path target = absolute.has_filename() ? absolute : absolute.parent_path();
  create_folder(target.parent_path());
  const TemporaryFolder beside(target.parent_path());  // in the same file system, so that a rename does
  const fs::path made = beside / "new";
  create_folder(made);
  for (const auto& [name, content] : files) publish(made / name, std::as_bytes(std::span(content)), Existing::refuse);
  if (std::rename(made.c_str(), target.c_str()) != 0) fail(folder, "cannot be created");
}

void publish(const fs::path& file, std::span<const std::byte> content, Existing existing) {
  const Temporary temporary = temporary_beside(file);
  write_all(file, temporary.descriptor(), content);
  if (existing == Existing::replace) {
    if (std::rename(temporary.path().c_str(), file.c_str()) != 0) fail(file, "cannot be replaced");
  } else if (link(temporary.path().c_str(), file.c_str()) != 0) {  // unlike a rename, fails if the file appeared meanwhile
    if (errno == EEXIST) refuse_existing(file);
    fail(file, "cannot be created");
  }
  const Descriptor folder(open(folder_of(file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.fd < 0 || fsync(folder.fd) != 0) fail(file, "its folder cannot be synchronised");
}

}  // namespace drape::base
