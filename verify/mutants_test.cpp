// The planted defects follow the sources: each one still applies to them.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "verify/support/run_program.hpp"

namespace drape::verify::mutants_test {
namespace {

namespace fs = std::filesystem;

const fs::path root = DRAPE_SOURCE_DIR;

std::vector<fs::path> patches() {
  std::vector<fs::path> all;
  for (const fs::directory_entry& entry : fs::directory_iterator(root / "verify/mutants"))
    if (entry.path().extension() == ".patch") all.push_back(entry.path());
  std::ranges::sort(all);
  return all;
}

TEST(PlantedDefects, ApplyToTheSources) {
  ASSERT_GE(patches().size(), 200u);
  for (const fs::path& patch : patches()) {
    const ProgramResult result = run_program({.program = "/usr/bin/patch",
                                              .arguments = {"-p1", "--dry-run", "--reject-file=-", "--input", patch.string()},
                                              .folder = root,
                                              .environment = {},
                                              .output = {}});
    EXPECT_EQ(result.exit_code, 0) << patch.filename() << ": " << result.out << result.err;
  }
}

}  // namespace
}  // namespace drape::verify::mutants_test
