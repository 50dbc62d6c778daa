#include "verify/support/small_problems.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <random>
#include <tuple>

namespace drape::verify::small_problems {
namespace {

// In the nonlinear part.
double a(double t) { return 3 + 2 * std::sin(3 * t); }
double b(double t) { return 0.5 + 0.3 * std::cos(2 * t); }

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

/// Waves of different frequencies in the free directions, the prescribed velocity in the pinned ones. Where these are oblique
/// all coordinates have one phase, so that they move along a line.
Motion motion(const std::vector<Pin>& pins) {
  Motion x{noise(particles, 1), 0.2 * noise(particles, 2), {}};
  x.waves = {{1.3, 0.4 * noise(particles, 3), 3 * noise(particles, 4)},
             {2.9, 0.2 * noise(particles, 5), 3 * noise(particles, 6)}};
  prescribe(pins, x.drift);
  for (Motion::Wave& wave : x.waves) {
    filter(pins, wave.amplitude);
    for (const Pin& pin : pins)
      if (pin.oblique()) wave.phase.row(pin.particle).setConstant(wave.phase(pin.particle, 0));
  }
  return x;
}

/// M x'' = K x + D x' + g(t, x, x') + what is left over when the chosen motion is inserted.
Problem manufactured(const std::string& name, const std::vector<Pin>& pins) {
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
  ode.mean_excess = Nonlinear::mean_excess;
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

}  // namespace

Options tolerances(double loop, double cg) {
  Options options = solver::thesis_options();
  options.loop_tolerance = loop;
  options.cg_tolerance = cg;
  return options;
}

Options tight() { return tolerances(1e-13, 1e-14); }

Vectors noise(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  return Vectors::NullaryExpr(n, 3, [&] { return number(random); });
}

double largest(const Eigen::MatrixXd& a) { return a.cwiseAbs().maxCoeff(); }

double distance(const State& a, const State& b) { return std::max(largest(a.x - b.x), largest(a.v - b.v)); }

Eigen::VectorXd masses() { return Eigen::Vector<double, particles>(0.5, 1.0, 2.0, 0.7, 1.3); }

SparseMatrix laplacian(double Spring::*weight) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Spring& s : springs)
    for (const auto& [row, col, sign] : {std::tuple(s.i, s.i, -1), {s.i, s.j, 1}, {s.j, s.i, 1}, {s.j, s.j, -1}})
      entries.emplace_back(row, col, sign * s.*weight);
  SparseMatrix L(particles, particles);
  L.setFromTriplets(entries.begin(), entries.end());
  return L;
}

Vectors Nonlinear::force(double t, const Vectors& x, const Vectors& v) {
  Vectors f = -b(t) * v.rowwise().squaredNorm().asDiagonal() * v;
  for (const Spring& s : springs) {
    const Eigen::RowVector3d r = x.row(s.j) - x.row(s.i), pull = a(t) / std::sqrt(1 + r.squaredNorm()) * r;
    f.row(s.i) += pull;
    f.row(s.j) -= pull;
  }
  return f;
}

void Nonlinear::mean_excess(double t, const Vectors& x0, const Vectors& x1, Vectors& f) {
  for (const Spring& s : springs) {
    const Eigen::RowVector3d r0 = x0.row(s.j) - x0.row(s.i), r1 = x1.row(s.j) - x1.row(s.i), middle = (r0 + r1) / 2;
    const auto root = [](const Eigen::RowVector3d& r) { return std::sqrt(1 + r.squaredNorm()); };
    const Eigen::RowVector3d pull = a(t) * (2 / (root(r0) + root(r1)) - 1 / root(middle)) * middle;
    f.row(s.i) += pull;
    f.row(s.j) -= pull;
  }
}

void Nonlinear::jacobian(double t, const Vectors& x, const Vectors& v, Eigen::MatrixXd& df_dx, Eigen::MatrixXd& df_dv) {
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

Problem free_particles() { return manufactured("free", {}); }

Problem pinned_particle() { return manufactured("pinned", {Pin{.particle = 3}}); }

Problem towed_particle() { return manufactured("towed", {Pin{.particle = 0, .velocity = {0.5, -0.3, 0.2}}}); }

Problem partly_pinned() {
  return manufactured("partly_pinned",
                      {Pin{.particle = 1, .held = solver::axes(true, false, false)},
                       Pin{.particle = 4, .held = solver::axes(false, true, true), .velocity = {99, 0.4, -0.2}}});
}

Problem obliquely_pinned() {
  const Eigen::Vector3d held = Eigen::Vector3d(2, -1, 2) / 3, free = Eigen::Vector3d(1, 2, -2) / 3;
  return manufactured(
      "obliquely_pinned",
      {Pin{.particle = 1, .held = held * held.transpose(), .velocity = {0.3, 0.1, 0.2}},
       Pin{.particle = 4, .held = Eigen::Matrix3d::Identity() - free * free.transpose(), .velocity = {0, 0.4, 0.1}}});
}

Problem breaking(double time) {
  Problem broken = partly_pinned();
  broken.ode.stiffness *= -1;
  for (auto* f : {&broken.ode.force, &broken.ode.explicit_force})
    *f = [original = *f, time](double t, const Vectors& x, const Vectors& v, Vectors& force) {
      original(t, x, v, force);
      if (t > time) force(2, 1) = std::nan("");
    };
  return broken;
}

std::vector<Problem> problems() {
  return {free_particles(), pinned_particle(), partly_pinned(), towed_particle(), obliquely_pinned()};
}

std::vector<Method> converging_methods() {
  std::vector<Method> converging;
  std::ranges::copy_if(solver::methods(), std::back_inserter(converging), &Method::converges);
  return converging;
}

std::vector<Method> implicit_methods() {
  std::vector<Method> implicit;
  std::ranges::copy_if(solver::methods(), std::back_inserter(implicit), &Method::implicit);
  return implicit;
}

Problem problem_named(const std::string& name) {
  const auto all = problems();
  return *std::ranges::find(all, name, &Problem::name);
}

std::string identifier(std::string name) {
  std::ranges::replace(name, '-', '_');
  std::ranges::replace(name, '/', '_');
  std::ranges::replace(name, '.', '_');
  return name;
}

}  // namespace drape::verify::small_problems
