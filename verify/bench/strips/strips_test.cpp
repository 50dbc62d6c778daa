// The program bench_strips, in several processes on this machine: a sheet in strips moves as in one process and as by the
// ordinary program; messages and reductions are those that the methods need. Skipped where the program was not built.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bench/strips/launch.hpp"
#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/sundials/cvode.hpp"
#include "solver/integrator.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::strips_test {
namespace {

using bench::strips::Problem;
using bench::strips::Rank;
using bench::strips::run_strips;
using bench::strips::Traffic;
using solver::State;
using testing::AllOf;
using testing::HasSubstr;

constexpr int columns = 10, lines = 9;
constexpr double limit = 400;  ///< [s]

/// Pins in every strip, one of them moving, which stretches the sheet around it.
model::Scene sheet(std::vector<model::Override> more = {}) {
  std::vector<model::Override> overrides{{"grid.n", fmt::format("[{}, {}]", columns, lines)},
                                         {"material.damping", "5"},
                                         {"material.contraction", "100"},
                                         {"pins", "[{where = \"left edge\"}, {particles = [[9, 4]], velocity = [0, 0, 10]}]"}};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return model::load_scene("hung-corners", overrides);
}

Problem problem(const std::string& method, const model::Scene& scene = sheet()) {
  const int steps = method == "verlet" || method == "rkl2" ? 20 : 2;  // systems take thousands of messages
  return {.scene = model::to_toml(scene), .method = method, .step = 1e-3, .steps = steps, .writes_state = true};
}

double distance(const State& a, const State& b) {
  return std::max((a.x - b.x).cwiseAbs().maxCoeff(), (a.v - b.v).cwiseAbs().maxCoeff());
}

/// By the ordinary program; methods of SUNDIALS with a tight tolerance.
State in_this_process(const Problem& problem, const model::Scene& scene) {
  const model::Cloth cloth = model::compile(scene);
  if (bench::strips::is_of_sundials(problem.method)) {
    const std::vector<double> end{problem.step * problem.steps};
    return reference::cvode(cloth.ode, cloth.start, 0, end, {.rtol = 1e-11, .size = 1}).states.back();
  }
  solver::Options options;
  options.stage = &solver::stage_kind(problem.stage_solver);
  options.linear_solver = &solver::linear_solver("cholesky");
  solver::Integrator integrator(cloth.ode, solver::method(problem.method), options, cloth.start);
  for (int k = 0; k < problem.steps; ++k) EXPECT_EQ(integrator.step(problem.step).outcome, solver::Outcome::success);
  return integrator.state();
}

class StripsOverMpi : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string what = bench::strips::missing(); !what.empty()) GTEST_SKIP() << what;
  }
};

class StripsBy : public StripsOverMpi, public testing::WithParamInterface<std::string_view> {};
INSTANTIATE_TEST_SUITE_P(, StripsBy, testing::ValuesIn(bench::strips::methods().begin(), bench::strips::methods().end()),
                         [](const auto& test) {
                           std::string name(test.param);
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST_P(StripsBy, MoveAsOneSheet) {
  DRAPE_SLOW_IF(GetParam() != "verlet" && GetParam() != "sbdf2");
  const bool sundials = bench::strips::is_of_sundials(GetParam());
  const double allowed = sundials ? 1e-5 : 1e-10;
  Problem here = problem(std::string(GetParam()));
  const State expected = in_this_process(here, sheet());
  ASSERT_GT((expected.x - model::compile(sheet()).start.x).norm(), 1e-3) << "it has moved";
  for (const std::vector<int>& heights : {std::vector<int>{9}, {4, 5}, {1, 6, 2}}) {
    if (sundials && heights.size() > 2) continue;  // it waits for messages on a machine of two cores
    here.lines = heights;
    const auto run = run_strips(here, static_cast<int>(heights.size()), limit);
    ASSERT_EQ(run.end.x.rows(), columns * lines);
    EXPECT_LT(distance(run.end, expected), allowed) << heights.size() << " processes";
    if (GetParam() == "verlet") {
      EXPECT_GT(run.solved.work.at("stability_limits"), 1) << "it has stretched";
    }
  }
}

TEST_F(StripsOverMpi, OfTheLoopMoveAsOneSheet) {
  for (const char* method : {"bdf2", "midpoint"}) {
    Problem here = problem(method);
    here.stage_solver = "fixed-point";
    EXPECT_LT(distance(run_strips(here, 2, limit).end, in_this_process(here, sheet())), 1e-10) << method;
  }
}

/// Reductions by which this number of sub-steps is watched: one of every eight for lengths, one of every nine for modes.
std::int64_t watches(std::int64_t substeps) { return substeps / 8 + (substeps + 6) / 9; }

/// A force costs one message to each neighbour, the end of a step two. A step is tested once.
TEST_F(StripsOverMpi, SendWhatVerletNeeds) {
  Problem here = problem("verlet", sheet({{"pins", "[{where = \"left edge\"}]"}}));
  const auto solved = run_strips(here, 3, limit).solved;
  ASSERT_EQ(solved.ranks.size(), 3U);
  const std::int64_t substeps = solved.work.at("substeps") / here.steps, later = here.steps - 1;
  ASSERT_EQ(substeps * here.steps, solved.work.at("substeps"));
  EXPECT_EQ(solved.work.at("stability_limits"), 1);
  const Traffic outer{.messages = later * (substeps + 2),
                      .bytes = later * (substeps + 2) * 3 * columns * std::int64_t(sizeof(double)),
                      .reductions = later + watches(here.steps * substeps) - watches(substeps)};
  for (std::size_t k = 0; k < 3; ++k) {
    const Rank& rank = solved.ranks[k];
    const int neighbours = k == 1 ? 2 : 1;
    EXPECT_EQ(rank.lines, 3);
    EXPECT_EQ(rank.later.messages, neighbours * outer.messages);
    EXPECT_EQ(rank.later.bytes, neighbours * outer.bytes);
    EXPECT_EQ(rank.later.reductions, outer.reductions);
    EXPECT_GT(rank.memory, 1);
  }
}

TEST_F(StripsOverMpi, CountTheSameInEveryRun) {
  const Problem here = problem("bdf2");
  const auto one = run_strips(here, 2, limit).solved, other = run_strips(here, 2, limit).solved;
  EXPECT_EQ(one.work, other.work);
  EXPECT_GT(one.work.at("pfmg_iterations"), 0);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(one.ranks[k].later, other.ranks[k].later);
    EXPECT_GT(one.ranks[k].later.messages, 0);
  }
}

TEST_F(StripsOverMpi, RefuseWhatTheyCannotStep) {
  const auto refusal = [](const Problem& problem, int processes) {
    try {
      run_strips(problem, processes, limit);
      return std::string();
    } catch (const bench::strips::StripsError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(refusal(problem("verlet", sheet({{"grid.n", "[4, 2]"}, {"pins", "[]"}})), 3),
            "expected at most 2 processes for 2 lines, not 3");
  Problem here = problem("verlet");
  here.lines = {4, 4};
  EXPECT_EQ(refusal(here, 2), "lines: expected 2 positive numbers, one for each process, with the sum 9");
  EXPECT_THAT(refusal(problem("newton"), 2),
              AllOf(HasSubstr("problem.json: method: expected one of verlet, bridson"), HasSubstr("not 'newton'")));
  EXPECT_THAT(refusal(problem("verlet", sheet({{"material.bend", "1e-3"}})), 2), HasSubstr("it has the force plate"));
  EXPECT_THAT(refusal(problem("bdf2", sheet({{"pins", "[{where = \"left edge\", directions = \"x\"}]"}})), 2),
              HasSubstr("bdf2 expects pins that hold all directions"));
}

}  // namespace
}  // namespace drape::verify::strips_test
