#include "reference/amplification.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "solver/decompositions.hpp"
#include "solver/stage_solver.hpp"

namespace drape::reference {
namespace {

// Neither is 1, so that nothing can leave them out.
constexpr double h = 0.125, mass = 0.7;

/// Whether the fixed-point loop comes down to round-off in some 10⁵ updates. Where W > ν the error changes its sign with every
/// update, and close to −1 the right-hand side vanishes to which tolerances are relative.
bool loop_converges(std::string_view method, const Mode& mode) {
  return loop_contraction(method, mode) <= (mode.W > mode.nu ? 0.9 : 0.9995);
}

solver::Options exact_options() {
  solver::Options options = solver::thesis_options();
  options.loop_tolerance = 1e-14;
  options.cg_tolerance = 1e-15;
  options.max_updates = 1'000'000;
  options.verlet_fraction = 1;
  return options;
}

/// (x, h v, h² a), the last if there is one, in the first coordinate. The second is displaced, or tolerances would be relative
/// to nothing where u is but a velocity in the past.
solver::Point point(const Eigen::Ref<const Eigen::VectorXd>& u) {
  solver::Point p{{solver::Vectors::Zero(1, 3), solver::Vectors::Zero(1, 3)}, solver::Vectors::Zero(1, 3)};
  p.y.x(0) = u[0];
  p.y.x(1) = 1;
  p.y.v(0) = u[1] / h;
  p.has_f = u.size() == 3;
  if (p.has_f) p.f(0) = u[2] / (h * h);
  return p;
}

/// What one step makes of the vector u that amplification_matrix() describes.
Eigen::VectorXd advance(const solver::Method& method, const solver::SplitOde& ode, const solver::Options& options,
                        solver::StageSolver* stage, const Eigen::VectorXd& u) {
  const Eigen::Index n = method.two_step ? 2 : u.size();
  const solver::Vectors none = solver::Vectors::Zero(1, 3);
  std::int64_t substeps = 0, limits = 0;
  solver::Step step{.ode = ode,
                    .options = options,
                    .stage = stage,
                    .h = h,
                    .w = method.two_step ? 1.0 : 0.0,
                    .before = point(u.tail(n)),
                    .now = point(u.head(n)),
                    .next = point(Eigen::VectorXd::Zero(n)),
                    .ax = none,
                    .av = none,
                    .f_hat = none,
                    .explicit_limit = h,
                    .substeps = substeps,
                    .limits = limits,
                    .result = {}};
  method.step(step);
  if (step.result.outcome != solver::Outcome::success)
    throw std::runtime_error("a step of " + std::string(method.name) +
                             " on a linear mode failed: " + std::string(to_string(step.result.outcome)));
  Eigen::VectorXd u1(u.size());
  u1.head(2) << step.next.y.x(0), h * step.next.y.v(0);
  if (n == 3) u1[2] = h * h * step.next.f(0);
  if (method.two_step) u1.tail(2) = u.head(2);
  return u1;
}

}  // namespace

Mode at_step(const LinearMode& mode, double step) {
  return {step * step * mode.kappa, step * step * mode.omega_squared, step * mode.damping};
}

solver::SplitOde mode_ode(const LinearMode& mode) {
  const auto times = [](double a) -> solver::SparseMatrix { return Eigen::MatrixXd::Constant(1, 1, a * mass).sparseView(); };
  solver::SplitOde ode;
  ode.mass = Eigen::VectorXd::Constant(1, mass);
  ode.stiffness = times(-mode.kappa);
  ode.damping = times(-mode.damping);
  ode.force = [mode](double, const solver::Vectors& x, const solver::Vectors& v, solver::Vectors& f) {
    f = -mass * (mode.omega_squared * x + mode.damping * v);
  };
  ode.explicit_force = [mode](double, const solver::Vectors& x, const solver::Vectors&, solver::Vectors& f) {
    f = mass * (mode.kappa - mode.omega_squared) * x;
  };
  return ode;
}

Eigen::MatrixXd amplification_matrix(const solver::Method& method, const Mode& mode) {
  LinearMode linear{mode.nu / (h * h), mode.W / (h * h), mode.s / h};
  if (!loop_converges(method.name, mode)) linear.kappa = linear.omega_squared;
  const solver::SplitOde ode = mode_ode(linear);
  const solver::Options options = exact_options();
  std::optional<solver::StageSolver> stage;
  if (method.implicit()) stage.emplace(ode, options);

  const int n = method.two_step ? 4 : method.implicit() ? 2 : 3;
  Eigen::MatrixXd G(n, n);
  for (int j = 0; j < n; ++j) G.col(j) = advance(method, ode, options, stage ? &*stage : nullptr, Eigen::VectorXd::Unit(n, j));
  return G;
}

std::vector<std::complex<double>> amplification_factors(const solver::Method& method, const Mode& mode) {
  const Eigen::MatrixXd G = amplification_matrix(method, mode);
  // Velocities in units of ω, so that the entries are less unequal: the factors are the same with fewer roundings.
  const double omega = std::sqrt(1 + mode.W);
  const auto unit = [&](Eigen::Index i) { return i % 2 == 1 ? omega : 1; };
  const Eigen::MatrixXd scaled =
      Eigen::MatrixXd::NullaryExpr(G.rows(), G.cols(), [&](auto i, auto j) { return G(i, j) * unit(j) / unit(i); });
  const Eigen::VectorXcd eigenvalues = solver::eigenvalues(scaled);
  std::vector<std::complex<double>> factors(eigenvalues.begin(), eigenvalues.end());
  std::ranges::sort(factors, std::ranges::greater{}, [](const std::complex<double>& factor) { return std::abs(factor); });
  return factors;
}

double distance_from_theory(const solver::Method& method, const Mode& mode, const Mode& theory) {
  Eigen::VectorXcd measured = Eigen::VectorXcd::Ones(1);  // Π (z − factor), the constant first
  for (const std::complex<double>& factor : amplification_factors(method, mode)) {
    Eigen::VectorXcd next = Eigen::VectorXcd::Zero(measured.size() + 1);
    next.tail(measured.size()) = measured;
    next.head(measured.size()) -= factor * measured;
    measured = next;
  }
  const Eigen::VectorXd exact = characteristic_polynomial(method.name, theory);
  if (measured.size() != exact.size()) return std::numeric_limits<double>::infinity();
  return (measured - exact).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / exact.cwiseAbs().maxCoeff();
}

double spectral_radius(const solver::Method& method, const Mode& mode) {
  return std::abs(amplification_factors(method, mode).front());
}

double stability_limit(const solver::Method& method, const LinearMode& mode) {
  // Double factors, as at a limit, are known to half the digits only.
  const auto stable = [&](double step) { return spectral_radius(method, at_step(mode, step)) <= 1 + 1e-7; };
  const double rate = std::max(std::sqrt(mode.omega_squared), mode.damping);
  double below = 0, above = 0.1 / rate;
  if (!stable(above)) return 0;
  while (stable(above)) {
    below = above;
    above *= 2;
    if (above * rate >= 1600) return std::numeric_limits<double>::infinity();
  }
  while (above - below > 1e-10 * above) {
    const double middle = (below + above) / 2;
    (stable(middle) ? below : above) = middle;
  }
  return below;
}

ModeBehaviour measured_behaviour(const solver::Method& method, const Mode& mode) {
  const std::complex<double> factor = amplification_factors(method, mode).front();
  return {std::abs(std::arg(factor)), -std::log(std::abs(factor))};
}

}  // namespace drape::reference
