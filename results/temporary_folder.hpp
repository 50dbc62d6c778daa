#pragma once

#include <filesystem>
#include <string>

#include "solver/temporary.hpp"

namespace drape::results {

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
  solver::Temporary folder_;
};

}  // namespace drape::results
