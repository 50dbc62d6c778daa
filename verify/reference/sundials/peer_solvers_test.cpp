// CVODE, ARKODE and IDA follow the same equation of motion, each by methods of its own; KINSOL finds where it comes to rest.

#include "reference/sundials/peer_solvers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/exact/tension.hpp"
#include "reference/reference.hpp"
#include "reference/sundials/arkode.hpp"
#include "reference/sundials/first_order.hpp"
#include "reference/sundials/ida.hpp"
#include "reference/sundials/kinsol.hpp"
#include "reference/sundials/multirate.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::peer_solvers_test {
namespace {

using namespace small_problems;
using reference::FirstOrderOde;
using reference::Part;
using reference::PeerSolver;
using reference::ReferenceError;
using reference::Trajectory;
using testing::HasSubstr;

const std::vector<double> times{start_time + 0.3, start_time + 0.301, start_time + 1};

double worst(const Problem& problem, const Trajectory& trajectory) {
  double error = 0;
  for (std::size_t k = 0; k < trajectory.times.size(); ++k)
    error = std::max(error, distance(trajectory.states[k], problem.exact(trajectory.times[k])));
  return error;
}

class FamilyOn : public testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  const PeerSolver& solver = reference::peer_solver(std::get<0>(GetParam()));
  const Problem problem = problem_named(std::get<1>(GetParam()));

  Trajectory solve(double rtol) const { return solver.solve(problem.ode, problem.start, start_time, times, {.rtol = rtol}); }
};
INSTANTIATE_TEST_SUITE_P(, FamilyOn,
                         testing::Combine(testing::ValuesIn(names(reference::peer_solvers())),
                                          testing::ValuesIn(names(problems()))),
                         [](const auto& test) { return identifier(std::get<0>(test.param)) + "_" + std::get<1>(test.param); });

TEST_P(FamilyOn, FollowsTheExactMotionAsCloselyAsAsked) {
  EXPECT_LE(worst(problem, solve(1e-6)), 300e-6);
  EXPECT_LE(worst(problem, solve(1e-10)), 300e-10);
  EXPECT_GE(worst(problem, solve(1e-4)), 1e-8) << "it does not depend on its tolerance";
}

class ExplicitRungeKuttaOn : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, ExplicitRungeKuttaOn, testing::ValuesIn(names(problems())));

TEST_P(ExplicitRungeKuttaOn, FollowsTheExactMotionWithoutMatrices) {
  const Problem problem = problem_named(GetParam());
  const auto solve = [&](double rtol) {
    return reference::arkode_erk(problem.ode, problem.start, start_time, times, {.rtol = rtol, .max_order = 4});
  };
  EXPECT_LE(worst(problem, solve(1e-6)), 300e-6);
  EXPECT_LE(worst(problem, solve(1e-9)), 300e-9);
  EXPECT_GE(worst(problem, solve(1e-4)), 1e-9) << "it does not depend on its tolerance";
  EXPECT_EQ(problem.ode.work->count("arkode/factorisations"), 0);
  for (const solver::Counters::Kind& kind : problem.ode.work->kinds())
    EXPECT_TRUE(kind.name != "arkode/jacobians" || kind.count == 0) << kind.count;
}

TEST_P(FamilyOn, BeginsWithTheStart) {
  const auto trajectory = solver.solve(problem.ode, problem.start, start_time, std::vector{start_time, start_time + 0.1}, {});
  EXPECT_EQ(trajectory.states[0].x, problem.start.x);
  EXPECT_LE(largest(trajectory.states[0].v - problem.exact(start_time).v), 1e-15);
}

TEST_P(FamilyOn, NamesItselfAndTheReasonWhenItFails) {
  Problem broken = problem;
  int failures = 0;
  for (auto* part : {&broken.ode.force, &broken.ode.explicit_force})
    *part = [&failures, force = *part](double t, const Vectors& x, const Vectors& v, Vectors& f) {
      force(t, x, v, f);
      if (t > start_time + 0.5) f(2, 1) = std::nan(""), ++failures;
    };
  try {
    solver.solve(broken.ode, broken.start, start_time, times, {.rtol = 1e-6});
    ADD_FAILURE() << "it did not fail";
  } catch (const ReferenceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("not finite"));
    EXPECT_GE(error.time, start_time + 0.3);
    EXPECT_LE(error.time, start_time + 0.6);  // the stage of a Runge-Kutta method may be ahead
  }
  EXPECT_EQ(failures, 1) << "it tried again";
}

TEST(Multirate, IsOfFourthOrderInItsSlowSteps) {
  for (const Problem& problem : problems()) {
    Convergence errors;
    for (const int n : {12, 18, 27, 40}) {
      reference::SolveOptions options{.rtol = 1e-12};
      options.tuning.step = 1.0 / n;
      errors.steps.push_back(1.0 / n);
      errors.errors.push_back(worst(
          problem, reference::arkode_multirate(problem.ode, problem.start, start_time, std::vector{start_time + 1}, options)));
    }
    EXPECT_TRUE(has_order(errors, 4)) << problem.name;
  }
}

TEST(Multirate, FollowsFastSpringsBetweenItsSlowSteps) {
  const model::Cloth cloth = model::compile(
      model::load_scene("hung-edge", std::vector<model::Override>{{"grid.n", "5"}, {"material.damping", "500"}}));
  reference::SolveOptions options{.rtol = 1e-6};
  options.tuning.step = 1e-3;
  reference::arkode_multirate(cloth.ode, cloth.start, 0, std::vector{0.01}, options);
  EXPECT_EQ(cloth.ode.work->count("multirate/slow_steps"), 10);
  EXPECT_GE(cloth.ode.work->count("multirate/fast_steps"), 200);
}

class FirstOrder : public testing::TestWithParam<std::string> {
 protected:
  const Problem problem = problem_named(GetParam());
  const FirstOrderOde ode{problem.ode, problem.start, start_time};
  const Eigen::VectorXd y = ode.gather(ode.initial()) + Eigen::VectorXd::LinSpaced(ode.size(), -0.1, 0.2);
  static constexpr double t = start_time + 0.3;

  State state(const Eigen::VectorXd& unknowns) const {
    State result = ode.initial();
    ode.scatter(unknowns, result);
    return result;
  }

  Eigen::VectorXd derivative(const Eigen::VectorXd& at, Part part) const {
    State dy = ode.initial();
    ode.derivative(t, state(at), dy, part);
    return ode.gather(dy);
  }
};
INSTANTIATE_TEST_SUITE_P(, FirstOrder, testing::ValuesIn(names(problems())), [](const auto& test) { return test.param; });

TEST_P(FirstOrder, IsTheSumOfItsParts) {
  const Eigen::VectorXd sum = derivative(y, Part::linear) + derivative(y, Part::remainder);
  EXPECT_LE((derivative(y, Part::whole) - sum).norm(), 1e-13 * sum.norm());
  EXPECT_GE(derivative(y, Part::remainder).norm(), 0.01 * sum.norm());
}

TEST_P(FirstOrder, HasTheConstantJacobianOfItsImplicitPart) {
  const Eigen::MatrixXd J = ode.jacobian(t, state(y), Part::linear);
  const Eigen::VectorXd z = Eigen::VectorXd::LinSpaced(ode.size(), 3, -2);
  EXPECT_LE((derivative(y + z, Part::linear) - derivative(y, Part::linear) - J * z).norm(), 1e-12 * (J * z).norm());
}

TEST_P(FirstOrder, LeavesPinnedCoordinatesTheirVelocities) {
  State dy = ode.initial();
  ode.derivative(t, state(y), dy);
  for (const solver::Pin& pin : problem.ode.pins)
    for (int c = 0; c < 3; ++c) {
      if (!pin.fixed(c)) continue;
      EXPECT_EQ(dy.x(pin.particle, c), pin.velocity[c]);
      EXPECT_EQ(dy.v(pin.particle, c), 0);
    }
}

TEST(Ida, YieldsTheForcesOfThePins) {
  for (const Problem& problem : {known_motions::chain(), known_motions::towed_particle()}) {
    const auto result = reference::ida(problem.ode, problem.start, start_time, times, {.rtol = 1e-10});
    for (std::size_t k = 0; k < times.size(); ++k) {
      const Vectors exact = reactions(problem.ode, times[k], problem.exact(times[k] - start_time));
      EXPECT_GE(largest(exact), 0.1) << problem.name;
      EXPECT_LE(largest(result.reactions[k] - exact), 1e-6) << problem.name;
    }
  }
}

/// A small sheet hung by an edge, and 0.3 s later.
model::Scene hung_sheet(const std::string& damping) {
  return model::load_scene("hung-edge", std::vector<model::Override>{{"grid.n", "7"}, {"material.damping", damping}});
}

TEST(Ida, PinsCarryTheSheet) {
  // Impulse of weight and pins = change of momentum: a check that knows nothing of the forces inside.
  const model::Cloth cloth = compile(hung_sheet("5"));
  std::vector<double> at;
  for (int k = 0; k <= 400; ++k) at.push_back(0.3 * k / 400);
  const auto [trajectory, pins] = reference::ida(cloth.ode, cloth.start, 0, at, {.rtol = 1e-8, .size = 0.8});
  Eigen::RowVector3d impulse = cloth.ode.mass.sum() * Eigen::RowVector3d(0, 0, -9.81) * 0.3;
  for (std::size_t k = 0; k <= 400; ++k)  // Simpson
    impulse += (k == 0 || k == 400 ? 1 : k % 2 ? 4 : 2) * (0.3 / 1200) * pins[k].colwise().sum();
  const Eigen::RowVector3d momentum = (cloth.ode.mass.asDiagonal() * trajectory.states.back().v).colwise().sum();
  EXPECT_LE((impulse - momentum).norm(), 1e-6 * momentum.norm());
  EXPECT_GE(momentum.norm(), 0.1);
}

TEST(Ida, AgreesWithOurForcesOfThePins) {
  const model::Cloth cloth = compile(hung_sheet("5"));
  const auto by_ida = reference::ida(cloth.ode, cloth.start, 0, std::vector{0.3}, {.rtol = 1e-10, .size = 0.8});
  const auto ours = [&](int steps) {
    Options options = tolerances(1e-11, 1e-12);
    solver::Integrator integrator(cloth.ode, solver::method("midpoint"), options, cloth.start);
    integrate(integrator, 0.3, 0.3 / steps);
    return largest(reactions(cloth.ode, 0.3, integrator.state()) - by_ida.reactions[0]) / largest(by_ida.reactions[0]);
  };
  const double coarse = ours(300), fine = ours(600);
  EXPECT_LE(fine, 1e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.2);
}

class HungSheet : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Damping, HungSheet, testing::Values("50", "5", "0.5"),
                         [](const auto& test) { return std::string(test.param) == "0.5" ? "half" : test.param; });

TEST_P(HungSheet, IsTheSameForCvodeArkodeAndIda) {
  const model::Cloth cloth = compile(hung_sheet(GetParam()));
  const auto end = [&](const char* family) {
    return reference::peer_solver(family)
        .solve(cloth.ode, cloth.start, 0, std::vector{0.3}, {.rtol = 1e-10, .size = 0.8})
        .states[0];
  };
  const State by_cvode = end("cvode-bdf");
  EXPECT_GE(reference::rms_distance(by_cvode.x, cloth.start.x), 0.002);
  for (const char* family : {"arkode-esdirk", "ida-bdf"})
    EXPECT_LE(reference::rms_distance(end(family).x, by_cvode.x), 1e-8 * 0.8) << family;
}

TEST(HungSheetOfSplitSolvers, IsThatOfCvode) {
  const model::Cloth cloth = compile(hung_sheet("50"));
  const auto end = [&](const char* family) {
    return reference::peer_solver(family)
        .solve(cloth.ode, cloth.start, 0, std::vector{0.05}, {.rtol = 1e-8, .size = 0.8})
        .states[0];
  };
  for (const char* family : {"arkode-imex", "arkode-multirate"})
    EXPECT_LE(reference::rms_distance(end(family).x, end("cvode-bdf").x), 1e-6) << family;
}

TEST(Kinsol, FindsTheEquilibriumOfAPulledSheet) {
  const model::Scene scene = model::load_scene("tension");
  const model::Cloth cloth = compile(scene);
  Vectors guess = cloth.start.x;
  filter(cloth.ode.pins, guess);
  guess = cloth.start.x + 0.01 * guess;
  const auto found = reference::equilibrium(cloth.ode, guess);
  const model::Grid& grid = scene.sheet.grid;
  const reference::PulledSheet exact{grid.size_u, scene.sheet.material.tension.weft, std::abs(scene.sheet.gravity[0])};
  EXPECT_GT(found.iterations, 0);
  EXPECT_LE(found.residual, 1e-10);
  for (int i = 0; i < cloth.ode.particles(); ++i) {
    const double from_edge = grid.size_u - cloth.start.x(i, 0);  // the fixed edge is at the right
    EXPECT_NEAR(grid.size_u - found.x(i, 0), pulled_position(exact, from_edge), 1e-12);
  }
}

TEST(Kinsol, SaysThatASheetWithoutPinsHasNoEquilibrium) {
  model::Scene scene = hung_sheet("5");
  scene.pins.clear();
  const model::Cloth cloth = compile(scene);
  EXPECT_THROW(reference::equilibrium(cloth.ode, cloth.start.x), ReferenceError);
}

TEST(Kinsol, RefusesPinsAlongADirection) {
  const Problem problem = obliquely_pinned();
  EXPECT_THAT([&] { reference::equilibrium(problem.ode, problem.exact(start_time).x); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("expected pins along axes")));
}

}  // namespace
}  // namespace drape::verify::peer_solvers_test
