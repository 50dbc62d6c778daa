// The general solvers in all their configurations: the same solution whatever solves their linear systems.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/reference.hpp"
#include "reference/sundials/arkode.hpp"
#include "reference/sundials/peer_solvers.hpp"
#include "solver/linear/choose.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::peers_test {
namespace {

using reference::NewtonSolve;

/// A small sheet that swings: pinned wholly or in some directions.
model::Scene sheet(const std::string& name) {
  std::vector<model::Override> overrides{{"end.time", "0.1"}};
  if (name == "hung-corners") overrides.insert(overrides.end(), {{"grid.n", "6"}, {"material.damping", "0.5"}});
  if (name == "pulled") overrides.push_back({"grid.n", "[6, 5]"});
  return model::load_scene(name, overrides);
}

struct Case {
  std::string family, newton;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const reference::PeerSolver& solver : reference::peer_solvers())
    for (const NewtonSolve& newton : reference::newton_solves()) {
      if (!solver.implicit) continue;
      const bool constant = newton.matrix == NewtonSolve::Matrix::constant;
      if (solver.name == "arkode-imex" && newton.reduced() && !(constant && !newton.gmres)) continue;
      all.push_back({std::string(solver.name), std::string(newton.name)});
    }
  return all;
}

class Peer : public testing::TestWithParam<Case> {
 protected:
  static reference::Trajectory solve(const model::Scene& scene, const std::string& family,
                                     const reference::SolveOptions& options, solver::Counters** work = nullptr) {
    static model::Cloth cloth;
    cloth = model::compile(scene);
    if (work != nullptr) *work = cloth.ode.work.get();
    return reference::peer_solver(family).solve(cloth.ode, cloth.start, 0, std::vector{scene.end}, options);
  }
};
INSTANTIATE_TEST_SUITE_P(, Peer, testing::ValuesIn(cases()), [](const auto& test) {
  std::string name = test.param.family + "_" + test.param.newton;
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST_P(Peer, ReproducesTheReference) {
  for (const char* name : {"hung-corners", "pulled"}) {
    const model::Scene scene = sheet(name);
    const double size = model::size(scene);
    const auto truth = solve(scene, "cvode-bdf", {.rtol = 1e-11, .size = size});
    const auto& newton = reference::newton_solve(GetParam().newton);
    const auto found = solve(scene, GetParam().family, {.rtol = 1e-9, .size = size, .newton = &newton});
    EXPECT_LE(reference::rms_distance(found.states[0].x, truth.states[0].x), 1e-7 * size) << name;
    const auto loose = solve(scene, GetParam().family, {.rtol = 1e-3, .size = size, .newton = &newton});
    EXPECT_GE(reference::rms_distance(loose.states[0].x, truth.states[0].x), 1e-12 * size) << name << ": it is another run";
  }
}

TEST_P(Peer, UsesTheLinearSolverItIsToldTo) {
  const auto& newton = reference::newton_solve(GetParam().newton);
  solver::Counters* work = nullptr;
  const model::Scene scene = sheet("hung-corners");
  solve(scene, GetParam().family, {.rtol = 1e-4, .size = model::size(scene), .newton = &newton}, &work);
  const std::string prefix = GetParam().family.substr(0, GetParam().family.find('-'));
  EXPECT_EQ(work->count(prefix + "/analyses") > 0, !newton.reduced());
  EXPECT_EQ(work->count("newton_matrices") > 0, newton.matrix == NewtonSolve::Matrix::newton);
  EXPECT_GT(work->count(prefix + "/factorisations"), 0);
}

TEST_P(Peer, IsNotSlowedDownByAFactorThatIsNearlyExact) {
  const auto& newton = reference::newton_solve(GetParam().newton);
  if (newton.matrix == NewtonSolve::Matrix::constant && GetParam().family != "arkode-imex") return;
  const model::Scene scene = sheet("hung-corners");
  const auto evaluations = [&](const NewtonSolve& by) {
    solver::Counters* work = nullptr;
    solve(scene, GetParam().family, {.rtol = 1e-6, .size = model::size(scene), .newton = &by}, &work);
    const std::string prefix = GetParam().family.substr(0, GetParam().family.find('-'));
    return work->count(prefix + "/steps") + work->count(prefix + "/factorisations");
  };
  EXPECT_LE(static_cast<double>(evaluations(newton)),
            1.3 * static_cast<double>(evaluations(reference::newton_solves().front())));
}

TEST(Peers, TakeMoreStepsWithALowerOrder) {
  const model::Scene scene = sheet("hung-corners");
  const auto steps = [&](const std::string& family, int order) {
    const model::Cloth cloth = model::compile(scene);
    reference::peer_solver(family).solve(cloth.ode, cloth.start, 0, std::vector{scene.end},
                                         {.rtol = 1e-9, .size = model::size(scene), .max_order = order});
    return cloth.ode.work->count(family.substr(0, family.find('-')) + "/steps");
  };
  for (const char* family : {"cvode-bdf", "ida-bdf"}) EXPECT_GT(steps(family, 2), 1.5 * steps(family, 5)) << family;
  EXPECT_GT(steps("arkode-esdirk", 3), 1.5 * steps("arkode-esdirk", 5));
}

/// A sheet with the work that a tuned CVODE takes for it, and its error.
struct Tuned {
  std::int64_t steps, factorisations;
  double error;
};

Tuned tuned(const reference::Tuning& tuning) {
  const model::Scene scene = sheet("hung-corners");
  const double size = model::size(scene);
  const auto solve = [&](const model::Cloth& cloth, double rtol, const reference::Tuning& with) {
    return reference::peer_solver("cvode-bdf")
        .solve(cloth.ode, cloth.start, 0, std::vector{scene.end},
               {.rtol = rtol, .size = size, .newton = &reference::newton_solve("constant-gmres"), .tuning = with})
        .states[0]
        .x;
  };
  const model::Cloth cloth = model::compile(scene), exact = model::compile(scene);
  const auto x = solve(cloth, 1e-5, tuning), truth = solve(exact, 1e-10, {});
  return {cloth.ode.work->count("cvode/steps"), cloth.ode.work->count("factorisations"),
          reference::rms_distance(x, truth) / size};
}

TEST(Tuning, OfVelocitiesSavesStepsAndCostsAccuracy) {
  const Tuned plain = tuned({}), loose = tuned({.velocity_weight = 100});
  EXPECT_LT(loose.steps, 0.8 * static_cast<double>(plain.steps));
  EXPECT_GT(loose.error, plain.error);
  EXPECT_LT(loose.error, 1e-2) << "positions have kept their tolerance";
}

TEST(Tuning, KeepsTheFactorOfTheConstantMatrix) {
  const Tuned plain = tuned({}), kept = tuned({.kept_factor = 0.3});
  EXPECT_LT(kept.factorisations, plain.factorisations);
  EXPECT_LT(kept.error, 1e-3);
}

// Its systems are solved to 1e-8, which takes multigrid several cycles and a factor one substitution: a rival would be slowed
// down.
TEST(Tuning, FactorsTheConstantMatrixOfLargeSheetsToo) {
  const std::vector<model::Override> large{{"grid.n", "160"}, {"end.time", "1e-4"}};
  const model::Scene scene = model::load_scene("hung-corners", large);
  ASSERT_GT(model::nodes(scene), solver::LinearChoice::most_factored) << "our own methods factor it as well";
  const model::Cloth cloth = model::compile(scene);
  reference::peer_solver("cvode-bdf")
      .solve(cloth.ode, cloth.start, 0, std::vector{scene.end},
             {.rtol = 1e-2, .size = model::size(scene), .newton = &reference::newton_solve("constant")});
  EXPECT_GT(cloth.ode.work->count("linear_solver/cholesky"), 0);
  EXPECT_EQ(cloth.ode.work->count("linear_solver/multigrid"), 0);
}

class SteppedPeer : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, SteppedPeer, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const auto& tableau : reference::tableaux()) names.emplace_back(tableau.name);
                           return names;
                         }()),
                         [](const auto& test) { return small_problems::identifier(test.param); });

TEST_P(SteppedPeer, HasItsOrder) {
  const reference::Tableau& tableau = reference::tableau(GetParam());
  const auto problem = small_problems::problem_named("free");
  const auto error = [&](int steps) {
    const double duration = 1;
    const reference::SolveOptions options{.rtol = 1e-12,
                                          .tuning = {.max_iterations = 60, .step = duration / steps, .tableau = &tableau}};
    const double end = small_problems::start_time + duration;
    const auto found =
        reference::arkode_steps(problem.ode, problem.start, small_problems::start_time, std::vector{end}, options);
    return small_problems::distance(found.states[0], problem.exact(end));
  };
  const int coarse = tableau.order > 4 ? 10 : 40;
  EXPECT_GT(std::log2(error(coarse) / error(2 * coarse)), tableau.order - 0.4);
}

}  // namespace
}  // namespace drape::verify::peers_test
