// What --method auto chooses: by the numbers of the scene, the same each time, as accurate as asked for, and run as if it had
// been named.

#include "bench/runs/automatic.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/runs/choice_rule.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/file/run_file.hpp"
#include "verify/support/bench_integrators.hpp"

namespace drape::verify::automatic_test {
namespace {

using bench::FallingSheet;
using bench::Prediction;
using bench::RunSpec;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;
using testing::ThrowsMessage;

RunSpec chosen(const std::string& scene, const std::vector<model::Override>& overrides, double accuracy) {
  RunSpec spec{model::load_scene(scene, overrides), "", nullptr, 0, {}};
  choose_automatically(spec, accuracy);
  return spec;
}

std::string method_on_corners(const std::string& damping, double accuracy) {
  const std::string end = damping == "0" ? "0.4" : "1";
  return chosen("hung-corners", {{"material.damping", damping}, {"end.time", end}}, accuracy).method_name();
}

/// The sheet of table 3.2 with damping 5 N s/m.
constexpr FallingSheet weakly_damped{
    .particles = 400, .end = 1, .fall_time = 0.2856, .damping = 2.23, .tension = 1274, .limit = 4.4e-5};

TEST(Choice, GoesByDampingAndError) {
  EXPECT_EQ(method_on_corners("50", 0.1), "sbdf2");
  EXPECT_EQ(method_on_corners("50", 1e-5), "midpoint");
  EXPECT_EQ(method_on_corners("5", 1e-7), "bdf3");
  EXPECT_EQ(method_on_corners("0.5", 1e-5), "verlet");
  EXPECT_EQ(method_on_corners("0", 1e-3), "verlet");
}

TEST(Choice, GoesBySize) {
  EXPECT_EQ(chosen("hung-corners", {{"material.damping", "0.5"}, {"grid.n", "15"}}, 1e-3).method_name(), "verlet");
  EXPECT_EQ(chosen("hung-corners", {{"material.damping", "0.5"}, {"grid.n", "60"}}, 1e-3).method_name(), "bdf2")
      << "more and shorter sub-steps";
}

/// Strong damping lets a sheet creep about its corners: along an edge errors are smaller, so that steps are longer.
TEST(Choice, KnowsSheetsThatHangByAnEdge) {
  const auto step_with = [](const std::string& pins) {
    return chosen("hung-edge", {{"grid.n", "12"}, {"material.damping", "50"}, {"pins", pins}}, 1e-6).step;
  };
  const double of_edge = step_with("[{ where = 'upper edge' }]"), of_corners = step_with("[{ where = 'upper corners' }]");
  EXPECT_GT(of_edge, 1.5 * of_corners);
  EXPECT_EQ(step_with("[{ where = 'left edge' }]"), of_edge);
  EXPECT_EQ(step_with("[{ particles = [[1, 11], [2, 11], [3, 11], [4, 11], [5, 11], [6, 11], [7, 11], [8, 11], [9, 11], "
                      "[10, 11], [11, 11]] }]"),
            of_corners)
      << "one is missing";
}

TEST(Choice, IsTheSameEachTimeAndSaysWhichNumbersDecided) {
  const RunSpec one = chosen("hung-edge", {{"material.damping", "5"}}, 1e-3),
                other = chosen("hung-edge", {{"material.damping", "5"}}, 1e-3);
  EXPECT_EQ(one.method, other.method);
  EXPECT_EQ(one.step, other.step);
  EXPECT_EQ(one.choice->reason, other.choice->reason);
  EXPECT_EQ(one.choice->accuracy, 1e-3);
  EXPECT_THAT(one.choice->reason,
              AllOf(HasSubstr("d T/(ρ L²) = 2.23"), HasSubstr(fmt::format("h k/d = {:.3g}", one.step * 2000)),
                    HasSubstr(fmt::format("h = {:.3g} s", one.step)), HasSubstr("updates"), HasSubstr(" ms")));
}

TEST(Choice, EndsWithWholeSteps) {
  for (const double accuracy : {1e-1, 1e-3, 1e-6}) {
    const RunSpec spec = chosen("hung-corners", {{"material.damping", "5"}}, accuracy);
    const double steps = spec.scene.end / spec.step;
    EXPECT_NEAR(steps, std::round(steps), 1e-9 * steps);
  }
}

/// Where the rule knows nothing, pilot runs measure the error.
TEST(Choice, LeavesScenesThatTheRuleDoesNotKnowToPilotRuns) {
  struct Unknown {
    std::string scene;
    std::vector<model::Override> overrides;
    std::string named;
  };
  for (const Unknown& unknown :
       {Unknown{"wind", {}, "forces.wind"}, Unknown{"hung-edge", {{"material.bend", "0.01"}}, "material.bend"},
        Unknown{"hung-edge", {{"material.damping_form", "projected"}}, "material.damping_form"},
        Unknown{"hung-edge", {{"material.tension", "1e6"}}, "k/(ρ g L) = 1.27e+05"},
        Unknown{"hung-edge", {{"material.damping", "0"}}, "end / √(L/g) = 3.5, not 1 to 1.5"},
        Unknown{"pulled", {}, "pins that move"}}) {
    const RunSpec spec = chosen(unknown.scene, unknown.overrides, 1e-4);
    EXPECT_EQ(spec.method_name(), "bdf2") << unknown.named;
    EXPECT_EQ(spec.options.error_control.tolerance, 1e-4) << unknown.named;
    EXPECT_TRUE(spec.options.error_control.global) << unknown.named;
    EXPECT_THAT(spec.choice->reason, AllOf(HasSubstr(unknown.named), HasSubstr("pilot runs")));
  }
}

TEST(Choice, IsRefusedWhereNoRuleKnowsTheError) {
  EXPECT_THAT([] { chosen("tablecloth", {}, 1e-3); },
              ThrowsMessage<std::invalid_argument>(AllOf(StartsWith("--method auto: "), HasSubstr("without obstacles"))));
  EXPECT_THAT(
      [] {
        chosen("hung-edge", {{"contact.thickness", "0.004"}}, 1e-3);
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("contact.thickness")));
}

TEST(Predictions, KeepToTheErrorAndTakeLongerForLess) {
  double before = 0;
  for (const double accuracy : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    const std::vector<Prediction> all = bench::predictions(weakly_damped, accuracy);
    ASSERT_THAT(all, Not(IsEmpty()));
    for (const Prediction& one : all) {
      EXPECT_LE(one.error, accuracy) << one.way.method;
      EXPECT_GE(one.ms, all.front().ms) << one.way.method;
    }
    EXPECT_GE(all.front().ms, before) << accuracy;
    before = all.front().ms;
  }
}

/// Errors of methods that treat springs as stiff in all directions go with κ h², of the first order with κ h.
TEST(Predictions, TakeShorterStepsOfSplittingMethodsOnStifferSheets) {
  const auto times_shorter = [](double damping, const std::string& method) {
    const auto step = [&](double stiffer) {
      FallingSheet sheet = weakly_damped;
      sheet.damping = damping;
      sheet.tension *= stiffer;
      for (const Prediction& prediction : bench::predictions(sheet, 1e-2))
        if (prediction.way.method == method) return prediction.step;
      return 0.0;
    };
    return step(1) / step(2);
  };
  EXPECT_NEAR(times_shorter(weakly_damped.damping, "sbdf2"), std::sqrt(2), 0.15);
  EXPECT_NEAR(times_shorter(20, "imex-euler"), 2, 0.2);
}

// --- Runs --------------------------------------------------------------------------------------------------------------------

struct Asked {
  std::string scene, damping, n, end;
  double accuracy;
};

std::ostream& operator<<(std::ostream& out, const Asked& asked) {
  return out << asked.scene << " d=" << asked.damping << " to " << asked.accuracy;
}

Words sheet_of(const Asked& asked) {
  return {"run",   "--scene",           asked.scene, "--set",  "material.damping=" + asked.damping,
          "--set", "grid.n=" + asked.n, "--until",   asked.end};
}

results::RunRecord run_of(const BenchIntegrators& program, const Words& command, const std::string& out) {
  const ProgramResult result = program.run(command + Words{"--repeat", "1", "--out", out});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return results::read_runs(program.folder() / out).at(0);
}

/// Errors are the same on every machine.
TEST(Auto, ReachesTheError) {
  const BenchIntegrators program;
  for (const Asked& asked : {Asked{"hung-corners", "50", "8", "1", 1e-2}, Asked{"hung-edge", "5", "8", "0.8", 1e-3},
                             Asked{"hung-edge", "0.5", "8", "1", 1e-5}}) {
    const auto run =
        run_of(program, sheet_of(asked) + Words{"--method", "auto", "--accuracy", fmt::format("{}", asked.accuracy)},
               fmt::format("{}-{}.h5", asked.scene, asked.damping));
    ASSERT_TRUE(run.motion_error) << asked;
    EXPECT_LE(run.motion_error->position, asked.accuracy) << asked << ": " << run.choice->reason;
  }
}

/// A number as it is recorded.
std::string parameter(const results::RunRecord& run, const std::string& name) {
  const auto found = std::ranges::find(run.parameters, name, &results::Parameter::name);
  return found == run.parameters.end() ? "" : fmt::format("{}", found->value);
}

TEST(Auto, IsTheRunThatItNames) {
  const BenchIntegrators program;
  const Words sheet = sheet_of({"hung-corners", "50", "8", "1", 0}) + Words{"--no-reference"};
  const auto chosen = run_of(program, sheet + Words{"--method", "auto", "--accuracy", "0.01"}, "auto.h5");
  ASSERT_TRUE(chosen.choice);
  EXPECT_EQ(chosen.choice->accuracy, 0.01);
  EXPECT_EQ(chosen.method, "midpoint/fixed-point/cholesky");
  EXPECT_THAT(parameter(chosen, "loop_tolerance"), AnyOf("0.1", "0.01")) << "the usual one is 1e-5";
  const Words named_by_hand{"--method",         chosen.method,
                            "--step",           fmt::format("{}", chosen.step),
                            "--loop-tolerance", parameter(chosen, "loop_tolerance")};
  const auto named = run_of(program, sheet + named_by_hand, "named.h5");
  EXPECT_FALSE(named.choice);
  EXPECT_EQ(chosen.cell, named.cell);
  EXPECT_EQ(chosen.final_state.x, named.final_state.x);
  EXPECT_EQ(chosen.final_state.v, named.final_state.v);
  ASSERT_EQ(chosen.work.size(), named.work.size());
  for (std::size_t k = 0; k < chosen.work.size(); ++k)
    EXPECT_EQ(chosen.work[k].count, named.work[k].count) << named.work[k].name;
}

TEST(Auto, SaysWhatItChose) {
  const BenchIntegrators program;
  const ProgramResult result = program.run(sheet_of({"hung-corners", "50", "8", "1", 0}) +
                                           Words{"--method", "auto", "--accuracy", "0.1", "--no-reference", "--repeat", "1"});
  EXPECT_THAT(result.err, AllOf(HasSubstr("auto: d T/(ρ L²) = 22.3"), HasSubstr("sbdf2")));
}

}  // namespace
}  // namespace drape::verify::automatic_test
