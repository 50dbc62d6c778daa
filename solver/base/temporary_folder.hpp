#pragma once

#include <filesystem>
#include <string>

#include "solver/base/temporary.hpp"

namespace drape::base {

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
