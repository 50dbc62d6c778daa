// Scenes of several phases: gravity, pins and seams that change with time.

#include "model/phases.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/record.hpp"
#include "bench/runs/trajectory_observer.hpp"
#include "bench/studies/contact/contact_watch.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::verify::phases_test {
namespace {

using model::Scene;
using solver::Vectors;
using testing::HasSubstr;

constexpr double rounding = 1e-12;

const std::string sheet =
    "name = 'sheet'\ngrid.n = 4\ngrid.size = 0.3\nmaterial = {tension = 50, damping = 0.5, density = 0.2}\n"
    "forces.gravity = [0, 0, -10]\nend.time = 0.4\n";

/// Two squares side by side, 0.2 m apart, whose inner sides are to be sewn.
const std::string squares =
    "name = 'squares'\nmaterial = {tension = 50, damping = 0.5, density = 0.2}\nend.time = 0.4\n"
    "panels = [{name = 'a', grid.n = 4, grid.size = 0.3}, {name = 'b', grid.n = 4, grid.size = 0.3, start.position = [0.5, 0, "
    "0.1]}]\n"
    "seams = [{one = {panel = 'a', side = 'right'}, other = {panel = 'b', side = 'left'}}]\n";

Scene scene(const std::string& toml) { return model::parse_scene(toml, "a.toml"); }

bench::RunSpec spec(const std::string& toml, const std::string& method) {
  return {scene(toml), "", &solver::method(method), 0.01, {}};
}

results::RunRecord run(const std::string& toml, const std::string& method = "imex-euler") {
  return bench::record(spec(toml, method), {}, {});
}

TEST(Phases, ThatChangeNothingLeaveTheMotion) {
  const std::string pinned = sheet + "pins = [{where = 'left edge'}]\n";
  const auto whole = run(pinned), parts = run(pinned + "phases = [{until = 0.1}, {until = 0.25}]\n");
  ASSERT_EQ(parts.outcome, solver::Outcome::success);
  EXPECT_EQ(parts.steps.size(), 40);
  EXPECT_LE((parts.final_state.x - whole.final_state.x).cwiseAbs().maxCoeff(), rounding);
  EXPECT_EQ(work_count(parts, "cg_iterations"), work_count(whole, "cg_iterations")) << "counters go on";
}

TEST(Phases, HaveTheirGravity) {
  const auto record =
      run(sheet + "phases = [{until = 0.1, gravity = [0, 0, 0]}, {until = 0.2, gravity = [0, 5, 0]}]\n", "midpoint");
  const Vectors way = record.final_state.x - model::start(scene(sheet)).x;
  const double y = 0.5 * 5 * 0.01 + 0.5 * 0.2, z = -0.5 * 10 * 0.04;
  for (Eigen::Index i = 0; i < way.rows(); ++i) EXPECT_LE((way.row(i) - Eigen::RowVector3d(0, y, z)).norm(), 1e-9) << i;
}

TEST(Phases, HaveTheirPins) {
  const auto record =
      run(sheet + "phases = [{until = 0.3, pins = [{where = 'all', directions = 'xyz', velocity = [1, 0, 0]}]}]\n", "midpoint");
  const Vectors way = record.final_state.x - model::start(scene(sheet)).x;
  // After they are let go, they have the velocity of the pins.
  for (Eigen::Index i = 0; i < way.rows(); ++i)
    EXPECT_LE((way.row(i) - Eigen::RowVector3d(0.4, 0, -0.5 * 10 * 0.01)).norm(), 1e-9) << i;
}

TEST(Paths, AreFollowed) {
  const std::string path =
      "pins = [{where = 'left edge', path = [{time = 0.1, position = [0, 0, 0.1]}, {time = 0.3, position = [0.2, 0, 0.1]}, "
      "{time "
      "= 0.35, position = [0.2, 0.1, 0.1]}]}]\n";
  bench::TrajectoryObserver trajectory(0.05);
  bench::Observer* const observers[] = {&trajectory};
  ASSERT_EQ(bench::record(spec(sheet + path, "sbdf2"), observers, {}).outcome, solver::Outcome::success);
  const auto motion = *trajectory.result();
  ASSERT_EQ(motion.times.size(), 9);
  const std::vector<Eigen::RowVector3d> expected{{0, 0, 0},    {0, 0, 0},   {0, 0, 0},     {0.05, 0, 0}, {0.1, 0, 0},
                                                 {0.15, 0, 0}, {0.2, 0, 0}, {0.2, 0.1, 0}, {0.2, 0.1, 0}};
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_NEAR(motion.times[k], 0.05 * static_cast<double>(k), rounding);
    for (const int i : {0, 4, 8, 12})
      EXPECT_LE((motion.states[k].x.row(i) - motion.states[0].x.row(i) - expected[k]).norm(), 1e-9) << k;
  }
}

/// All particles of all panels are recorded, whatever is sewn.
TEST(Seams, PullTheirParticlesTogetherAndMergeThem) {
  bench::TrajectoryObserver trajectory(0.1);
  bench::Observer* const observers[] = {&trajectory};
  const auto record = bench::record(spec(squares + "phases = [{until = 0.2, seams = 'pulled'}]\n", "bdf2"), observers, {});
  ASSERT_EQ(record.outcome, solver::Outcome::success) << record.message;
  EXPECT_THAT(record.message, HasSubstr("sewing at 0.2 s lost "));
  EXPECT_EQ(record.final_state.x.rows(), 28);
  const auto motion = *trajectory.result();
  ASSERT_EQ(motion.states.size(), 5);
  EXPECT_EQ(motion.nu, 32);
  EXPECT_EQ(motion.nv, 1);
  EXPECT_EQ(motion.panels, (std::vector<std::array<int, 2>>{{4, 4}, {4, 4}}));
  for (int b = 0; b < 4; ++b) {
    const int one = 3 + 4 * b, other = 16 + 4 * b;
    const auto gap = [&](std::size_t frame) {
      return (motion.states[frame].x.row(one) - motion.states[frame].x.row(other)).norm();
    };
    EXPECT_NEAR(gap(1), gap(0) / 2, 1e-9);
    for (const std::size_t frame : {2, 3, 4}) EXPECT_LE(gap(frame), 1e-9);
    EXPECT_EQ(motion.constraint[1][static_cast<std::size_t>(one)], int(results::Constraint::pinned));
    EXPECT_EQ(motion.constraint[3][static_cast<std::size_t>(one)], int(results::Constraint::free));
  }
}

/// A pin that turns divides the time into parts, and the scene may end before the seams meet.
TEST(Seams, ArePulledAsLongAsTheirPhaseLasts) {
  const std::string turning =
      "pins = [{where = 'left edge', panel = 'a', path = [{time = 0, position = [0, 0, 0]}, {time = 0.05, position = [0.01, 0, "
      "0]}, {time = 0.15, position = [0, 0, 0]}]}]\n";
  const auto gap = [](const Vectors& x) { return (x.row(3) - x.row(16)).norm(); };
  const std::string pulled = squares + turning + "phases = [{until = 0.2, seams = 'pulled'}]\n";
  for (const auto& [end, left] : {std::pair(0.05, 0.75), {0.1, 0.5}, {0.15, 0.25}, {0.2, 0.0}}) {
    bench::RunSpec part = spec(pulled, "bdf2");
    part.scene.end = end;
    bench::TrajectoryObserver trajectory(end);
    bench::Observer* const observers[] = {&trajectory};
    ASSERT_EQ(bench::record(part, observers, {}).outcome, solver::Outcome::success);
    const auto motion = *trajectory.result();
    EXPECT_NEAR(gap(motion.states.back().x), left * gap(motion.states.front().x), 1e-9) << end;
  }
}

TEST(Seams, KeepMomentumWhereTheyMergeAndSayWhatIsLost) {
  const auto phases = model::phases(scene(squares + "phases = [{until = 0.2, seams = 'open'}]\n"));
  ASSERT_EQ(phases.size(), 2);
  EXPECT_EQ(phases[1].begin, 0.2);
  const model::Cloth open = model::compile(phases[0]);
  ASSERT_EQ(open.ode.particles(), 32);
  solver::State y = open.start;
  for (int i = 0; i < 32; ++i) y.v.row(i) << 0.1 * i, 1 - 0.02 * i * i, 0.3;
  const auto [sewn, lost] = model::compile_next(phases[1], open, y);
  ASSERT_EQ(sewn.ode.particles(), 28);
  EXPECT_LE((sewn.ode.mass.transpose() * sewn.start.v - open.ode.mass.transpose() * y.v).norm(), rounding);
  EXPECT_NEAR(lost, kinetic_energy(open.ode, y.v) - kinetic_energy(sewn.ode, sewn.start.v), rounding);
  EXPECT_GT(lost, 0);
  EXPECT_EQ(sewn.begin, 0.2);
}

/// A step that conserves energy turns strains that jump into velocities: where seams have merged particles of the start, and
/// where pins stop.
TEST(Phases, ThatBeginByJumpsGiveNoEnergy) {
  const std::pair<const char*, const char*> scenes[] = {{"dress", "0.05"}, {"curtain_drawn", "1.3"}};
  for (const auto& [name, end] : scenes) {
    bench::ContactWatch watch;
    bench::Observer* const observers[] = {&watch};
    const model::Override shorter[] = {{"end.time", end}};
    const Scene jumps = model::load_scene(name, shorter);
    ASSERT_TRUE(bench::record({jumps, "", &solver::method("sbdf2"), 0.01, {}}, observers, {}).succeeded()) << name;
    EXPECT_THAT(watch.findings().energy_rise, testing::Optional(testing::Lt(1e-3))) << name;
  }
  const model::Override beginning[] = {{"end.time", "0.2"}};
  const bench::RunSpec pulled{model::load_scene("t_shirt", beginning), "", &solver::method("sbdf2"), 0.04, {}};
  EXPECT_EQ(bench::record(pulled, {}, {}).outcome, solver::Outcome::success) << "seams begin to pull";
}

TEST(Phases, HaveNoReference) {
  const Scene two = scene(sheet + "phases = [{until = 0.1, gravity = [0, 0, 0]}]\n");
  bench::References references(1e-6, {});
  EXPECT_THROW(references(two, model::compile(two)), reference::ReferenceError);
}

TEST(Phases, AreReadAndWritten) {
  const std::string text =
      squares +
      "pins = [{panel = 'a', where = 'left edge', path = [{time = 0.1, position = [1, 2, 3]}]}]\n"
      "phases = [{until = 0.1, seams = 'open', gravity = [1, 2, 3], pins = [{panel = 'b', where = 'corners'}]}, "
      "{until = 0.2, seams = 'pulled'}]\n";
  const std::string written = model::to_toml(scene(text));
  EXPECT_EQ(model::to_toml(scene(written)), written);
  EXPECT_THAT(written, HasSubstr("\"pulled\""));
  EXPECT_EQ(model::phases(scene(written)).size(), 3);
}

TEST(Phases, ThatAreWrongAreRefused) {
  for (const auto& [lines, says] : std::vector<std::pair<std::string, std::string>>{
           {"phases = [{until = 0.25}, {until = 0.125}]",
            "a.toml:7: phases = { until = 0.125 }: expected phases that end one after the other"},
           {"phases = [{gravity = [0, 0, 0]}]",
            "a.toml:7: phases = { gravity = [ 0, 0, 0 ] }: expected 'until' in every phase"},
           {"phases = [{until = 1, seams = 'glued'}]",
            "a.toml:7: phases.seams = 'glued': expected one of \"sewn\", \"pulled\", \"open\""},
           {"phases = [{until = 1, wind = 3}]",
            "a.toml:7: phases.wind = 3: expected no such key; a phase has until, gravity, seams, pins"},
           {"pins = [{where = 'all', path = []}]", "a.toml:7: pins.path = []: expected 1 to 1000 points"},
           {"pins = [{where = 'all', path = [{time = 1, position = [0, 0, 0]}, {time = 1, position = [0, 0, 0]}]}]",
            "a.toml:7: pins.path = "},
           {"pins = [{where = 'all', path = [{time = 1}]}]",
            "a.toml:7: pins.path = { time = 1 }: expected 'position' in every point of a path"},
           {"pins = [{where = 'all', velocity = [1, 0, 0], path = [{time = 1, position = [0, 0, 0]}]}]",
            "a.toml:7: pins.path = "}}) {
    try {
      scene(sheet + lines);
      FAIL() << lines;
    } catch (const model::SceneError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith(says));
    }
  }
}

}  // namespace
}  // namespace drape::verify::phases_test
