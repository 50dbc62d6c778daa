#include "results/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include "results/descriptor.hpp"

namespace drape::results {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void refuse_existing(const fs::path& file) {
  throw FileError(fmt::format("{} exists; choose another --out or remove it", file.string()));
}

/// The file under another name in the same folder (only within a file system can it be renamed), removed at the end.
struct Temporary {
  fs::path path;
  Descriptor out;
  explicit Temporary(const fs::path& file)
      : path(fmt::format("{}.tmp-{}", file.string(), getpid())),
        out(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
    if (out.fd < 0) fail_to_create_beside(file);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() { unlink(path.c_str()); }
};

}  // namespace

void require_creatable(const fs::path& file) {
  std::error_code unknown;  // left to the attempt, whose message is better
  if (fs::exists(fs::symlink_status(file, unknown))) refuse_existing(file);
  const Temporary attempt(file);  // trying is the only test that knows of rights, full and read-only file systems alike
}

void create_folder(const fs::path& folder, std::string_view advice) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError(fmt::format("{}: cannot be created ({}){}", folder.string(), error.message(), advice));
}

void publish(const fs::path& file, std::span<const std::byte> content, Existing existing) {
  const Temporary temporary(file);
  write_all(file, temporary.out.fd, content);
  if (existing == Existing::replace) {
    if (std::rename(temporary.path.c_str(), file.c_str()) != 0) fail(file, "cannot be replaced");
  } else if (link(temporary.path.c_str(), file.c_str()) != 0) {  // unlike a rename, fails if the file appeared meanwhile
    if (errno == EEXIST) refuse_existing(file);
    fail(file, "cannot be created");
  }
  const Descriptor folder(open(folder_of(file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.fd < 0 || fsync(folder.fd) != 0) fail(file, "its folder cannot be synchronised");
}

}  // namespace drape::results
