#include "bench/trial.hpp"

#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <limits>

#include "model/energy_guard.hpp"

namespace drape::bench {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

struct Exhausted {};

/// The same equation, whose functions count their calls and end the run that exceeds its budget.
solver::SplitOde metered(solver::SplitOde ode, std::int64_t budget, Trial& trial) {
  const auto count = [budget, &trial] {
    if (++trial.evaluations > budget) throw Exhausted();
  };
  ode.force = [=, force = ode.force](double t, const solver::Vectors& x, const solver::Vectors& v, solver::Vectors& f) {
    count();
    force(t, x, v, f);
  };
  ode.explicit_force = [=, force = ode.explicit_force](double t, const solver::Vectors& x, const solver::Vectors& v,
                                                       solver::Vectors& f) {
    count();
    force(t, x, v, f);
  };
  ode.newton_matrix = [=, &trial, newton = ode.newton_matrix](double t, const solver::Vectors& x, const solver::Vectors& v,
                                                              double gamma, bool lean, solver::SparseMatrix& J) {
    count();
    ++trial.newton_matrices;
    newton(t, x, v, gamma, lean, J);
  };
  return ode;
}

double rms(const solver::Vectors& difference) { return difference.norm() / std::sqrt(difference.rows()); }

double centre(const Eigen::VectorXd& mass, const solver::Vectors& difference) {
  return (mass.transpose() * difference).norm() / mass.sum();
}

Conditions controlled(const char* method, double size, double until, double tolerance) {
  Conditions conditions{&solver::method(method), {}, until / 8, until, 40'000};
  conditions.options.error_control = {tolerance, size, until};
  return conditions;
}

}  // namespace

std::string Trial::reason() const {
  if (!finished) return fmt::format("not finished in {} evaluations, at t = {:.4g} s", evaluations - 1, run.last_good_time);
  return run.message;
}

Trial attempt(const Specimen& specimen, const Conditions& conditions) {
  Trial trial;
  const solver::SplitOde ode = metered(specimen.cloth.ode, conditions.budget, trial);
  const model::EnergyGuard guard(specimen.scene, specimen.cloth);
  solver::Integrator integrator(ode, *conditions.method, conditions.options, specimen.cloth.start);
  const std::clock_t begin = std::clock();
  try {
    trial.run = model::integrate(integrator, ode, guard, conditions.until, conditions.step);
  } catch (const Exhausted&) {
    trial.finished = false;
    trial.run.last_good_time = integrator.time();
  }
  trial.cpu_ms = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  trial.end = integrator.state();
  return trial;
}

Yardstick::Yardstick(const Specimen& specimen, double until, double tolerance)
    : Yardstick(specimen, until, tolerance, [&](const Conditions& conditions) { return attempt(specimen, conditions); }) {}

Yardstick::Yardstick(const Specimen& specimen, double until, double tolerance,
                     const std::function<Trial(const Conditions&)>& run)
    : size_(model::size(specimen.scene)), mass_(specimen.cloth.ode.mass), positions_(not_known), centre_(not_known) {
  const Trial one = run(controlled("esdirk3", size_, until, tolerance));
  if (!one.succeeded()) return;
  const Trial other = run(controlled("tr-bdf2", size_, until, tolerance));
  if (!other.succeeded()) return;
  truth_ = one.end.x;
  positions_ = rms(one.end.x - other.end.x) / size_;
  centre_ = centre(mass_, one.end.x - other.end.x) / size_;
}

results::Measured Yardstick::measure(const Trial& trial, double bound) const {
  constexpr double telling = 0.25;  // part of the bound
  if (!trial.succeeded() || !(centre_ <= telling * bound)) return {};
  const solver::Vectors difference = trial.end.x - truth_;
  if (positions_ <= telling * bound) return {rms(difference) / size_, positions_};
  return {centre(mass_, difference) / size_, centre_};
}

}  // namespace drape::bench
