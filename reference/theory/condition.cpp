#include "reference/theory/condition.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "solver/base/decompositions.hpp"
#include "solver/linear/stage_matrix.hpp"

namespace drape::reference {
namespace {

using solver::SparseMatrix;
using solver::Vectors;

double square(double a) { return a * a; }

/// Extreme eigenvalues 4 sin² of the second difference along one direction with N = n − 1 spacings.
ExtremeEigenvalues of_difference(int N, bool pinned_left, bool pinned_right) {
  const double quarter = std::numbers::pi / (4 * N);  // of the longest wave of a line that is pinned at one end
  if (!pinned_left && !pinned_right) return {0, 4};
  if (pinned_left && pinned_right) return {4 * square(std::sin(2 * quarter)), 4 * square(std::cos(2 * quarter))};
  return {4 * square(std::sin(quarter)), 4 * square(std::cos(quarter))};
}

}  // namespace

ExtremeEigenvalues stage_eigenvalues(int n, double g, PinnedBorder pinned) {
  const bool all = pinned == PinnedBorder::all;
  const auto u = of_difference(n - 1, all, all), v = of_difference(n - 1, pinned != PinnedBorder::none, all);
  return {1 + g * (u.least + v.least), 1 + g * (u.largest + v.largest)};
}

double sufficient_iterations(double condition, double reduction) {
  return 0.5 * std::sqrt(condition) * std::log(2 / reduction);
}

SparseMatrix stage_matrix(const solver::SplitOde& ode, double gamma) {
  std::vector<char> gone(static_cast<std::size_t>(ode.particles()), 0);
  for (const solver::Pin& pin : ode.pins) gone[pin.particle] = pin.all();
  SparseMatrix A = solver::stage_matrix(ode, gamma);
  A.prune([&](int i, int j, double) { return i == j || (!gone[i] && !gone[j]); });
  A.makeCompressed();
  return A;
}

KrylovRun krylov_run(const SparseMatrix& A, solver::Preconditioner& preconditioner, const Vectors& solution, double reduction) {
  constexpr double round_off = 1e-13;
  constexpr int most = 20'000;
  Vectors e = solution, r = A * e, z = r, p = Vectors::Zero(r.rows(), 3), q = p;
  const double r0 = r.norm(), error0 = e.cwiseProduct(r).sum();  // <e, A e>, since A e = r
  std::vector<double> alpha, beta;
  KrylovRun run;
  double rz = 0;
  while (r.norm() > round_off * r0 && std::ssize(alpha) < most) {
    const double rz_next = preconditioner.apply(r, z);
    if (!alpha.empty()) beta.push_back(rz_next / rz);
    rz = rz_next;
    p = beta.empty() ? z : Vectors(z + beta.back() * p);
    q = A * p;
    alpha.push_back(rz / p.cwiseProduct(q).sum());
    e -= alpha.back() * p;
    r -= alpha.back() * q;
    const double error = e.cwiseProduct(r).sum();
    if (run.iterations == 0 && error <= square(reduction) * error0) run.iterations = static_cast<int>(alpha.size());
  }
  run.eigenvalues = ritz_values(alpha, beta);
  return run;
}

ExtremeEigenvalues ritz_values(std::span<const double> alpha, std::span<const double> beta) {
  const auto n = std::ssize(alpha);
  Eigen::VectorXd diagonal(n), beside(std::max<Eigen::Index>(n - 1, 0));
  for (Eigen::Index k = 0; k < n; ++k) {
    diagonal[k] = 1 / alpha[k] + (k > 0 ? beta[k - 1] / alpha[k - 1] : 0);
    if (k + 1 < n) beside[k] = std::sqrt(beta[k]) / alpha[k];
  }
  const Eigen::VectorXd values = base::tridiagonal_eigenvalues(diagonal, beside);
  return {values.minCoeff(), values.maxCoeff()};
}

}  // namespace drape::reference
