#include "solver/stability.hpp"

#include <cmath>
#include <limits>
#include <random>

#include "solver/decompositions.hpp"

namespace drape::solver {
namespace {

/// Largest |eigenvalue| of M⁻¹ J with rows and columns of pinned coordinates removed.
double largest_eigenvalue(const SplitOde& ode, const SparseMatrix& J) {
  if (J.nonZeros() == 0) return 0;
  const auto n = ode.particles();
  Vectors z(n, 3), w(n, 3);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (double& component : z.reshaped()) component = normal(random);
  filter(ode.pins, z);
  double eigenvalue = 0;
  for (int k = 0; k < 1000; ++k) {
    const double norm = z.norm();
    if (norm == 0) return 0;
    z /= norm;
    Eigen::Map<Eigen::VectorXd>(w.data(), w.size()).noalias() = J * Eigen::Map<const Eigen::VectorXd>(z.data(), z.size());
    w = ode.mass.cwiseInverse().asDiagonal() * w;
    filter(ode.pins, w);
    const double estimate = w.norm();
    if (!std::isfinite(estimate) || (k > 10 && std::abs(estimate - eigenvalue) <= 1e-5 * estimate)) return estimate;
    eigenvalue = estimate;
    std::swap(z, w);
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
  return eigenvalues(G).cwiseAbs().maxCoeff();
}

}  // namespace

Spectrum spectrum(const SplitOde& ode, double t, const State& y) {
  SparseMatrix df_dx, df_dv;
  ode.jacobian(t, y.x, y.v, df_dx, df_dv);
  return {1.01 * largest_eigenvalue(ode, df_dx), 1.01 * largest_eigenvalue(ode, df_dv)};
}

double verlet_limit(const Spectrum& spectrum) {
  const double omega = std::sqrt(spectrum.omega_squared), c = spectrum.decay;
  if (!std::isfinite(omega + c)) return std::numeric_limits<double>::quiet_NaN();
  if (omega == 0 && c == 0) return std::numeric_limits<double>::infinity();
  double stable = 0, unstable = std::min(omega > 0 ? 2 / omega : INFINITY, c > 0 ? 1 / c : INFINITY) * 1.01;
  while (unstable - stable > 1e-6 * unstable) {
    const double h = 0.5 * (stable + unstable);
    (amplification(h * h * omega * omega, h * c) <= 1 + 1e-9 ? stable : unstable) = h;
  }
  return stable;
}

}  // namespace drape::solver
