#include "reference/reference.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/exact/tension.hpp"
#include "reference/sundials/cvode.hpp"
#include "reference/sundials/first_order.hpp"
#include "verify/support/known_motions.hpp"

namespace drape::verify::reference_test {
namespace {

using namespace known_motions;
using reference::ReferenceError;
using reference::SolveOptions;
using testing::AllOf;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;

const double t0 = 3;
const std::vector<double> times{t0 + 0.1, t0 + 0.37, t0 + 0.371, t0 + 0.8, t0 + 1.5, t0 + 2};

std::vector<double> errors(const Problem& problem, const reference::Trajectory& trajectory) {
  std::vector<double> result;
  for (std::size_t i = 0; i < trajectory.times.size(); ++i)
    result.push_back(reference::rms_distance(problem.exact(trajectory.times[i] - t0).x, trajectory.states[i].x));
  return result;
}

double worst_error(const Problem& problem, double rtol) {
  return std::ranges::max(errors(problem, reference::cvode(problem.ode, problem.start, t0, times, {.rtol = rtol})));
}

class ReferenceOf : public testing::TestWithParam<Problem (*)()> {
 protected:
  const Problem problem = GetParam()();
};
INSTANTIATE_TEST_SUITE_P(KnownMotions, ReferenceOf, testing::Values(damped_oscillator, whirling_spring, chain, towed_particle),
                         [](const auto& test) { return test.param().name; });

TEST_P(ReferenceOf, StaysNearTheExactSolutionAtEveryTime) {
  // BDF sums up its local errors; on the whirling spring they also turn the orbit.
  EXPECT_LE(worst_error(problem, 1e-6), 500 * 1e-6);
  EXPECT_LE(worst_error(problem, 1e-10), 1000 * 1e-10);
}

TEST_P(ReferenceOf, FallsWithItsTolerance) {
  for (double rtol : {1e-4, 1e-6, 1e-8}) EXPECT_LE(worst_error(problem, rtol / 100), worst_error(problem, rtol) / 10) << rtol;
}

TEST_P(ReferenceOf, HasVelocitiesNearTheExactOnes) {
  const auto trajectory = reference::cvode(problem.ode, problem.start, t0, times, {.rtol = 1e-8});
  for (std::size_t i = 0; i < times.size(); ++i)
    EXPECT_LE(reference::rms_distance(problem.exact(times[i] - t0).v, trajectory.states[i].v), 1e-3);
}

TEST_P(ReferenceOf, UsesTheExactJacobian) {
  const reference::FirstOrderOde ode(problem.ode, problem.start, t0);
  const Eigen::VectorXd y = ode.gather(ode.initial()) + Eigen::VectorXd::LinSpaced(ode.size(), -0.1, 0.2);
  const auto state = [&](const Eigen::VectorXd& unknowns) {
    State result = ode.initial();
    ode.scatter(unknowns, result);
    return result;
  };
  const auto derivative = [&](const Eigen::VectorXd& unknowns) {
    State dy = ode.initial();
    ode.derivative(t0 + 0.3, state(unknowns), dy);
    return ode.gather(dy);
  };
  const auto jacobian = ode.jacobian(t0 + 0.3, state(y));
  const double step = 1e-5;
  for (int column = 0; column < ode.size(); ++column) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(ode.size(), column), exact = jacobian * unit;
    const Eigen::VectorXd change = derivative(y + step * unit) - derivative(y - step * unit);
    EXPECT_LE((change / (2 * step) - exact).norm(), 1e-6 * jacobian.norm()) << "column " << column;
  }
}

TEST_P(ReferenceOf, HasANewtonMatrixWithThePatternOfItsJacobian) {
  const reference::FirstOrderOde ode(problem.ode, problem.start, t0);
  const auto J = ode.jacobian(t0, ode.initial());
  reference::WideSparseMatrix I(ode.size(), ode.size());
  I.setIdentity();
  EXPECT_EQ(reference::WideSparseMatrix(I - 0.1 * J).nonZeros(), J.nonZeros());
}

TEST(Reference, MovesPinnedCoordinatesExactly) {
  const Problem problem = towed_particle();
  const auto trajectory = reference::cvode(problem.ode, problem.start, t0, times);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double t = times[i] - t0;
    const auto& [x, v, z] = trajectory.states[i];
    EXPECT_EQ(x.row(1), Eigen::RowVector3d(0.5 * t, 0.3, 0.4));
    EXPECT_EQ(v.row(1), Eigen::RowVector3d(0.5, 0, 0));
    EXPECT_EQ(x.row(0).tail(2), Eigen::RowVector2d(0.2, 0.1 - 0.25 * t));
    EXPECT_EQ(v.row(0).tail(2), Eigen::RowVector2d(0, -0.25));
  }
}

TEST(Reference, BeginsWithTheStartAndItsPrescribedVelocities) {
  const Problem problem = towed_particle();
  const auto trajectory = reference::cvode(problem.ode, problem.start, t0, std::vector{t0, t0 + 1});
  EXPECT_EQ(trajectory.states[0].x, problem.start.x);
  EXPECT_EQ(trajectory.states[0].v, problem.exact(0).v);
}

TEST(Reference, MeasuresItsErrorsByTheSizeOfTheScene) {
  const Problem problem = damped_oscillator();
  const double scale = std::exp2(-20);  // a power of two, and a linear motion: every rounding is the same
  const State small{scale * problem.start.x, scale * problem.start.v};
  const auto large = reference::cvode(problem.ode, problem.start, t0, times, {.rtol = 1e-8, .size = 1});
  const auto scaled = reference::cvode(problem.ode, small, t0, times, {.rtol = 1e-8, .size = scale});
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_EQ(scaled.states[i].x, scale * large.states[i].x);
}

TEST(Reference, EvaluatesNothingOutsideItsTimes) {
  Problem problem = damped_oscillator();
  double first = 1e9, last = -1e9;
  problem.ode.force = [&, force = problem.ode.force](double t, const Vectors& x, const Vectors& v, Vectors& f) {
    first = std::min(first, t), last = std::max(last, t);
    force(t, x, v, f);
  };
  reference::cvode(problem.ode, problem.start, t0, times);
  EXPECT_GE(first, t0);
  EXPECT_LE(last, times.back());
}

TEST(Reference, AnalysesThePatternOfItsJacobianOnce) {
  const Problem problem = chain();
  reference::cvode(problem.ode, problem.start, t0, times);
  EXPECT_GT(problem.ode.work->count("cvode/jacobians"), 10);
  EXPECT_GT(problem.ode.work->count("cvode/factorisations"), problem.ode.work->count("cvode/jacobians"));
  EXPECT_EQ(problem.ode.work->count("cvode/analyses"), 1);
}

TEST(Reference, FollowsAPatternThatGrowsAndShrinks) {
  Problem problem = chain();
  problem.ode.jacobian = [jacobian = problem.ode.jacobian](double t, const Vectors& x, const Vectors& v, SparseMatrix& df_dx,
                                                           SparseMatrix& df_dv) {
    jacobian(t, x, v, df_dx, df_dv);
    if (t < t0 + 0.5 || t > t0 + 1) return;
    const SparseMatrix everywhere = Eigen::MatrixXd::Ones(df_dx.rows(), df_dx.cols()).sparseView();
    df_dx += 0 * everywhere;
  };
  EXPECT_LE(worst_error(problem, 1e-8), 500 * 1e-8);
  EXPECT_EQ(problem.ode.work->count("cvode/analyses"), 3);
}

TEST(Reference, LowersTheOrderWhereHighOrdersAreUnstable) {
  // Two particles swing together slowly (w = 1/s) and could swing against each other fast (w = 45/s), undamped.
  const SparseMatrix soft = Eigen::MatrixXd::Identity(2, 2).sparseView();
  const SplitOde ode = linear_ode(Eigen::VectorXd::Ones(2), row_of_springs(2, 1e3) - soft, SparseMatrix(2, 2));
  const State start{Vectors::Ones(2, 3), Vectors::Zero(2, 3)};
  const auto trajectory = reference::cvode(ode, start, t0, std::vector{t0 + 50}, {.rtol = 1e-6});
  EXPECT_NEAR(trajectory.states[0].x(0, 0), std::cos(50), 1e-3);
  EXPECT_GT(ode.work->count("cvode/order_reductions"), 0);
}

/// What the exception of a failed computation says; fails if there is none.
ReferenceError failure(const Problem& problem, const SolveOptions& options = {}) {
  try {
    reference::cvode(problem.ode, problem.start, t0, times, options);
  } catch (const ReferenceError& error) {
    return error;
  }
  ADD_FAILURE() << "the computation did not fail";
  return {"", "", 0};
}

TEST(ReferenceError, NamesTheTimeAndTheParticleWhoseForceIsNotFinite) {
  Problem problem = chain();
  problem.ode.force = [force = problem.ode.force](double t, const Vectors& x, const Vectors& v, Vectors& f) {
    force(t, x, v, f);
    if (t > t0 + 0.5) f(4, 1) = std::numeric_limits<double>::quiet_NaN();
  };
  const ReferenceError error = failure(problem);
  EXPECT_THAT(error.time, AllOf(Ge(t0 + 0.4), Le(t0 + 0.5)));
  EXPECT_EQ(error.flag, "CV_RHSFUNC_FAIL");
  EXPECT_THAT(error.what(),
              AllOf(HasSubstr("CV_RHSFUNC_FAIL"), HasSubstr("t = 3.4"), HasSubstr("force on particle 4 is not finite")));
}

TEST(ReferenceError, PassesOnWhatTheForceOrItsJacobianThrew) {
  Problem problem = damped_oscillator();
  problem.ode.force = [](double, const Vectors&, const Vectors&, Vectors&) { throw std::runtime_error("the cloth is torn"); };
  EXPECT_THAT(failure(problem).what(), HasSubstr("the cloth is torn"));
  problem = damped_oscillator();
  problem.ode.jacobian = [](double, const Vectors&, const Vectors&, SparseMatrix&, SparseMatrix&) { throw 42; };
  EXPECT_THAT(failure(problem).what(), HasSubstr("not a std::exception"));
}

TEST(ReferenceError, SaysThatTheJacobianIsNotFinite) {
  Problem problem = damped_oscillator();
  problem.ode.jacobian = [jacobian = problem.ode.jacobian](double t, const Vectors& x, const Vectors& v, SparseMatrix& df_dx,
                                                           SparseMatrix& df_dv) {
    jacobian(t, x, v, df_dx, df_dv);
    df_dx *= std::numeric_limits<double>::infinity();
  };
  EXPECT_THAT(failure(problem).what(), HasSubstr("the Jacobian is not finite"));
}

TEST(ReferenceError, TellsWhenTheStepsRunOut) {
  const ReferenceError error = failure(chain(), {.max_steps = 20});
  EXPECT_EQ(error.flag, "CV_TOO_MUCH_WORK");
  EXPECT_THAT(error.time, AllOf(Ge(t0), Le(t0 + 0.1)));
}

TEST(Reference, RejectsIllPosedProblems) {
  Problem problem = chain();
  const auto solve = [&](std::vector<double> at, SolveOptions options = {}) {
    reference::cvode(problem.ode, problem.start, t0, at, options);
  };
  EXPECT_THROW(solve({}), std::invalid_argument);
  EXPECT_THROW(solve({t0}), std::invalid_argument);
  EXPECT_THROW(solve({t0 - 1, t0 + 1}), std::invalid_argument);
  EXPECT_THROW(solve({t0 + 1, t0 + 1}), std::invalid_argument);
  EXPECT_THROW(solve({t0 + 1}, {.rtol = 0}), std::invalid_argument);
  EXPECT_THROW(solve({t0 + 1}, {.size = -1}), std::invalid_argument);
  problem.start.v.conservativeResize(3, 3);
  EXPECT_THROW(solve({t0 + 1}), std::invalid_argument);
  problem = damped_oscillator();
  problem.ode.pins = {Pin{}};
  EXPECT_THROW(solve({t0 + 1}), std::invalid_argument);
}

TEST(PulledSheet, HoldsEveryNodeOfAGridInEquilibrium) {
  const reference::PulledSheet sheet{.length = 2, .modulus = 40, .body_force = 9.81};
  const int n = 7;
  const double l = sheet.length / n;
  const auto tension = [&](int edge) {
    return sheet.modulus * ((pulled_position(sheet, (edge + 1) * l) - pulled_position(sheet, edge * l)) / l - 1);
  };
  EXPECT_EQ(pulled_position(sheet, 0), 0);
  for (int node = 1; node < n; ++node) EXPECT_NEAR(tension(node) - tension(node - 1) + sheet.body_force * l, 0, 1e-12);
  EXPECT_NEAR(-tension(n - 1) + sheet.body_force * l / 2, 0, 1e-12);
}

}  // namespace
}  // namespace drape::verify::reference_test
