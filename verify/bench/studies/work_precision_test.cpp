// Who wins at which error: the front of hand-made candidates, and the study's quick form.

#include "results/analysis/work_precision.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "results/file/run_file.hpp"
#include "verify/support/bench_integrators.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::work_precision_test {
namespace {

using results::Measured;
using results::near_quickest;
using results::quickest;
using results::Table;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Optional;
using testing::SizeIs;

const double failed = std::nan("");

TEST(Quartiles, AreOfTheTimesInAnyOrder) {
  const auto q = results::quartiles({5, 1, 3, 2, 4});
  EXPECT_EQ(q.lower, 2);
  EXPECT_EQ(q.median, 3);
  EXPECT_EQ(q.upper, 4);
  EXPECT_EQ(results::quartiles({1, 2}).median, 1.5);
  EXPECT_EQ(results::quartiles({7}).upper, 7);
  EXPECT_THROW(results::quartiles({}), std::invalid_argument);
}

TEST(Quickest, HasAnErrorOfAtMostWhatIsAskedFor) {
  const std::vector<Measured> all{{1e-2, {1}}, {1e-3, {4}}, {1e-4, {3}}, {1e-5, {9}}};
  EXPECT_THAT(quickest(all, 1e-2), Optional(0u)) << "at most: the same counts";
  EXPECT_THAT(quickest(all, 0.99e-2), Optional(2u)) << "nothing between two points is made up, and the slower is no winner";
  EXPECT_THAT(quickest(all, 2e-5), Optional(3u));
  EXPECT_FALSE(quickest(all, 0.99e-5));
}

TEST(Quickest, IsNoFailure) {
  const std::vector<Measured> all{{failed, {}}, {1e-9, {}}, {failed, {1}}, {1e-3, {5}}};
  EXPECT_THAT(quickest(all, 1e-2), Optional(3u));
  EXPECT_FALSE(quickest(std::vector<Measured>{{INFINITY, {1}}}, INFINITY));
}

TEST(Quickest, GoesByTheMedian) {
  const std::vector<Measured> all{{1e-3, {1, 9, 9}}, {1e-3, {5, 5, 100}}};
  EXPECT_THAT(quickest(all, 1), Optional(1u));
}

TEST(NearQuickest, IsTheQuickestAtEveryError) {
  const std::vector<Measured> all{{1e-2, {1}}, {1e-3, {4}}, {1e-4, {3}}, {failed, {}}, {1e-5, {9}}, {1e-5, {10}}, {0.5, {2}}};
  EXPECT_THAT(near_quickest(all, std::vector{1.0, 1e-2, 1e-3, 1e-5, 1e-6}, 1), ElementsAre(0, 2, 4));
  EXPECT_THAT(near_quickest(all, std::vector{1e-5}, 1), ElementsAre(4));
  EXPECT_THAT(near_quickest(all, std::vector<double>{}, 1), ElementsAre());
}

TEST(NearQuickest, IsWhatIsALittleSlower) {
  const std::vector<Measured> all{{1e-2, {1}}, {1e-3, {4}}, {1e-4, {3}}, {1e-5, {9}}, {1e-5, {14}}, {0.5, {2}}};
  const std::vector errors{1.0, 1e-3, 1e-5};
  EXPECT_THAT(near_quickest(all, errors, 1.5), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(near_quickest(all, errors, 2), ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(Tie, IsAGapBelowTheNoise) {
  const Measured a{1, {10, 11, 12, 13, 14}}, near{1, {12, 13, 14, 15, 16}}, far{1, {14, 15, 16, 17, 18}};
  EXPECT_TRUE(tied(a, near));
  EXPECT_TRUE(tied(near, a));
  EXPECT_FALSE(tied(a, far));
  EXPECT_FALSE(tied(far, a));
  EXPECT_TRUE(tied(a, a));
}

TEST(RatioOfMedians, IsWithinItsInterval) {
  const Measured slow{1, {20, 21, 22, 19, 20, 40, 20}}, quick{1, {10, 10.5, 9.5, 10, 11, 10, 30}};
  const auto interval = results::ratio_of_medians(slow, quick);
  EXPECT_LE(interval.lower, 2);
  EXPECT_GE(interval.upper, 2);
  EXPECT_GT(interval.lower, 1.5);
  EXPECT_LT(interval.upper, 2.5) << "outliers have no weight";
}

TEST(RatioOfMedians, IsAsUncertainAsTheTimes) {
  const Measured steady{1, {10, 10, 10, 10, 10}}, noisy{1, {5, 15, 10, 20, 8}};
  EXPECT_EQ(results::ratio_of_medians(steady, steady).lower, 1);
  EXPECT_EQ(results::ratio_of_medians(steady, steady).upper, 1);
  const auto interval = results::ratio_of_medians(noisy, steady);
  EXPECT_LE(interval.lower, 0.8);
  EXPECT_GE(interval.upper, 1.5);
}

// --- The study ---------------------------------------------------------------------------------------------------------------

/// The cells of a column as text; empty ones for those without.
std::vector<std::string> texts(const Table& table, const char* name) {
  std::vector<std::string> found;
  const results::Column* column = results::find_column(table, name);
  for (std::size_t row = 0; column != nullptr && row < results::rows(table); ++row)
    found.push_back(results::text_in(column, row));
  return found;
}

const Table& table(const std::vector<Table>& all, const std::string& name) {
  const auto found = std::ranges::find(all, name, &Table::name);
  if (found == all.end()) throw std::out_of_range("no table " + name);
  return *found;
}

class WorkPrecision : public testing::Test {
 protected:
  const BenchIntegrators program;
};

TEST_F(WorkPrecision, NamesWinnersAndJudgesTheBars) {
  DRAPE_SLOW();
  program.run({"study", "bars", "--quick", "--out", "study.h5"});
  const auto all = results::read_tables(program.folder() / "study.h5");
  ASSERT_THAT(all, SizeIs(11));
  for (const char* name : {"trials: hung-corners d=5", "trials: peer-edge n=8"}) {
    const auto codes = texts(table(all, name), "code");
    for (const char* code :
         {"drape", "explicit", "thesis", "cvode-bdf", "arkode-esdirk", "arkode-imex", "arkode-steps", "ida-bdf"})
      EXPECT_THAT(codes, testing::Contains(code)) << name;
  }
  for (const char* name : {"winners", "recommended", "held-out"})
    EXPECT_THAT(table(all, name).description, HasSubstr("SUNDIALS 6")) << name;
  EXPECT_THAT(texts(table(all, "trials: hung-corners d=5"), "build"), testing::Each(HasSubstr("compiled with")));
  const Table& winners = table(all, "winners");
  for (std::size_t row = 0; row < results::rows(winners); ++row)
    EXPECT_EQ(results::number_in(results::find_column(winners, "our_families"), row),
              results::number_in(results::find_column(winners, "sundials_families"), row));
  const Table &quickest = table(all, "quickest"), &summary = table(all, "peers-summary");
  EXPECT_TRUE(quickest.headline && summary.headline);
  EXPECT_THAT(texts(quickest, "ours"), AllOf(SizeIs(testing::Ge(10)), testing::Each(Not(IsEmpty()))));
  EXPECT_THAT(texts(summary, "scene"), testing::Contains("hung-corners d=5"));
  for (std::size_t row = 0; row < results::rows(summary); ++row)
    EXPECT_LE(results::number_in(results::find_column(summary, "least"), row),
              results::number_in(results::find_column(summary, "largest"), row));
  const auto bars = texts(table(all, "bars"), "verdict");
  EXPECT_THAT(bars, testing::Each(testing::AnyOf(testing::StartsWith("met"), testing::StartsWith("missed: not met"))));
  EXPECT_THAT(bars, SizeIs(testing::Ge(15)));
  EXPECT_THAT(texts(table(all, "winners"), "best"), AllOf(SizeIs(testing::Ge(10)), testing::Each(Not(IsEmpty()))));
}

TEST_F(WorkPrecision, JudgesAnyScene) {
  DRAPE_SLOW();
  program.run({"study", "work-precision", "--quick", "--scene", "hung-edge", "--set", "grid.n=5", "--set", "end.time=0.1",
               "--out", "study.h5"});
  const auto all = results::read_tables(program.folder() / "study.h5");
  EXPECT_THAT(texts(table(all, "winners"), "scene"), testing::Each(std::string("hung-edge")));
  EXPECT_THAT(texts(table(all, "trials: hung-edge"), "code"), testing::Contains("cvode-bdf"));
}

}  // namespace
}  // namespace drape::verify::work_precision_test
