#include "solver/stage/anderson.hpp"

#include <gtest/gtest.h>

#include "solver/history.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::anderson_test {
namespace {

using solver::Anderson;
using solver::History;
using solver::State;
using solver::Vectors;

/// The iteration v ← v + d(v), d = b − T v with T = diag(θ), whose fixed point is b/θ.
struct Relaxation {
  Vectors theta, b;

  explicit Relaxation(double weakest) : theta(2, 3), b(2, 3) {
    theta << 1, 0.8, 0.5, 0.2, 0.1, weakest;
    b << 1, 2, -1, 0.5, 3, 1;
  }
  Vectors update(const Vectors& v) const { return b - theta.cwiseProduct(v); }
  Vectors solution() const { return b.cwiseQuotient(theta); }

  /// |d| after this number of accelerated updates from 0.
  double left(Anderson& anderson, int updates) const {
    Vectors v = Vectors::Zero(2, 3);
    for (int k = 0; k < updates; ++k) {
      Vectors d = update(v);
      anderson.advance(v, d);
    }
    return (v - solution()).norm() / solution().norm();
  }
};

TEST(Anderson, SolvesALinearProblemInAsManyUpdatesAsItHasDirections) {
  for (const double weakest : {0.5, 1e-2, 1e-3}) {
    Anderson anderson(2);
    EXPECT_LE(Relaxation(weakest).left(anderson, 7), 1e-5) << weakest;
  }
}

TEST(Anderson, IsMuchSlowerWithoutAcceleration) {
  const Relaxation relaxation(1e-2);
  Vectors v = Vectors::Zero(2, 3);
  for (int k = 0; k < 7; ++k) v += relaxation.update(v);
  EXPECT_GE((v - relaxation.solution()).norm() / relaxation.solution().norm(), 0.1);
}

TEST(Anderson, ForgetsTheProblemBefore) {
  Anderson used(2), fresh(2);
  Relaxation(0.3).left(used, 5);
  used.restart();
  const Relaxation relaxation(0.01);
  EXPECT_EQ(relaxation.left(used, 4), relaxation.left(fresh, 4));
}

/// Iterates towards a fixed point, then towards one nearby of the same map. Returns |d| after one update of the second.
double left_of_the_next(double weakest, void (Anderson::*between)()) {
  Anderson anderson(2);
  Relaxation relaxation(weakest);
  relaxation.theta = relaxation.theta.cwiseMax(weakest);
  relaxation.left(anderson, 6);
  relaxation.b.array() *= 1.1;
  (anderson.*between)();
  return relaxation.left(anderson, 1);
}

TEST(Anderson, ServesTheNextFixedPointOfTheSameMap) {
  EXPECT_LE(left_of_the_next(0.4, &Anderson::begin), 1e-2 * left_of_the_next(0.4, &Anderson::restart));
}

TEST(Anderson, DoesNotTrustWhatRespondedWeakly) {
  Anderson anderson(2);
  Relaxation weak(0.01);
  weak.theta.setConstant(0.5 * Anderson::lasting_response);
  weak.left(anderson, 3);
  anderson.begin();
  Vectors v = Vectors::Zero(2, 3), d = weak.update(v);
  const Vectors plain = d;
  anderson.advance(v, d);
  EXPECT_EQ(v, plain);
  EXPECT_LE(anderson.smallest_response(), 0.51 * Anderson::lasting_response);  // but knows that there are such
}

TEST(Anderson, KnowsTheWeakestResponseItHasSeen) {
  const double weakest = 1e-3;
  Anderson anderson(2);
  Relaxation(weakest).left(anderson, 6);
  EXPECT_LE(anderson.smallest_response(), 0.2);
  EXPECT_GE(anderson.smallest_response(), weakest * 0.999);
}

State polynomial(double t, int degree) {
  const Vectors c = small_problems::noise(4, 7);
  return {c * std::pow(t, degree), c * (1 + std::pow(t - 0.3, degree))};
}

/// Points on a cubic.
History on_a_cubic(int points, const std::vector<double>& times) {
  const auto point = [](double t) { return solver::Point{t, polynomial(t, 3), {}, false}; };
  History history(points, 0, point(times.front()));
  for (std::size_t k = 1; k < times.size(); ++k) {
    solver::Point next = point(times[k]);
    history.push(next, times[k] - times[k - 1]);
  }
  return history;
}

TEST(History, ExtrapolatesPolynomialsExactly) {
  const History history = on_a_cubic(4, {0, 0.1, 0.25, 0.3, 0.5});
  ASSERT_TRUE(history.full());
  State y = polynomial(0, 0);
  history.extrapolate(0.7, y.v, &y.x);
  EXPECT_LE((y.v - polynomial(0.7, 3).v).norm(), 1e-14);
  EXPECT_LE((y.x - polynomial(0.7, 3).x).norm(), 1e-14);
}

TEST(History, KnowsWhatExtrapolationMisses) {
  const History history = on_a_cubic(3, {0, 0.1, 0.25});
  State y = polynomial(0, 0);
  history.extrapolate(0.4, y.v, &y.x);
  const Vectors third_derivative = 6 * small_problems::noise(4, 7);
  EXPECT_LE((polynomial(0.4, 3).x - y.x - history.remainder(0.4) * third_derivative).norm(), 1e-14);
  EXPECT_GT((polynomial(0.4, 3).x - y.x).norm(), 1e-3);
}

TEST(History, KeepsTheNewestOnlyAfterARestart) {
  History history = on_a_cubic(3, {0, 0.1, 0.25});
  EXPECT_EQ(history.last_step(), 0.25 - 0.1);
  history.restart();
  ASSERT_EQ(history.size(), 1);
  EXPECT_EQ(history[0].t, 0.25);
  EXPECT_EQ(history.last_step(), 0);
  solver::Point next{0.3, polynomial(0.3, 3), {}, false};
  history.push(next, 0.05);
  EXPECT_EQ(history[0].t, 0.3);
  EXPECT_EQ(history[1].t, 0.25);
}

TEST(History, KeepsPointsThatAreNotSmoothButDoesNotExtrapolateThem) {
  History history = on_a_cubic(3, {0, 0.1, 0.25});
  history.begin_smooth();
  EXPECT_EQ(history.size(), 3);
  State y = polynomial(0, 0);
  history.extrapolate(0.4, y.v, &y.x);
  EXPECT_EQ((y.x - polynomial(0.25, 3).x).norm(), 0);
}

TEST(History, KeepsForcesOfTheNewestPointsOnly) {
  const auto point = [](double t) { return solver::Point{t, polynomial(t, 3), Vectors::Constant(4, 3, t), true}; };
  History history(3, 2, point(0));
  for (const double t : {1.0, 2.0, 3.0}) {
    solver::Point next = point(t);
    history.push(next, 1);
    EXPECT_EQ(next.f.size(), 12) << "memory for the next";
  }
  EXPECT_EQ(history[0].f(0), 3);
  EXPECT_EQ(history[1].f(0), 2);
  EXPECT_FALSE(history[2].has_f);
  EXPECT_EQ(history[2].f.size(), 0);
}

}  // namespace
}  // namespace drape::verify::anderson_test
