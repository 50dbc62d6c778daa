// Other simulators, run here: they get the springs of a scene, and come to its motion by their orders. Those that are not there
// are skipped.

#include "bench/peers/peers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/peers/springs.hpp"
#include "bench/runs/certified_reference.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/distance.hpp"
#include "reference/sundials/cvode.hpp"
#include "results/file/run_file.hpp"
#include "verify/support/bench_integrators.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::bench_peers_test {
namespace {

using bench::peers::Peer;
using bench::peers::Problem;
using testing::AllOf;
using testing::AnyOf;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// The undamped sheet with springs for diagonals, small.
model::Scene sheet(std::vector<model::Override> more = {}) {
  std::vector<model::Override> overrides{
      {"grid.n", "4"}, {"grid.border_cells", "whole"}, {"material.shear_form", "diagonals"}, {"end.time", "0.1"}};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return model::load_scene("peer-edge", overrides);
}

Problem springs_of(const model::Scene& scene) {
  Problem problem;
  set_springs(problem, scene, model::compile(scene));
  return problem;
}

std::string refused(const model::Scene& scene) {
  try {
    springs_of(scene);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(PeerSprings, AreThoseOfTheScene) {
  const model::Override oblong{"grid.n", "[4, 5]"};
  const Problem problem = springs_of(sheet({oblong}));
  EXPECT_THAT(problem.ends, SizeIs(3 * 5 + 4 * 4 + 2 * 3 * 4));
  EXPECT_TRUE(std::ranges::is_sorted(problem.ends));
  EXPECT_EQ(problem.pinned, (std::vector{16, 17, 18, 19}));
  std::set<double> stiffnesses;
  for (const double k : problem.stiffness) stiffnesses.insert(std::round(k));
  EXPECT_EQ(stiffnesses, (std::set<double>{750, 1333, 104}))
      << "k w/l along both sides of a cell of 0.76/3 by 0.76/4 m, and G L²/(2 l_u l_v)";
  EXPECT_THAT(problem.drag, Each(0));
  for (const char* form : {"linear", "projected"}) {
    const Problem damped = springs_of(sheet({oblong, {"material.damping", "2"}, {"material.damping_form", form}}));
    EXPECT_EQ(damped.drag_along, form == std::string("projected"));
    EXPECT_DOUBLE_EQ(std::ranges::max(damped.drag), 2 * 4. / 3);
  }
  EXPECT_THAT(springs_of(sheet({oblong, {"grid.border_cells", "dual"}})).stiffness,
              testing::Contains(testing::DoubleNear(375, 1e-9)));
}

TEST(PeerSprings, AreRefusedWhereTheyAreNotAllForces) {
  EXPECT_THAT(refused(model::load_scene("peer-edge", std::vector<model::Override>{{"grid.n", "4"}})),
              AllOf(HasSubstr("peer-edge: expected a uniform sheet with springs and weight only"), HasSubstr("diagonals")));
  EXPECT_THAT(refused(sheet({{"material.bend", "1e-3"}})), HasSubstr("plate"));
  EXPECT_THAT(refused(sheet({{"forces.air", "1"}})), HasSubstr("springs and weight only"));
  EXPECT_THAT(refused(sheet({{"pins", "[{where = \"upper edge\", velocity = [0, 0, 1]}]"}})), HasSubstr("do not move"));
  EXPECT_THAT(refused(sheet({{"pins", "[{where = \"upper edge\", directions = \"x\"}]"}})), HasSubstr("all directions"));
}

class APeer : public testing::TestWithParam<std::string> {
 protected:
  const Peer& peer = bench::peers::peer(GetParam());

  std::string missing() const { return bench::peers::missing(*peer.simulator); }
};
INSTANTIATE_TEST_SUITE_P(, APeer, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const Peer& peer : bench::peers::all_peers()) names.emplace_back(peer.name);
                           return names;
                         }()),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

/// Against CVODE, or where it has a cloth of its own against its own motion, by the error at the end, from a step to half of
/// it. Jolt in single precision only comes near: shorter steps lose more by round-off than they gain.
TEST_P(APeer, HasItsOrder) {
  if (!missing().empty()) GTEST_SKIP() << missing();
  const bool only_near = peer.name.starts_with("jolt");
  const double step = only_near ? 0.01 : 1.25e-3;
  const model::Scene scene = sheet({{"end.time", "0.5"}});
  const model::Cloth cloth = model::compile(scene);
  const std::vector<double> times = bench::compared_times(scene);
  const solver::State truth = peer.measured_by.empty()
                                  ? reference::cvode(cloth.ode, cloth.start, 0, times, {.rtol = 1e-12, .size = 1}).states.back()
                                  : bench::peers::measuring_motion(peer, scene, step, 60).states.back();
  const auto error = [&](double h) {
    const auto motion = bench::peers::run_peer(peer, scene, h, 60);
    EXPECT_EQ(motion.times, times);
    EXPECT_GT(motion.seconds, 0);
    EXPECT_THAT(motion.simulator, HasSubstr("."));
    return reference::rms_distance(motion.states.back().x, truth.x);
  };
  const double coarse = error(step), fine = error(step / 2);
  EXPECT_LT(coarse, 0.02);
  if (only_near) return;
  EXPECT_NEAR(std::log2(coarse / fine), peer.order, 0.3) << coarse << " and " << fine;
}

TEST_P(APeer, IsNotMeasuredByItself) {
  if (!missing().empty() || peer.measured_by.empty()) GTEST_SKIP() << missing();
  constexpr double step = 2.5e-4;
  const model::Scene scene = sheet({{"end.time", "0.01"}});
  const auto run = bench::peers::run_peer(peer, scene, step, 60), truth = bench::peers::measuring_motion(peer, scene, step, 60);
  EXPECT_GT(reference::rms_distance(run.states.back().x, truth.states.back().x), 0);
}

TEST_P(APeer, RefusesStepsThatEndElsewhere) {
  if (!missing().empty()) GTEST_SKIP() << missing();
  EXPECT_EQ(reason_against(peer, sheet(), 1e-3), "");
  for (const double step : {0.007, 0.02})
    EXPECT_THAT(reason_against(peer, sheet(), step),
                HasSubstr("expected a step that divides 0.01 s, a tenth of the scene's end"));
}

TEST_P(APeer, RefusesDampingThatItDoesNotHave) {
  if (!missing().empty()) GTEST_SKIP() << missing();
  const auto reason = [&](const char* form) {
    return reason_against(peer, sheet({{"material.damping", "1"}, {"material.damping_form", form}}), 1e-3);
  };
  EXPECT_EQ(reason("linear").empty(), peer.simulator->drags_across);
  EXPECT_EQ(reason("projected").empty(), peer.simulator->drags_along);
  if (!peer.simulator->drags_across) {
    EXPECT_THAT(reason("linear"), AnyOf(HasSubstr("has no such damping: expected material.damping = 0"),
                                        HasSubstr("expected an undamped uniform sheet")));
  }
}

/// Damping along springs alone, so that what has a single one for all springs has it as well.
TEST(PeerDamping, IsThatOfTheScene) {
  for (const char* name : {"bullet-explicit", "mujoco-euler", "petsc-alpha2"}) {
    const Peer& peer = bench::peers::peer(name);
    if (!bench::peers::missing(*peer.simulator).empty()) continue;
    for (const char* form : {"projected", "linear"}) {
      const model::Scene scene = sheet({{"material.shear", "0"}, {"material.damping", "2"}, {"material.damping_form", form}});
      if (!reason_against(peer, scene, 1e-4).empty()) continue;
      const model::Cloth cloth = model::compile(scene);
      const auto truth = reference::cvode(cloth.ode, cloth.start, 0, bench::compared_times(scene), {.rtol = 1e-10, .size = 1});
      const auto motion = bench::peers::run_peer(peer, scene, 1e-4, 60);
      EXPECT_LE(reference::rms_distance(motion.states.back().x, truth.states.back().x), 1e-4) << name << ", " << form;
    }
  }
}

/// Bullet's own limit is known where it runs: a line of its program.
TEST(PeerErrors, SayInOneLineWhatAProgramCannotDo) {
  const Peer& peer = bench::peers::peer("bullet-explicit");
  if (const std::string what = bench::peers::missing(*peer.simulator); !what.empty()) GTEST_SKIP() << what;
  try {
    bench::peers::run_peer(peer, sheet({{"grid.border_cells", "dual"}}), 1e-3, 60);
    FAIL() << "it has run";
  } catch (const bench::peers::PeerError& error) {
    EXPECT_THAT(error.what(), HasSubstr("one stiffness for edges and one for diagonals"));
  }
}

class ProgramPeers : public testing::Test {
 protected:
  const BenchIntegrators program;
  const Words scene{"--scene", "peer-edge",
                    "--set",   "grid.n=4",
                    "--set",   "grid.border_cells=whole",
                    "--set",   "material.shear_form=diagonals",
                    "--set",   "end.time=0.1"};
};

TEST_F(ProgramPeers, WriteMotionsThatScoreMeasuresAsTheyDo) {
  const Peer& peer = bench::peers::peer("petsc-verlet");
  if (const std::string what = bench::peers::missing(*peer.simulator); !what.empty()) GTEST_SKIP() << what;
  const auto rows = nlohmann::json::parse(
      program.output(Words{"peers"} + scene +
                     Words{"--peer", "petsc-verlet", "--step", "0.005,0.0025", "--out", "motions", "--format", "json"}));
  ASSERT_THAT(rows, SizeIs(2));
  EXPECT_GT(rows[0].at("error_3"), rows[1].at("error_3"));
  const auto scored = nlohmann::json::parse(
      program.output(Words{"score"} + scene + Words{"--method", "imex-euler", "--repeat", "1", "--format", "json"} +
                     Words{"motions/petsc-verlet-0.005.h5"}));
  const auto& frames = scored.at("score");
  ASSERT_THAT(frames, SizeIs(11));
  EXPECT_NEAR(frames[10].at("rms").get<double>() * 0.76, rows[0].at("error_3"), 1e-3 * rows[0].at("error_3").get<double>());
}

TEST_F(ProgramPeers, SayInOneLineWhatIsWrong) {
  const auto refused = [&](const Words& words, const std::string& why) {
    const ProgramResult result = program.run(Words{"peers"} + scene + words);
    EXPECT_EQ(result.exit_code, 2) << result.out;
    EXPECT_THAT(result.err, HasSubstr(why));
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
  };
  refused({"--peer", "bulet-explicit", "--step", "0.001"}, "bullet-explicit");
  refused({"--peer", "petsc-verlet"}, "--step");
  refused({"--peer", "petsc-verlet", "--step", "0"}, "--step");
  for (const bench::peers::Simulator& simulator : bench::peers::simulators()) {
    const std::string what = bench::peers::missing(simulator);
    if (what.empty()) continue;
    EXPECT_THAT(what, HasSubstr("install")) << simulator.name;
    const auto found = std::ranges::find(bench::peers::all_peers(), &simulator, &Peer::simulator);
    refused({"--peer", std::string(found->name), "--step", "0.001"}, what);
  }
}

TEST_F(ProgramPeers, OfTheStudyRunBesideOurMethods) {
  DRAPE_SLOW();
  program.output({"study", "peers", "--quick", "--out", "study.h5"});
  const auto all = results::read_tables(program.folder() / "study.h5");  // in the order of their names
  ASSERT_THAT(all, SizeIs(3));
  const results::Table &runs = all[0], &figures = all[1], &absent = all[2];
  EXPECT_EQ(results::rows(figures), 0u) << "the driver had another sheet";
  std::size_t missing = 0;
  for (const bench::peers::Simulator& simulator : bench::peers::simulators())
    missing += bench::peers::missing(simulator).empty() ? 0 : 1;
  EXPECT_EQ(results::rows(absent), missing);
  std::set<std::string> names;
  for (std::size_t row = 0; row < results::rows(runs); ++row) {
    names.insert(results::text_in(results::find_column(runs, "who"), row));
    EXPECT_THAT(results::text_in(results::find_column(runs, "reason"), row), IsEmpty());
    EXPECT_GT(results::number_in(results::find_column(runs, "time"), row), 0);
    EXPECT_LT(results::number_in(results::find_column(runs, "error_3"), row), 0.1);
  }
  for (const Peer& peer : bench::peers::all_peers())
    EXPECT_EQ(names.contains(std::string(peer.name)), bench::peers::missing(*peer.simulator).empty()) << peer.name;
  EXPECT_TRUE(names.contains("bdf2"));
}

}  // namespace
}  // namespace drape::verify::bench_peers_test
