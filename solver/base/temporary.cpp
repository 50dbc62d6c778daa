#include "solver/base/temporary.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>

#include "solver/base/atomic_file.hpp"

namespace drape::base {
namespace fs = std::filesystem;
namespace {

Temporary folder_in(const fs::path& parent, const std::string& name) {
  try {
    return {parent, Temporary::Kind::folder};
  } catch (const std::system_error& error) {
    throw FileError(fmt::format("{}: cannot create files in it ({})", name, error.code().message()));
  }
}

constexpr std::string_view prefix = ".drape-tmp-";  // of names that are ours alone to remove

bool is_temporary(std::string_view name) {
  return name.starts_with(prefix) && name.find_first_not_of("0123456789-", prefix.size()) == std::string_view::npos;
}

fs::path next_name(const fs::path& folder) {
  static std::atomic<int> count = 0;
  return folder / (std::string(prefix) + std::to_string(getpid()) + "-" + std::to_string(count++));
}

/// A new entry, opened; negative with the reason in errno.
int create(const fs::path& path, Temporary::Kind kind) {
  if (kind == Temporary::Kind::file) return open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (mkdir(path.c_str(), 0700) != 0) return -1;
  const int fd = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0 && errno == ENOENT) errno = EAGAIN;
  return fd;
}

/// Whether an entry can be locked; where the file system has no locks, no other process can lock it either.
bool locked(int fd) { return flock(fd, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK; }

}  // namespace

bool is_at(int fd, const fs::path& path) {
  struct stat opened {
  }, named{};
  return fstat(fd, &opened) == 0 && lstat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

fs::path system_folder() {
  const char* named = std::getenv("TMPDIR");
  return named == nullptr || *named == 0 ? "/tmp" : named;
}

TemporaryFolder::TemporaryFolder()
    : folder_(folder_in(system_folder(), fmt::format("TMPDIR, the folder for temporary files, {}", system_folder().string()))) {
}

TemporaryFolder::TemporaryFolder(const fs::path& parent) : folder_(folder_in(parent, parent.string())) {}

Temporary::Temporary(const fs::path& folder, Kind kind) {
  remove_leftovers(folder);
  constexpr int attempts = 1000;  // another process may take a new entry for a leftover until it is locked
  for (int k = 0; k < attempts; ++k) {
    path_ = next_name(folder);
    fd_ = create(path_, kind);
    if (fd_ < 0 && errno != EEXIST && errno != EAGAIN) break;
    if (fd_ < 0) continue;
    if (locked(fd_) && is_at(fd_, path_)) return;
    close(fd_);
    errno = EAGAIN;
  }
  throw std::system_error(errno, std::generic_category(), path_.string());
}

Temporary::~Temporary() {
  std::error_code ignored;  // a destructor has no caller to tell
  if (is_at(fd_, path_)) fs::remove_all(path_, ignored);
  close(fd_);
}

void remove_leftovers(const fs::path& folder) {
  std::error_code ignored;
  for (fs::directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
    const fs::path& path = entry->path();
    if (!is_temporary(path.filename().native())) continue;
    const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (fd < 0) continue;
    if (flock(fd, LOCK_EX | LOCK_NB) == 0 && is_at(fd, path)) fs::remove_all(path, ignored);
    close(fd);
  }
}

}  // namespace drape::base
