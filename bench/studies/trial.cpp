#include "bench/studies/trial.hpp"

#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <limits>

#include "bench/runs/energy_guard.hpp"

namespace drape::bench {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

double rms(const solver::Vectors& difference) { return difference.norm() / std::sqrt(difference.rows()); }

double centre(const Eigen::VectorXd& mass, const solver::Vectors& difference) {
  return (mass.transpose() * difference).norm() / mass.sum();
}

/// The methods of a yardstick, the best first. No two share an error: where artificial inertia or damping of one remain,
/// it differs from the others.
std::vector<Conditions> yardsticks(double size, double until) {
  constexpr double tolerance = 3e-4;
  std::vector<Conditions> all;
  for (const char* name : {"esdirk3", "tr-bdf2"}) {
    all.push_back({&solver::method(name), {}, until / 8, until, 5'000});
    all.back().options.error_control = {tolerance, size, until};
  }
  all.push_back({&solver::method("verlet"), {}, until / 8, until, 200'000});
  all.push_back({&solver::method("midpoint"), {}, until / 50, until, 5'000});
  all.push_back({&solver::method("sbdf2"), {}, until / 400, until, 5'000});
  return all;
}

}  // namespace

std::string Attempt::reason() const {
  if (!finished()) return fmt::format("not finished in {} evaluations, at t = {:.4g} s", evaluations - 1, run.last_good_time);
  return run.message;
}

Attempt attempt(const Specimen& specimen, const Conditions& conditions) {
  RunSpec spec{specimen.scene, "", conditions.method, conditions.step, conditions.options};
  spec.scene.end = conditions.until;
  EnergyGuardObserver guard;
  Observer* const observers[] = {&guard};
  const std::clock_t begin = std::clock();
  RunEnd end = run(spec, specimen.cloth, observers, {.evaluations = conditions.budget});
  const double cpu_ms = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return {std::move(end.result), std::move(end.state), end.evaluations, end.newton_matrices, cpu_ms};
}

Yardstick::Yardstick(const Specimen& specimen, double until, double effort)
    : Yardstick(
          specimen, until, [&](const Conditions& conditions) { return attempt(specimen, conditions); }, effort) {}

Yardstick::Yardstick(const Specimen& specimen, double until, const std::function<Attempt(const Conditions&)>& run,
                     double effort)
    : size_(model::size(specimen.scene)), mass_(specimen.cloth.ode.mass), positions_(not_known), centre_(not_known) {
  for (Conditions& conditions : yardsticks(size_, until)) {
    conditions.budget = static_cast<std::int64_t>(effort * static_cast<double>(conditions.budget));
    const Attempt trial = run(conditions);
    if (!trial.succeeded()) continue;
    if (truth_.size() == 0) {
      truth_ = trial.end.x;
      continue;
    }
    positions_ = rms(trial.end.x - truth_) / size_;
    centre_ = centre(mass_, trial.end.x - truth_) / size_;
    return;
  }
}

UncertainError Yardstick::measure(const Attempt& trial, double bound) const {
  constexpr double telling = 0.25;  // part of the bound
  if (!trial.succeeded() || !(centre_ <= telling * bound)) return {};
  const solver::Vectors difference = trial.end.x - truth_;
  if (positions_ <= telling * bound) return {rms(difference) / size_, positions_};
  return {centre(mass_, difference) / size_, centre_};
}

}  // namespace drape::bench
