// Every implicit method against its formula written out a second time, and what follows from the formulas: methods that agree,
// quantities that are kept, polynomials that are exact.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <numeric>

#include "solver/methods/starts.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::methods_test {
namespace {

using namespace small_problems;
using solver::bdf2_coefficients;
using solver::Integrator;
using solver::Outcome;

const std::vector<double> unequal_steps = {0.02, 0.03, 0.021, 0.0315, 0.0315, 0.02, 0.01, 0.0143};

/// The states at the start and after every step.
struct Path {
  std::vector<double> times;
  std::vector<State> states;
};

Path run(const SplitOde& ode, std::string_view method, const State& start, const std::vector<double>& steps, double t0 = 0) {
  Integrator integrator(ode, solver::method(method), tight(), start, t0);
  Path result{{t0}, {integrator.state()}};
  for (const double h : steps) {
    EXPECT_EQ(integrator.step(h).outcome, Outcome::success) << method << " at t = " << integrator.time();
    result.times.push_back(integrator.time());
    result.states.push_back(integrator.state());
  }
  return result;
}

State final_state(const SplitOde& ode, std::string_view method, const State& start, const std::vector<double>& steps) {
  return run(ode, method, start, steps).states.back();
}

/// Three states in a row as a formula sees them.
struct Neighbours {
  const SplitOde& ode;
  double t_before, t0, t1;
  const State &before, &y0, &y1;
  double h = t1 - t0;

  Vectors acceleration(const Vectors& f) const {
    Vectors a = ode.mass.cwiseInverse().asDiagonal() * f;
    filter(ode.pins, a);
    return a;
  }
  Vectors linear(const Vectors& x, const Vectors& v) const { return ode.stiffness * x + ode.damping * v; }
  Vectors explicit_part(double t, const Vectors& x, const Vectors& v) const {
    Vectors f(x.rows(), 3);
    ode.explicit_force(t, x, v, f);
    return f;
  }
  Vectors whole(double t, const Vectors& x, const Vectors& v) const { return linear(x, v) + explicit_part(t, x, v); }

  /// dp/dt at t1 of the quadratic polynomial through three values (Newton's form).
  Vectors slope(const Vectors& p_before, const Vectors& p0, const Vectors& p1) const {
    const Vectors last = (p1 - p0) / h, first = (p0 - p_before) / (t0 - t_before);
    return last + h * (last - first) / (t1 - t_before);
  }
};

/// What is left of a method's two equations, for x and for v.
using Residual = std::function<State(const Neighbours&)>;

const std::map<std::string_view, Residual> formulas = {
    {"imex-euler",
     [](const Neighbours& n) {
       const Vectors f = n.linear(n.y1.x, n.y1.v) + n.explicit_part(n.t0, n.y0.x, n.y0.v);
       return State{n.y1.x - n.y0.x - n.h * n.y1.v, n.y1.v - n.y0.v - n.h * n.acceleration(f)};
     }},
    {"implicit-euler",
     [](const Neighbours& n) {
       const Vectors f = n.whole(n.t1, n.y1.x, n.y1.v);
       return State{n.y1.x - n.y0.x - n.h * n.y1.v, n.y1.v - n.y0.v - n.h * n.acceleration(f)};
     }},
    {"sbdf2",
     [](const Neighbours& n) {
       const Vectors f0 = n.explicit_part(n.t0, n.y0.x, n.y0.v), f_before = n.explicit_part(n.t_before, n.before.x, n.before.v);
       const Vectors extrapolated = f0 + (f0 - f_before) / (n.t0 - n.t_before) * n.h;
       const Vectors f = n.linear(n.y1.x, n.y1.v) + extrapolated;
       return State{n.slope(n.before.x, n.y0.x, n.y1.x) - n.y1.v, n.slope(n.before.v, n.y0.v, n.y1.v) - n.acceleration(f)};
     }},
    {"bdf2",
     [](const Neighbours& n) {
       const Vectors f = n.whole(n.t1, n.y1.x, n.y1.v);
       return State{n.slope(n.before.x, n.y0.x, n.y1.x) - n.y1.v, n.slope(n.before.v, n.y0.v, n.y1.v) - n.acceleration(f)};
     }},
    {"midpoint",
     [](const Neighbours& n) {
       const Vectors x = (n.y0.x + n.y1.x) / 2, v = (n.y0.v + n.y1.v) / 2;
       return State{n.y1.x - n.y0.x - n.h * v, n.y1.v - n.y0.v - n.h * n.acceleration(n.whole(n.t0 + n.h / 2, x, v))};
     }},
    // The stage in the middle follows from x1 = x0 + h vm.
    {"imex-midpoint",
     [](const Neighbours& n) {
       const Vectors x = (n.y0.x + n.y1.x) / 2, v = (n.y1.x - n.y0.x) / n.h, K = n.linear(x, v);
       return State{v - n.y0.v - n.h / 2 * n.acceleration(K + n.explicit_part(n.t0, n.y0.x, n.y0.v)),
                    n.y1.v - n.y0.v - n.h * n.acceleration(K + n.explicit_part(n.t0 + n.h / 2, x, v))};
     }},
    {"newmark",
     [](const Neighbours& n) {
       const Vectors f = n.whole(n.t0, n.y0.x, n.y0.v) + n.whole(n.t1, n.y1.x, n.y1.v);
       return State{n.y1.x - n.y0.x - n.h / 2 * (n.y0.v + n.y1.v), n.y1.v - n.y0.v - n.h / 2 * n.acceleration(f)};
     }},
    {"explicit-euler",
     [](const Neighbours& n) {
       return State{n.y1.x - n.y0.x - n.h * n.y0.v, n.y1.v - n.y0.v - n.h * n.acceleration(n.whole(n.t0, n.y0.x, n.y0.v))};
     }},
    {"explicit-midpoint",
     [](const Neighbours& n) {
       const Vectors x = n.y0.x + n.h / 2 * n.y0.v;
       const Vectors v = n.y0.v + n.h / 2 * n.acceleration(n.whole(n.t0, n.y0.x, n.y0.v));
       return State{n.y1.x - n.y0.x - n.h * v, n.y1.v - n.y0.v - n.h * n.acceleration(n.whole(n.t0 + n.h / 2, x, v))};
     }},
    {"rk4",
     [](const Neighbours& n) {
       const auto rate = [&](double c, const State& y) {
         return State{y.v, n.acceleration(n.whole(n.t0 + c * n.h, y.x, y.v))};
       };
       const auto ahead = [&](double c, const State& F) { return State{n.y0.x + c * n.h * F.x, n.y0.v + c * n.h * F.v}; };
       const State F1 = rate(0, n.y0), F2 = rate(0.5, ahead(0.5, F1)), F3 = rate(0.5, ahead(0.5, F2)),
                   F4 = rate(1, ahead(1, F3));
       return State{n.y1.x - n.y0.x - n.h / 6 * (F1.x + 2 * F2.x + 2 * F3.x + F4.x),
                    n.y1.v - n.y0.v - n.h / 6 * (F1.v + 2 * F2.v + 2 * F3.v + F4.v)};
     }},
};

TEST(Formulas, ExistForAllImplicitMethods) {
  for (const Method& m : solver::thesis_methods()) EXPECT_TRUE(!m.implicit() || formulas.contains(m.name)) << m.name;
}

class FormulaOn : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, FormulaOn, testing::ValuesIn(names(problems())), [](const auto& test) { return test.param; });

TEST_P(FormulaOn, IsFulfilledByEveryStep) {
  const Problem problem = problem_named(GetParam());
  for (const auto& [name, residual] : formulas) {
    const auto [t, y] = run(problem.ode, name, problem.start, unequal_steps, start_time);
    for (std::size_t k = 2; k < y.size(); ++k) {
      const State left = residual({problem.ode, t[k - 2], t[k - 1], t[k], y[k - 2], y[k - 1], y[k]});
      EXPECT_LE(largest(left.x), 1e-10) << name << ", step " << k;
      EXPECT_LE(largest(left.v), 1e-10) << name << ", step " << k;
    }
  }
}

TEST(Formulas, AreNotFulfilledByOtherMethods) {
  const Problem problem = free_particles();
  for (const auto& [name, unused] : formulas) {
    const auto [t, y] = run(problem.ode, name, problem.start, unequal_steps, start_time);
    for (const auto& [other, residual] : formulas) {
      const State left = residual({problem.ode, t[2], t[3], t[4], y[2], y[3], y[4]});
      EXPECT_TRUE(name == other || std::max(largest(left.x), largest(left.v)) >= 1e-6) << name << " passes for " << other;
    }
  }
}

/// M dv/dt = K x + D v, of which `share` K is left to the implicit part; the damping if wanted.
SplitOde linear_ode(double share, bool damped) {
  const SparseMatrix K = laplacian(&Spring::k), D = damped ? laplacian(&Spring::d) : SparseMatrix(particles, particles);
  SplitOde ode = known_motions::linear_ode(masses(), K, D);
  ode.stiffness = share * K;
  ode.damping = D;
  ode.explicit_force = [=](double, const Vectors& x, const Vectors&, Vectors& f) { f = (1 - share) * (K * x); };
  return ode;
}

/// Springs that weaken as they stretch, without damping: neither time nor velocity matters.
SplitOde conservative_ode() {
  SplitOde ode = linear_ode(1, false);
  ode.explicit_force = [](double, const Vectors& x, const Vectors&, Vectors& f) { f = Nonlinear::force(0, x, 0 * x); };
  ode.force = [K = ode.stiffness](double, const Vectors& x, const Vectors&, Vectors& f) {
    f = K * x + Nonlinear::force(0, x, 0 * x);
  };
  return ode;
}

const State start{noise(particles, 11), noise(particles, 12)};

constexpr std::pair<const char*, const char*> relatives[] = {
    {"imex-euler", "implicit-euler"}, {"sbdf2", "bdf2"}, {"imex-midpoint", "midpoint"}};

TEST(Relatives, AgreeWhereThereIsNoExplicitPart) {
  const SplitOde ode = linear_ode(1, true);
  for (const auto& [imex, implicit] : relatives)
    EXPECT_LE(distance(final_state(ode, imex, start, unequal_steps), final_state(ode, implicit, start, unequal_steps)), 1e-12)
        << imex;
}

TEST(Relatives, DifferWhereThereIsAnExplicitPart) {
  const SplitOde ode = linear_ode(0.9, true);
  for (const auto& [imex, implicit] : relatives)
    EXPECT_GE(distance(final_state(ode, imex, start, unequal_steps), final_state(ode, implicit, start, unequal_steps)), 1e-6)
        << imex;
}

TEST(Relatives, DifferFromEachOther) {
  const SplitOde ode = linear_ode(1, true);
  for (const char* method : {"implicit-euler", "bdf2"})
    EXPECT_GE(distance(final_state(ode, method, start, unequal_steps), final_state(ode, "midpoint", start, unequal_steps)),
              1e-6);
}

/// Energy of the linear ODE and angular momentum about the origin: quadratic invariants of the undamped motion.
double energy(const State& y) {
  return 0.5 * masses().dot(y.v.rowwise().squaredNorm()) - 0.5 * (y.x.transpose() * laplacian(&Spring::k) * y.x).trace();
}
Eigen::Vector3d angular_momentum(const State& y) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < particles; ++i) sum += masses()[i] * y.x.row(i).cross(y.v.row(i));
  return sum;
}

TEST(Midpoint, KeepsEnergyAndAngularMomentum) {
  for (const double split : {1.0, 0.7}) {
    const auto [times, states] = run(linear_ode(split, false), "midpoint", start, std::vector(500, 0.05));
    for (const State& y : states) {
      ASSERT_NEAR(energy(y), energy(start), 1e-10 * energy(start));
      ASSERT_LE((angular_momentum(y) - angular_momentum(start)).norm(), 1e-10);
    }
  }
}

TEST(ImplicitEulerAndBdf2, KeepNeither) {
  for (const char* method : {"implicit-euler", "bdf2"}) {
    const State end = final_state(linear_ode(1, false), method, start, std::vector(500, 0.05));
    EXPECT_LE(energy(end), 0.99 * energy(start)) << method;
    EXPECT_GE((angular_momentum(end) - angular_momentum(start)).norm(), 0.01 * angular_momentum(start).norm()) << method;
  }
}

/// How far from the start one arrives after going there and back.
double there_and_back(std::string_view method) {
  const SplitOde ode = conservative_ode();
  const std::vector<double> steps(100, 0.03);
  State y = final_state(ode, method, start, steps);
  y.v *= -1;
  y = final_state(ode, method, y, steps);
  y.v *= -1;
  return distance(y, start);
}

TEST(Midpoint, GoesBackTheWayItCame) { EXPECT_LE(there_and_back("midpoint"), 1e-11); }
TEST(Verlet, GoesBackTheWayItCame) { EXPECT_LE(there_and_back("verlet"), 1e-11); }
TEST(ImplicitEulerAndBdf2, DoNotGoBackTheWayTheyCame) {
  for (const char* method : {"implicit-euler", "bdf2"}) EXPECT_GE(there_and_back(method), 1e-3) << method;
}

TEST(Bridson, IsVerletWithoutDamping) {
  const SplitOde ode = conservative_ode();
  const std::vector<double> steps(50, 0.03);
  EXPECT_LE(distance(final_state(ode, "bridson", start, steps), final_state(ode, "verlet", start, steps)), 1e-12);
}

TEST(Rk4, IsTheSameInOneSubStep) {
  const SplitOde ode = linear_ode(1, true);
  const State bare = final_state(ode, "rk4", start, unequal_steps);
  EXPECT_EQ(distance(bare, final_state(ode, "rk4-substeps", start, unequal_steps)), 0);
}

TEST(Verlet, IsTheRecurrenceOfStoermerWithoutDamping) {
  const SplitOde ode = conservative_ode();
  const double h = 0.03;
  const auto y = run(ode, "verlet", start, std::vector(50, h)).states;
  Vectors f(particles, 3);
  for (std::size_t n = 1; n + 1 < y.size(); ++n) {
    ode.force(0, y[n].x, y[n].v, f);
    const Vectors a = ode.mass.cwiseInverse().asDiagonal() * f;
    EXPECT_LE(largest(y[n + 1].x - 2 * y[n].x + y[n - 1].x - h * h * a), 1e-14);
    EXPECT_LE(largest((y[n + 1].x - y[n - 1].x) / (2 * h) - y[n].v), 1e-13);
  }
}

/// Springs and dampers that belong to the explicit part, so that only the exact Jacobian knows them.
SplitOde ode_with_an_explicit_part() {
  SplitOde ode = linear_ode(0.5, true);
  const SparseMatrix K = laplacian(&Spring::k), D = laplacian(&Spring::d);
  const Pin pin{.particle = 2, .held = solver::axes(true, false, true), .velocity = {0.3, 0, -0.2}};
  ode.pins = {pin};
  ode.force = [K, D](double t, const Vectors& x, const Vectors& v, Vectors& f) {
    f = K * x + D * v + std::sin(3 * t) * Vectors::Ones(particles, 3);
  };
  ode.explicit_force = [=, k = ode.stiffness, d = ode.damping](double t, const Vectors& x, const Vectors& v, Vectors& f) {
    f = K * x + D * v + std::sin(3 * t) * Vectors::Ones(particles, 3) - k * x - d * v;
  };
  ode.jacobian = [K, D](double, const Vectors&, const Vectors&, SparseMatrix& df_dx, SparseMatrix& df_dv) {
    df_dx = known_motions::threefold(K);
    df_dv = known_motions::threefold(D);
  };
  return ode;
}

void expect_the_same(std::string_view one, std::string_view other, const SplitOde& ode) {
  const auto a = run(ode, one, start, unequal_steps).states, b = run(ode, other, start, unequal_steps).states;
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_LE(largest(a[k].x - b[k].x), 1e-12) << one << ", step " << k;
    EXPECT_LE(largest(a[k].v - b[k].v), 1e-12) << one << ", step " << k;
  }
}

TEST(OneNewtonStep, SolvesStagesOfLinearForces) {
  const SplitOde ode = ode_with_an_explicit_part();
  expect_the_same("baraff-witkin", "implicit-euler", ode);
  expect_the_same("one-newton-bdf2", "bdf2", ode);
}

TEST(Bdf2Coefficients, DifferentiateQuadraticsExactly) {
  for (const double w : {0.1, 0.37, 0.5, 1.0, 1.5, 2.0, 2.4}) {
    const auto [c1, c2, c3] = bdf2_coefficients(w);
    const double t = -1 / w;  // of y₋₁, with y0 at 0, y1 at 1:  y1 = c1 y0 − c2 y₋₁ + c3 y1'
    EXPECT_NEAR(1, c1 - c2, 1e-14) << w;
    EXPECT_NEAR(1, -c2 * t + c3, 1e-14) << w;
    EXPECT_NEAR(1, -c2 * t * t + 2 * c3, 1e-14) << w;
  }
}

/// A body that falls freely with a constant or a growing acceleration, without any matrix but M.
Path fall(std::string_view method, double constant, double growing) {
  SplitOde ode = linear_ode(0, false);
  ode.explicit_force = ode.force = [=](double t, const Vectors&, const Vectors&, Vectors& f) {
    f = (constant + growing * t) * masses().replicate<1, 3>();
  };
  ode.jacobian = [](double, const Vectors&, const Vectors&, SparseMatrix& df_dx, SparseMatrix& df_dv) {
    df_dx = df_dv = SparseMatrix(3 * particles, 3 * particles);
  };
  return run(ode, method, start, unequal_steps);
}

TEST(MethodsOfSecondOrder, FollowAConstantAccelerationExactly) {
  for (const Method& m : solver::methods()) {
    if (m.order != 2) continue;
    const auto [t, y] = fall(m.name, 9.81, 0);
    const double T = t.back();
    EXPECT_LE(largest((y.back().x - start.x - T * start.v).array() - 9.81 * T * T / 2), 1e-13) << m.name;
    EXPECT_LE(largest((y.back().v - start.v).array() - 9.81 * T), 1e-13) << m.name;
  }
}

/// They begin with the acceleration of the start in the place of one a part of a step away.
bool begins_otherwise(const Method& m) { return m.name.starts_with("generalized-alpha") || m.name == "hht"; }

TEST(MethodsOfSecondOrder, FollowALinearAccelerationExactlyInTheVelocity) {
  for (const Method& m : solver::methods()) {
    if (m.order != 2 || begins_otherwise(m)) continue;
    const auto [t, y] = fall(m.name, 0, 3);
    EXPECT_LE(largest((y.back().v - start.v).array() - 3 * t.back() * t.back() / 2), 1e-13) << m.name;
  }
}

}  // namespace
}  // namespace drape::verify::methods_test
