#include "reference/theory/amplification.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "solver/base/decompositions.hpp"
#include "solver/stage/stage_solver.hpp"

namespace drape::reference {
namespace {

// Neither is 1, so that nothing can leave them out.
constexpr double h = 0.125, mass = 0.7;

/// Whether the fixed-point loop comes down to round-off in some 10⁵ updates. Where W > ν the error changes its sign with every
/// update, and close to −1 the right-hand side vanishes to which tolerances are relative. Not known without a theory of the
/// method.
bool loop_converges(const solver::Method& method, const Mode& mode) {
  if (!method.nonlinear()) return true;
  return has_theory(method.name) && loop_contraction(method.name, mode) <= (mode.W > mode.nu ? 0.9 : 0.9995);
}

solver::Options exact_options() {
  solver::Options options = solver::thesis_options();
  options.loop_tolerance = 1e-14;
  options.cg_tolerance = 1e-15;
  options.max_updates = 1'000'000;
  options.verlet_fraction = 1;
  return options;
}

/// What a method takes from step to step, as a vector: of each of its last states, the newest first, x, h v and h² times the
/// rows that it keeps in `Point::f`, all in the first coordinate.
struct Lags {
  Eigen::Index states, kept;

  Eigen::Index entries() const { return 2 + kept; }
  Eigen::Index size() const { return states * entries(); }
};

/// The second coordinate is displaced, or tolerances would be relative to nothing where u is but a velocity in the past.
solver::Point point(const Eigen::Ref<const Eigen::VectorXd>& u) {
  const Eigen::Index kept = u.size() - 2;
  solver::Point p{0,
                  {solver::Vectors::Zero(1, 3), solver::Vectors::Zero(1, 3)},
                  solver::Vectors::Zero(std::max<Eigen::Index>(kept, 1), 3),
                  kept > 0};
  p.y.x(0) = u[0];
  p.y.x(1) = 1;
  p.y.v(0) = u[1] / h;
  if (p.has_f) p.f.col(0) = u.tail(kept) / (h * h);
  return p;
}

/// The points, the newest at time 0, after a step of h even if it is the only one.
solver::History history(const Lags& memory, const Eigen::VectorXd& u) {
  const auto lag = [&](Eigen::Index k) {
    solver::Point p = point(u.segment(k * memory.entries(), memory.entries()));
    p.t = -static_cast<double>(k) * h;
    return p;
  };
  const int points = static_cast<int>(memory.states);
  solver::History all(points, points, lag(memory.states - 1));
  for (Eigen::Index k = memory.states; k-- > 0;) {
    solver::Point next = lag(k);
    all.push(next, h);
  }
  return all;
}

/// One step on the mode: the point at which it ends.
solver::Point advance(const solver::Method& method, const solver::SplitOde& ode, const solver::Options& options,
                      solver::StageSolver* stage, solver::LinearisedSystem* linearised, solver::PhiFunctions* phi,
                      const Lags& memory, const Eigen::VectorXd& u) {
  const solver::Vectors none = solver::Vectors::Zero(1, 3);
  std::int64_t substeps = 0, limits = 0;
  solver::History past = history(memory, u);
  solver::Point next = point(Eigen::VectorXd::Zero(2));
  solver::Scratch scratch{none, none, none, {}};
  solver::StepError error;
  std::any kept;
  solver::SubStepping sub_stepping{.limit = method.sub_steps ? h : 0, .substeps = substeps, .limits = limits};
  solver::Step step{.ode = ode,
                    .options = options,
                    .stage = stage,
                    .contacts = nullptr,
                    .linearised = linearised,
                    .phi = phi,
                    .history = past,
                    .next = next,
                    .scratch = scratch,
                    .sub_stepping = sub_stepping,
                    .error = error,
                    .kept = kept,
                    .h = h};
  method.step(step);
  if (step.result.outcome != solver::Outcome::success)
    throw std::runtime_error("a step of " + std::string(method.name) +
                             " on a linear mode failed: " + std::string(to_string(step.result.outcome)));
  return next;
}

/// The same as a vector, which the memory before it follows.
Eigen::VectorXd remembered(const solver::Point& end, const Lags& memory, const Eigen::VectorXd& u) {
  Eigen::VectorXd u1(memory.size());
  u1.head(2) << end.y.x(0), h * end.y.v(0);
  u1.segment(2, memory.kept) = h * h * end.f.col(0).head(memory.kept);
  u1.tail(memory.size() - memory.entries()) = u.head(memory.size() - memory.entries());
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
  ode.jacobian = [mode](double, const solver::Vectors&, const solver::Vectors&, solver::SparseMatrix& df_dx,
                        solver::SparseMatrix& df_dv) {
    df_dx = (-mass * mode.omega_squared * Eigen::Matrix3d::Identity()).sparseView();
    df_dv = (-mass * mode.damping * Eigen::Matrix3d::Identity()).sparseView();
  };
  return ode;
}

Eigen::MatrixXd amplification_matrix(const solver::Method& method, const Mode& mode) {
  LinearMode linear{mode.nu / (h * h), mode.W / (h * h), mode.s / h};
  if (!loop_converges(method, mode)) linear.kappa = linear.omega_squared;
  const solver::SplitOde ode = mode_ode(linear);
  const solver::Options options = exact_options();
  std::optional<solver::StageSolver> stage;
  std::optional<solver::LinearisedSystem> linearised;
  std::optional<solver::PhiFunctions> phi;
  if (method.implicit()) stage.emplace(ode, options);
  if (method.stages == solver::Method::Stages::linearised) linearised.emplace(ode);
  if (method.stages == solver::Method::Stages::exponential) phi.emplace(ode);
  const auto end = [&](const Lags& memory, const Eigen::VectorXd& u) {
    return advance(method, ode, options, stage ? &*stage : nullptr, linearised ? &*linearised : nullptr, phi ? &*phi : nullptr,
                   memory, u);
  };

  Lags memory{method.history, 0};
  if (const solver::Point first = end(memory, Eigen::VectorXd::Unit(memory.size(), 0)); first.has_f)
    memory.kept = first.f.rows();
  Eigen::MatrixXd G(memory.size(), memory.size());
  for (Eigen::Index j = 0; j < memory.size(); ++j) {
    const auto u = Eigen::VectorXd::Unit(memory.size(), j);
    G.col(j) = remembered(end(memory, u), memory, u);
  }
  return G;
}

std::vector<std::complex<double>> amplification_factors(const solver::Method& method, const Mode& mode) {
  const Eigen::MatrixXd G = amplification_matrix(method, mode);
  // Velocities in units of ω and accelerations in those of ω², so that the entries are less unequal: the factors are the same
  // with fewer roundings.
  const double omega = std::sqrt(1 + mode.W), units[] = {1, omega, omega * omega};
  const Eigen::Index entries = G.rows() / method.history;
  const auto unit = [&](Eigen::Index i) { return units[std::min<Eigen::Index>(i % entries, 2)]; };
  const Eigen::MatrixXd scaled =
      Eigen::MatrixXd::NullaryExpr(G.rows(), G.cols(), [&](auto i, auto j) { return G(i, j) * unit(j) / unit(i); });
  const Eigen::VectorXcd eigenvalues = base::eigenvalues(scaled);
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
