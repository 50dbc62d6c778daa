#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "solver/base/atomic_file.hpp"

/// What those who write files and start processes share of the operating system's files.
namespace drape::base {

/// Owns an open file; one that could not be opened is negative.
struct Descriptor {
  int fd;
  explicit Descriptor(int opened) : fd(opened) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd >= 0) close(fd);
  }
};

/// Throws FileError with the reason that the system gave last.
[[noreturn]] inline void fail(const std::filesystem::path& file, std::string_view what) {
  throw FileError(fmt::format("{}: {} ({})", file.string(), what, std::generic_category().message(errno)));
}

inline std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

[[noreturn]] inline void fail_to_create_beside(const std::filesystem::path& file) {
  fail(file, fmt::format("cannot create files in the folder {}", folder_of(file).string()));
}

/// Writes all of it to the disk, or throws FileError that names `file`.
inline void write_all(const std::filesystem::path& file, int fd, std::span<const std::byte> content) {
  while (!content.empty()) {
    const ssize_t written = ::write(fd, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(file, "cannot be written");
    content = content.subspan(static_cast<std::size_t>(written));
  }
  if (fsync(fd) != 0) fail(file, "cannot be written");
}

/// All bytes of a file that is open for reading, wherever it stands. Throws std::system_error that names `what`.
inline std::vector<std::byte> bytes_of(const Descriptor& file, const std::string& what) {
  const off_t size = lseek(file.fd, 0, SEEK_END);
  std::vector<std::byte> bytes(static_cast<std::size_t>(std::max<off_t>(size, 0)));
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t n = pread(file.fd, bytes.data() + at, bytes.size() - at, static_cast<off_t>(at));
    if (n <= 0) throw std::system_error(errno, std::generic_category(), what);
    at += static_cast<std::size_t>(n);
  }
  return bytes;
}

}  // namespace drape::base
