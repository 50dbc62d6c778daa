// The recorded tables of chapters 2 and 3: computed again, errors and orders are the same, and work is, count by count.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "results/file/run_file.hpp"
#include "results/provenance.hpp"
#include "verify/support/bench_integrators.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::baselines_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const fs::path folder = fs::path(DRAPE_SOURCE_DIR) / "results/baselines";
const Words studies{"convergence", "figure-3.2", "figure-3.3", "modes", "orders", "table-3.1", "table-3.2"};

class Baseline : public testing::TestWithParam<std::string> {};

TEST_P(Baseline, IsComputedAnew) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  program.output({"study", GetParam(), "--quick", "--out", "now.h5"});
  const fs::path recorded = folder / "quick" / (GetParam() + ".h5");
  const ProgramResult result = program.run({"compare", "--no-times", recorded.string(), "now.h5"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("accuracy: same ("), HasSubstr("work: same (")))
      << "if that is right, record it: results/baselines/record";
}

INSTANTIATE_TEST_SUITE_P(, Baseline, testing::ValuesIn(studies), [](const auto& test) {
  std::string name = test.param;
  std::ranges::replace_if(
      name, [](char c) { return c == '-' || c == '.'; }, '_');
  return name;
});

TEST(Baselines, AreFinishedAndOfCommittedSources) {
  DRAPE_SLOW();
  for (const std::string& study : studies)
    for (const fs::path& file : {folder / (study + ".h5"), folder / "quick" / (study + ".h5")}) {
      const results::Provenance provenance = results::read_provenance(file);
      EXPECT_THAT(results::value_of(provenance, "git_commit"), AllOf(Not(""), Not(HasSubstr("dirty")))) << file;
      EXPECT_NE(results::value_of(provenance, "finished"), "") << file;
      EXPECT_FALSE(results::read_tables(file).empty()) << file;
    }
}

}  // namespace
}  // namespace drape::verify::baselines_test
