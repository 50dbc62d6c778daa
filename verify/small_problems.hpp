#pragma once

#include <algorithm>
#include <iterator>
#include <numbers>
#include <random>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "solver/integrator.hpp"
#include "verify/known_motions.hpp"

/// Small split equations of motion for the tests of solver/: nonlinear, depending on time and velocity, solved by a motion that
/// was chosen beforehand.
namespace drape::verify::small_problems {

using known_motions::Problem;
using known_motions::threefold;
using solver::Method;
using solver::Options;
using solver::Pin;
using solver::SparseMatrix;
using solver::SplitOde;
using solver::State;
using solver::Vectors;

constexpr int particles = 5;
constexpr double start_time = 0.4;  ///< [s], not zero, so that nothing can leave it out

inline Options tolerances(double loop, double cg) {
  Options options;
  options.loop_tolerance = loop;
  options.cg_tolerance = cg;
  return options;
}

/// So tight that what is left of the error is the method's own.
inline Options tight() { return tolerances(1e-13, 1e-14); }

/// Numbers between −1 and 1.
inline Vectors noise(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  return Vectors::NullaryExpr(n, 3, [&] { return number(random); });
}

inline double largest(const Eigen::MatrixXd& a) { return a.cwiseAbs().maxCoeff(); }
inline double distance(const State& a, const State& b) { return std::max(largest(a.x - b.x), largest(a.v - b.v)); }

struct Spring {
  int i, j;
  double k, d;
};
inline constexpr Spring springs[] = {{0, 1, 12, 0.4}, {1, 2, 8, 0.9}, {2, 3, 9, 0.2},
                                     {3, 4, 5, 0.7},  {0, 3, 7, 0.5}, {1, 4, 6, 0.3}};

inline Eigen::VectorXd masses() { return Eigen::Vector<double, particles>(0.5, 1.0, 2.0, 0.7, 1.3); }

/// The graph Laplacian of the springs with one of their coefficients for weights.
inline SparseMatrix laplacian(double Spring::*weight) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Spring& s : springs)
    for (const auto& [row, col, sign] : {std::tuple(s.i, s.i, -1), {s.i, s.j, 1}, {s.j, s.i, 1}, {s.j, s.j, -1}})
      entries.emplace_back(row, col, sign * s.*weight);
  SparseMatrix L(particles, particles);
  L.setFromTriplets(entries.begin(), entries.end());
  return L;
}

/// The nonlinear part: springs that weaken as they stretch and breathe with time, and a drag that grows with the speed:
///   f_i = Σ_j a(t) r_ij / sqrt(1 + |r_ij|²) − b(t) |v_i|² v_i,   r_ij = x_j − x_i.
struct Nonlinear {
  static double a(double t) { return 3 + 2 * std::sin(3 * t); }
  static double b(double t) { return 0.5 + 0.3 * std::cos(2 * t); }

  static Vectors force(double t, const Vectors& x, const Vectors& v) {
    Vectors f = -b(t) * v.rowwise().squaredNorm().asDiagonal() * v;
    for (const Spring& s : springs) {
      const Eigen::RowVector3d r = x.row(s.j) - x.row(s.i), pull = a(t) / std::sqrt(1 + r.squaredNorm()) * r;
      f.row(s.i) += pull;
      f.row(s.j) -= pull;
    }
    return f;
  }

  /// Adds to the derivatives, both 3N × 3N.
  static void jacobian(double t, const Vectors& x, const Vectors& v, Eigen::MatrixXd& df_dx, Eigen::MatrixXd& df_dv) {
    const auto I = Eigen::Matrix3d::Identity();
    for (const Spring& s : springs) {
      const Eigen::RowVector3d r = x.row(s.j) - x.row(s.i);
      const double q = 1 + r.squaredNorm();
      const Eigen::Matrix3d dpull = a(t) / std::sqrt(q) * (I - r.transpose() * r / q);
      for (const auto& [row, col, sign] : {std::tuple(s.i, s.i, -1), {s.i, s.j, 1}, {s.j, s.i, 1}, {s.j, s.j, -1}})
        df_dx.block<3, 3>(3 * row, 3 * col) += sign * dpull;
    }
    for (int i = 0; i < particles; ++i) {
      const Eigen::RowVector3d w = v.row(i);
      df_dv.block<3, 3>(3 * i, 3 * i) -= b(t) * (w.squaredNorm() * I + 2 * w.transpose() * w);
    }
  }
};

/// A motion and its exact derivatives: x(t) = place + t drift + Σ amplitude sin(ω t + phase), coordinate by coordinate.
struct Motion {
  struct Wave {
    double frequency;
    Vectors amplitude, phase;
  };
  Vectors place, drift;
  std::vector<Wave> waves;

  /// The n-th derivative.
  Vectors operator()(int n, double t) const {
    Vectors sum = n == 0 ? place + t * drift : n == 1 ? drift : Vectors::Zero(particles, 3);
    for (const Wave& w : waves) {
      const Eigen::ArrayX3d angle = w.phase.array() + (w.frequency * t + n * std::numbers::pi / 2);
      sum.array() += std::pow(w.frequency, n) * w.amplitude.array() * angle.sin();
    }
    return sum;
  }
};

/// Waves of different frequencies in the free coordinates, the prescribed velocity in the pinned ones.
inline Motion motion(const std::vector<Pin>& pins) {
  Motion x{noise(particles, 1), 0.2 * noise(particles, 2), {}};
  x.waves = {{1.3, 0.4 * noise(particles, 3), 3 * noise(particles, 4)},
             {2.9, 0.2 * noise(particles, 5), 3 * noise(particles, 6)}};
  prescribe(pins, x.drift);
  for (Motion::Wave& wave : x.waves) filter(pins, wave.amplitude);
  return x;
}

/// M x'' = K x + D x' + g(t, x, x') + what is left over when the chosen motion is inserted.
inline Problem manufactured(const std::string& name, const std::vector<Pin>& pins) {
  SplitOde ode;
  ode.mass = masses();
  ode.stiffness = laplacian(&Spring::k);
  ode.damping = laplacian(&Spring::d);
  ode.pins = pins;
  const auto linear = [K = ode.stiffness, D = ode.damping](const Vectors& x, const Vectors& v) -> Vectors {
    return K * x + D * v;
  };
  const auto left_over = [=, exact = motion(pins)](double t) -> Vectors {
    const Vectors x = exact(0, t), v = exact(1, t);
    return masses().asDiagonal() * exact(2, t) - linear(x, v) - Nonlinear::force(t, x, v);
  };
  ode.explicit_force = [=](double t, const Vectors& x, const Vectors& v, Vectors& f) {
    f = Nonlinear::force(t, x, v) + left_over(t);
  };
  ode.force = [=, f_expl = ode.explicit_force](double t, const Vectors& x, const Vectors& v, Vectors& f) {
    f_expl(t, x, v, f);
    f += linear(x, v);
  };
  ode.jacobian = [K = threefold(ode.stiffness), D = threefold(ode.damping)](double t, const Vectors& x, const Vectors& v,
                                                                            SparseMatrix& df_dx, SparseMatrix& df_dv) {
    Eigen::MatrixXd dx = K, dv = D;
    Nonlinear::jacobian(t, x, v, dx, dv);
    df_dx = dx.sparseView();
    df_dv = dv.sparseView();
  };
  const auto exact = [x = motion(pins)](double t) { return State{x(0, t), x(1, t)}; };
  return {name, ode, exact(start_time), exact};
}

inline Problem free_particles() { return manufactured("free", {}); }
inline Problem pinned_particle() { return manufactured("pinned", {Pin{.particle = 3}}); }
inline Problem towed_particle() { return manufactured("towed", {Pin{.particle = 0, .velocity = {0.5, -0.3, 0.2}}}); }
inline Problem partly_pinned() {
  return manufactured("partly_pinned", {Pin{.particle = 1, .fixed = {true, false, false}},
                                        Pin{.particle = 4, .fixed = {false, true, true}, .velocity = {99, 0.4, -0.2}}});
}

/// A problem whose force is not finite after a time, and whose matrix is not definite for long steps, as some methods look at
/// the force only at the beginning of a step.
inline Problem breaking(double time) {
  Problem broken = partly_pinned();
  broken.ode.stiffness *= -1;
  for (auto* f : {&broken.ode.force, &broken.ode.explicit_force})
    *f = [original = *f, time](double t, const Vectors& x, const Vectors& v, Vectors& force) {
      original(t, x, v, force);
      if (t > time) force(2, 1) = std::nan("");
    };
  return broken;
}

inline std::vector<Problem> problems() { return {free_particles(), pinned_particle(), partly_pinned(), towed_particle()}; }

/// Tests are parameterised by the names of rows, which GoogleTest can print.
template <class Rows>
std::vector<std::string> names(const Rows& rows) {
  std::vector<std::string> result;
  for (const auto& row : rows) result.emplace_back(row.name);
  return result;
}
inline std::vector<Method> implicit_methods() {
  std::vector<Method> implicit;
  std::ranges::copy_if(solver::methods(), std::back_inserter(implicit), &Method::implicit);
  return implicit;
}
inline Problem problem_named(const std::string& name) {
  const auto all = problems();
  return *std::ranges::find(all, name, &Problem::name);
}

/// A name as GoogleTest wants it in the name of a test.
inline std::string identifier(std::string name) {
  std::ranges::replace(name, '-', '_');
  return name;
}

}  // namespace drape::verify::small_problems
