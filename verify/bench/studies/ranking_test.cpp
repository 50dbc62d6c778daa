// Who is how quick over several scenes: hand-made runs with known ratios.

#include "bench/studies/work_precision/ranking.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "results/columns.hpp"

namespace drape::verify::ranking_test {
namespace {

using bench::Code;
using bench::SceneRuns;
using results::Table;

const solver::Method* const a = &solver::method("bdf2");
const solver::Method* const b = &solver::method("sbdf2");

struct TimedRun {
  Code code;
  const solver::Method* by_default;
  double error, time;
  bool timed = true;
};

SceneRuns scene(const std::string& name, const std::vector<TimedRun>& list, double uncertainty = 1e-9) {
  SceneRuns all{{.name = name, .scene = {}, .uncertainty = uncertainty}, {}, {}};
  all.configurations.reserve(list.size());
  for (const TimedRun& run : list) {
    const bench::Configuration& configuration =
        all.configurations.emplace_back(bench::Configuration{name, run.code, bench::Control::step, run.by_default});
    all.runs.push_back({.configuration = &configuration, .measured = {run.error, {run.time}}, .timed = run.timed});
  }
  return all;
}

/// The row of a method at an error of 1e-1 to 1e-7.
struct Row {
  double scenes = NAN, reached = NAN, mean = NAN, least = NAN, largest = NAN;
};

Row row_of(const Table& ranking, const solver::Method* method, int digits) {
  const auto number = [&](const char* column, std::size_t row) { return number_in(find_column(ranking, column), row); };
  for (std::size_t row = 0; row < rows(ranking); ++row)
    if (text_in(find_column(ranking, "method"), row) == method->name &&
        std::lround(-std::log10(number("error", row))) == digits)
      return {number("scenes", row), number("reached", row), number("mean", row), number("least", row), number("largest", row)};
  return {};
}

TEST(Ranking, IsTheGeometricMeanAndTheRangeOverTheScenesThatAreReached) {
  std::vector<SceneRuns> scenes;
  scenes.push_back(scene(
      "one", {{Code::drape, {}, 1e-4, 1}, {Code::drape, a, 1e-4, 2}, {Code::drape, a, 1e-2, 1.5}, {Code::drape, b, 5e-2, 3}}));
  scenes.push_back(scene("two", {{Code::explicit_steps, {}, 1e-4, 2}, {Code::drape, a, 1e-4, 16}, {Code::drape, b, NAN, 0}}));
  const Table ranking = bench::ranking_table(scenes);
  const Row fine = row_of(ranking, a, 4), coarse = row_of(ranking, a, 1), some = row_of(ranking, b, 1),
            none = row_of(ranking, b, 4);
  EXPECT_EQ(fine.reached, 2);
  EXPECT_NEAR(fine.mean, 4, 1e-12) << "of 2 and 8";
  EXPECT_EQ(fine.least, 2);
  EXPECT_EQ(fine.largest, 8);
  EXPECT_EQ(coarse.least, 1.5) << "the coarser of its runs is quicker";
  EXPECT_EQ(some.scenes, 2);
  EXPECT_EQ(some.reached, 1);
  EXPECT_DOUBLE_EQ(some.mean, 3);
  EXPECT_EQ(none.scenes, 2);
  EXPECT_EQ(none.reached, 0);
  EXPECT_TRUE(std::isnan(none.mean) && std::isnan(none.least) && std::isnan(none.largest));
}

TEST(Ranking, CountsOnlyOursTimedRepeatedlyWhereTheReferenceResolvesTheError) {
  const std::vector<TimedRun> list{{Code::cvode_bdf, {}, 1e-4, 0.1},
                                   {Code::drape, {}, 1e-4, 0.5, false},
                                   {Code::drape, {}, 1e-4, 1},
                                   {Code::drape, a, 1e-4, 3}};
  std::vector<SceneRuns> scenes;
  scenes.push_back(scene("one", list));
  const Table all = bench::ranking_table(scenes);
  EXPECT_DOUBLE_EQ(row_of(all, a, 3).mean, 3);
  EXPECT_EQ(row_of(all, a, 3).scenes, 1);
  EXPECT_TRUE(std::isnan(row_of(all, a, 5).scenes)) << "nothing of ours reaches it";
  scenes[0].problem.uncertainty = 1e-4;
  const Table uncertain = bench::ranking_table(scenes);
  EXPECT_DOUBLE_EQ(row_of(uncertain, a, 3).mean, 3);
  EXPECT_TRUE(std::isnan(row_of(uncertain, a, 4).scenes));
}

TEST(Ranking, OfNothingIsEmpty) { EXPECT_EQ(rows(bench::ranking_table({})), 0u); }

}  // namespace
}  // namespace drape::verify::ranking_test
