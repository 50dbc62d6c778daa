#include "solver/stability.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <random>

#include "solver/base/decompositions.hpp"

namespace drape::solver {
namespace {

/// Largest |eigenvalue| of a linear map of N × 3 vectors by Arnoldi's iteration, whose eigenvalues approach the outermost
/// from within: it takes tens of products, power iteration would take hundreds, and a restarted space, as in Spectra's
/// GenEigsSolver, two to three times as many. Memory is allocated as the basis grows. The first vector is the same for all
/// processes that share the particles out.
template <class Map>
double largest_eigenvalue(const SplitOde& ode, const Map& map) {
  constexpr int most = 60, check = 6;
  const Partition& all = *ode.partition;
  const Eigen::Index n = 3 * ode.particles();
  const auto [before, particles] = all.place(ode.particles());
  const auto [first, count] = all.own(n);
  Eigen::MatrixXd V(n, check), H = Eigen::MatrixXd::Zero(most + 1, most);
  Vectors z(ode.particles(), 3), w = z;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int c = 0; c < 3; ++c)
    for (Eigen::Index i = -before; i < particles - before; ++i) {
      const double component = normal(random);
      if (i >= 0 && i < z.rows()) z(i, c) = component;
    }
  filter(ode.pins, z);
  const double length = all.norm(z);
  if (length == 0) return 0;
  V.col(0) = Eigen::VectorXd::Map(z.data(), n) / length;
  double eigenvalue = 0;
  for (int k = 0; k < most; ++k) {
    if (k + 1 == V.cols()) V.conservativeResize(Eigen::NoChange, V.cols() + check);
    Eigen::VectorXd::Map(z.data(), n) = V.col(k);
    map(z, w);
    auto next = V.col(k + 1);
    next = Eigen::VectorXd::Map(w.data(), n);
    const double size = all.norm(w);
    if (!std::isfinite(size)) return size;
    const auto basis = V.leftCols(k + 1);
    auto column = H.col(k).head(k + 1);
    column.noalias() = basis.middleRows(first, count).transpose() * next.segment(first, count);
    all.add_up({column.data(), static_cast<std::size_t>(column.size())});
    next.noalias() -= basis * column;
    H(k + 1, k) = std::sqrt(all.sum(next.segment(first, count).squaredNorm()));
    const bool complete = H(k + 1, k) <= 1e-6 * size || k + 1 == 3 * particles;
    if (complete || (k + 1) % check == 0) {
      const double estimate = base::eigenvalues(H.topLeftCorner(k + 1, k + 1)).cwiseAbs().maxCoeff();
      if (complete || estimate - eigenvalue <= 1e-3 * estimate) return estimate;
      eigenvalue = estimate;
    }
    next /= H(k + 1, k);
  }
  return eigenvalue;
}

/// Largest modulus of the eigenvalues of one step of `verlet` on (x, h v, h² a).
double amplification(double W, double s) {
  Eigen::Matrix3d G;
  // x1 = x0 + v0 + a0/2,   a1 = −W x1 − s (v0 + a0),   v1 = v0 + (a0 + a1)/2
  G.row(0) << 1, 1, 0.5;
  G.row(2) << -W, -W - s, -W / 2 - s;
  G.row(1) = Eigen::RowVector3d(0, 1, 0.5) + 0.5 * G.row(2);
  return base::eigenvalues(G).cwiseAbs().maxCoeff();
}

/// Largest |R(h λ)| of the classical Runge-Kutta method, R(z) = 1 + z + z²/2 + z³/6 + z⁴/24, of the two λ of a mode.
double rk4_amplification(double W, double s) {
  const std::complex<double> root = std::sqrt(std::complex<double>(s * s / 4 - W));
  const auto R = [](std::complex<double> z) { return std::abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)))); };
  return std::max(R(-s / 2 + root), R(-s / 2 - root));
}

/// The same of all modes with at most this W and s, of which the stiffest need not be the worst: where λ lies at 123 degrees,
/// |h λ| may be 2.616 only.
double worst_rk4_amplification(double W, double s) {
  constexpr double parts = 32;
  double worst = 0;
  for (double part = 0; part <= parts; ++part)
    worst = std::max({worst, rk4_amplification(W, s * part / parts), rk4_amplification(W * part / parts, s)});
  return worst;
}

/// The largest step up to which `amplification` is not above 1, found by bisection; `unstable`: a part of 1/ω, 1/c above it.
double largest_stable_step(const Spectrum& spectrum, double (*amplification)(double W, double s), double of_omega,
                           double of_c) {
  const double omega = std::sqrt(spectrum.omega_squared), c = spectrum.decay;
  if (!std::isfinite(omega + c)) return std::numeric_limits<double>::quiet_NaN();
  if (omega == 0 && c == 0) return std::numeric_limits<double>::infinity();
  double stable = 0, unstable = std::min(omega > 0 ? of_omega / omega : INFINITY, c > 0 ? of_c / c : INFINITY) * 1.01;
  while (unstable - stable > 1e-6 * unstable) {
    const double h = 0.5 * (stable + unstable);
    (amplification(h * h * omega * omega, h * c) <= 1 + 1e-9 ? stable : unstable) = h;
  }
  return stable;
}

}  // namespace

Spectrum spectrum(const SplitOde& ode, double t, const State& y) {
  constexpr double difference = 1e-7;  // over the size of the argument: half of the digits
  Vectors f(ode.particles(), 3);
  ode.force(t, y.x, y.v, f);
  State moved = y;
  const auto largest = [&](Vectors State::*argument, double size) {
    const double step = difference * (size > 0 ? size : 1);
    const double eigenvalue = largest_eigenvalue(ode, [&](const Vectors& z, Vectors& w) {
      const double delta = step / ode.partition->largest_entry(z);
      moved.*argument = y.*argument + delta * z;
      ode.force(t, moved.x, moved.v, w);
      w = ode.mass.cwiseInverse().asDiagonal() * (w - f) / delta;
      filter(ode.pins, w);
    });
    moved.*argument = y.*argument;
    return spectrum_safety * eigenvalue;
  };
  const double length = ode.partition->largest_entry(y.x), omega_squared = largest(&State::x, length);
  const double speed = std::max(ode.partition->largest_entry(y.v), length * std::sqrt(omega_squared));
  return {omega_squared, largest(&State::v, speed)};
}

double verlet_limit(const Spectrum& spectrum) { return largest_stable_step(spectrum, amplification, 2, 1); }

double rk4_limit(const Spectrum& spectrum) {
  return largest_stable_step(spectrum, worst_rk4_amplification, std::sqrt(8), 2.786);
}

double rkl2_stages(double h_decay) { return std::max(2.0, std::ceil((std::sqrt(9 + 8 * h_decay) - 1) / 2)); }

double rkc2_stages(double h_decay) {
  return std::max(2.0, std::ceil(std::sqrt(1 + 1.5 * h_decay / (1 - 2 * rkc2_damping / 15))));
}

double rock2_stages(double h_decay) { return std::max(3.0, std::ceil(std::sqrt((h_decay + 1.145) / 0.807))); }

}  // namespace drape::solver
