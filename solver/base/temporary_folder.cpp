#include "solver/base/temporary_folder.hpp"

#include <fmt/format.h>

#include <cstdlib>
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

fs::path system_folder() {
  const char* named = std::getenv("TMPDIR");
  return named == nullptr || *named == 0 ? "/tmp" : named;
}

}  // namespace

TemporaryFolder::TemporaryFolder()
    : folder_(folder_in(system_folder(), fmt::format("TMPDIR, the folder for temporary files, {}", system_folder().string()))) {
}

TemporaryFolder::TemporaryFolder(const fs::path& parent) : folder_(folder_in(parent, parent.string())) {}

}  // namespace drape::base
