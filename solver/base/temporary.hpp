#pragma once

#include <filesystem>
#include <string>

namespace drape::base {

/// A new file or folder under a name of its own, locked as long as its process lives and removed at the end of the scope unless
/// it has been renamed. What killed processes have left in the folder is removed first.
class Temporary {
 public:
  enum class Kind { file, folder };

  /// Throws std::system_error.
  Temporary(const std::filesystem::path& folder, Kind kind);
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary();

  const std::filesystem::path& path() const { return path_; }
  int descriptor() const { return fd_; }  ///< of a file open for writing

 private:
  std::filesystem::path path_;
  int fd_ = -1;
};

/// Removes what killed processes have left of their temporaries in a folder: those whose lock is free. The system frees a lock
/// when its process ends, on network file systems too, and numbers of processes that are given twice do not matter. Errors are
/// ignored: leftovers do no harm.
void remove_leftovers(const std::filesystem::path& folder);

/// Whether a descriptor is still what a path names: who holds its lock may have removed it.
bool is_at(int fd, const std::filesystem::path& path);

/// The folder that TMPDIR names, or else /tmp.
std::filesystem::path system_folder();

/// A new folder that is gone, with all it contains, at the end of the scope; if its process is killed before, when the next one
/// makes such a folder.
class TemporaryFolder {
 public:
  /// In the folder that TMPDIR names, or else in /tmp. Throws FileError.
  TemporaryFolder();

  /// Throws FileError.
  explicit TemporaryFolder(const std::filesystem::path& parent);

  std::filesystem::path operator/(const std::string& name) const { return path() / name; }
  const std::filesystem::path& path() const { return folder_.path(); }

 private:
  Temporary folder_;
};

}  // namespace drape::base
