#pragma once

#include <filesystem>
#include <utility>

namespace drape::base {

/// A file that at most one process at a time has locked. The system takes the lock back when its process ends, however it ends.
class LockFile {
 public:
  explicit LockFile(std::filesystem::path path) : path_(std::move(path)) {}
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;
  ~LockFile();  ///< Removes the file if this has locked it.

  /// Makes the file if need be. Returns false if another process has locked it, and true also where the folder or the file
  /// system does not let anyone lock.
  bool try_lock();

 private:
  std::filesystem::path path_;
  int fd_ = -1;
};

}  // namespace drape::base
