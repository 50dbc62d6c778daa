// bench_integrators run --trajectory: the motion of a run as HDF5 keeps it and as XDMF shows it.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "model/scene_file/scene_file.hpp"
#include "results/file/run_file.hpp"
#include "results/file/xdmf.hpp"
#include "solver/dense_output.hpp"
#include "verify/support/bench_integrators.hpp"

namespace drape::verify::trajectory_test {
namespace {

using results::RunRecord;
using results::TrajectoryRecord;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const Words tiny{"run",  "--scene",        "hung-edge", "--set", "grid.n=[5, 4]", "--until",
                 "0.05", "--no-reference", "--repeat",  "1",     "--out",         "a.h5"};

std::vector<RunRecord> runs(const BenchIntegrators& program, const Words& arguments) {
  program.output(arguments);
  return results::read_runs(program.folder() / "a.h5");
}

TEST(Trajectory, IsThereAtTheTimesAskedForFromTheStartOn) {
  const BenchIntegrators program;
  const auto all = runs(program, tiny + Words{"--method", "bdf2,sbdf2", "--step", "0.01", "--trajectory", "every=0.015"});
  ASSERT_THAT(all, SizeIs(2));
  for (const RunRecord& run : all) {
    ASSERT_TRUE(run.trajectory);
    const auto& [nu, nv, panels, times, states, stretch, constraint] = *run.trajectory;
    EXPECT_EQ(nu, 5);
    EXPECT_EQ(nv, 4);
    EXPECT_THAT(times, ElementsAre(0, 0.015, 0.03, 0.045));
    EXPECT_THAT(states, SizeIs(4));
  }
}

TEST(Trajectory, HasTheStatesOfTheRun) {
  const BenchIntegrators program;
  const auto all = runs(program, tiny + Words{"--method", "bdf2", "--step", "0.01", "--trajectory", "every=0.005"});
  const model::Scene scene = model::load_scene("hung-edge", std::vector<model::Override>{{"grid.n", "[5, 4]"}});
  const auto& [nu, nv, panels, times, states, stretch, constraint] = *all[0].trajectory;
  ASSERT_THAT(states, SizeIs(11));
  EXPECT_EQ(states[0].x, model::start(scene).x);
  EXPECT_EQ(states[10].x, all[0].final_state.x);
  EXPECT_EQ(states[10].v, all[0].final_state.v);
  const solver::State within = solver::state_within(times[3], times[2], states[2], times[4], states[4]);
  EXPECT_LE((states[3].x - within.x).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LE((states[3].v - within.v).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Trajectory, ChangesNothingElse) {
  const BenchIntegrators program;
  const Words run = tiny + Words{"--method", "bdf2", "--step", "0.01"};
  const RunRecord with = runs(program, run + Words{"--trajectory", "every=0.01"})[0];
  std::filesystem::remove(program.folder() / "a.h5");
  std::filesystem::remove(program.folder() / "a.h5.xdmf");
  const RunRecord without = runs(program, run)[0];
  EXPECT_FALSE(without.trajectory);
  EXPECT_THAT(program.files(), SizeIs(1)) << "XDMF without a trajectory";
  EXPECT_EQ(with.final_state.x, without.final_state.x);
  for (const results::WorkCount& work : without.work) EXPECT_EQ(work_count(with, work.name), work.count) << work.name;
}

TEST(Trajectory, OfARunThatFailsEndsWithIt) {
  const BenchIntegrators program;
  const auto all = runs(program, tiny + Words{"--set", "material.damping=0.5", "--method", "bdf2/fixed-point", "--max-updates",
                                              "1", "--step", "0.01", "--trajectory", "every=0.001"});
  EXPECT_NE(all[0].outcome, solver::Outcome::success);
  EXPECT_NEAR(all[0].trajectory->times.back(), all[0].last_good_time, 1e-12);
}

TEST(Trajectory, TellsStretchedAndPinnedParticles) {
  const BenchIntegrators program;
  const auto all = runs(program, {"run",
                                  "--scene",
                                  "chain",
                                  "--set",
                                  "grid.n=[4, 1]",
                                  "--set",
                                  "start.stretch=[1.25, 1]",
                                  "--until",
                                  "0.01",
                                  "--no-reference",
                                  "--repeat",
                                  "1",
                                  "--out",
                                  "a.h5",
                                  "--method",
                                  "bdf2",
                                  "--step",
                                  "0.01",
                                  "--trajectory",
                                  "every=0.01"});
  const TrajectoryRecord& trajectory = *all[0].trajectory;
  for (const double strain : trajectory.stretch[0]) EXPECT_NEAR(strain, 0.25, 1e-14);
  EXPECT_EQ(trajectory.constraint[0][0], int(results::Constraint::pinned));
  EXPECT_EQ(trajectory.constraint[0][1], int(results::Constraint::free));
}

const std::string on_a_plane = R"(
name = "on a plane"
[grid]
n = 3
[material]
tension = 100
[forces]
gravity = [0, 0, -9.81]
[contact]
distance = 0.01
[[obstacles]]
shape = "plane"
position = [0, 0, -0.03]
)";

TEST(Trajectory, TellsParticlesInContact) {
  const BenchIntegrators program;
  program.write("plane.toml", on_a_plane);
  const auto all = runs(program, {"run", "--scene", "plane.toml", "--until", "0.2", "--no-reference", "--repeat", "1", "--out",
                                  "a.h5", "--method", "bdf2", "--step", "0.01", "--trajectory", "every=0.2"});
  ASSERT_THAT(all[0].trajectory->constraint, SizeIs(2));
  EXPECT_THAT(all[0].trajectory->constraint[0], Each(int(results::Constraint::free)));
  EXPECT_THAT(all[0].trajectory->constraint[1], Each(int(results::Constraint::in_contact)));
}

// --- XDMF, read by a program that knows only the format ------------------------------------------------------------------

/// What read_xdmf.py prints of a trajectory.
std::string as_read(const TrajectoryRecord& trajectory, std::size_t k) {
  const auto sum = [](const solver::Vectors& values) {
    const Eigen::RowVector3d total = values.colwise().sum();
    return fmt::format("{:.9g} {:.9g} {:.9g}", total[0], total[1], total[2]);
  };
  int kinds = 0;
  for (const int kind : trajectory.constraint[k]) kinds += kind;
  return fmt::format("{} 1x{}x{} {}\n  velocity {}\n  stretch {:.9g}\n  constraint {}\n", trajectory.times[k], trajectory.nv,
                     trajectory.nu, sum(trajectory.states[k].x), sum(trajectory.states[k].v), trajectory.stretch[k].sum(),
                     kinds);
}

TEST(Xdmf, LeadsToTheNumbersOfEveryFrame) {
  const BenchIntegrators program;
  const auto all = runs(program, tiny + Words{"--set", "name=\"a < b & \\\"c\\\"\"", "--method", "bdf2,sbdf2", "--step", "0.01",
                                              "--trajectory", "every=0.02"});
  const ProgramResult read =
      run_program({.program = "/usr/bin/python3",
                   .arguments = {DRAPE_SOURCE_DIR "/verify/support/read_xdmf.py", (program.folder() / "a.h5.xdmf").string()},
                   .folder = program.folder(),
                   .environment = {},
                   .output = {}});
  EXPECT_EQ(read.err, "");
  std::string expected;
  for (const RunRecord& run : all) {
    expected += fmt::format("run {} {} h = 0.01 s {}\n", run.scene, run.method, run.overrides);
    for (std::size_t k = 0; k < 3; ++k) expected += as_read(*run.trajectory, k);
  }
  EXPECT_EQ(read.out, expected);
}

TEST(Xdmf, IsOneFileBesideTheOther) { EXPECT_EQ(results::xdmf_path("folder/runs.h5"), "folder/runs.h5.xdmf"); }

// --- Bad input -----------------------------------------------------------------------------------------------------------

TEST(Trajectory, BadRequestsAreRefusedBeforeAnythingRuns) {
  const BenchIntegrators program;
  const auto complaint = [&](const Words& arguments) {
    const ProgramResult result = program.run(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "");
    return result.err;
  };
  const Words run = tiny + Words{"--method", "bdf2", "--step", "0.01", "--trajectory"};
  for (const std::string bad : {"0.1", "every=", "every=0", "every=nan", "every=inf", "each=0.1", "every=-1", "every=1x"})
    EXPECT_THAT(complaint(run + Words{bad}),
                HasSubstr("--trajectory: expected every=SECONDS with a finite number above 0, not '" + bad + "'"));
  EXPECT_THAT(complaint(run + Words{"every=1e-9"}), HasSubstr("expected at most 100000 frames to t = 0.05 s"));
  EXPECT_THAT(complaint({"study", "modes", "--quick", "--out", "a.h5", "--trajectory", "every=1"}),
              HasSubstr("the study modes makes tables"));
  EXPECT_THAT(program.files(), IsEmpty());
  program.write("a.h5.xdmf", "precious");
  EXPECT_THAT(complaint(run + Words{"every=0.1"}), HasSubstr("a.h5.xdmf exists"));
  EXPECT_EQ(program.files().at("a.h5.xdmf"), "precious");
}

}  // namespace
}  // namespace drape::verify::trajectory_test
