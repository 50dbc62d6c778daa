#include "bench/studies/trial.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "bench/runs/energy_guard.hpp"
#include "reference/distance.hpp"

namespace drape::bench {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// The methods of a reference, the best first. No two share an error: where artificial inertia or damping of one remain,
/// it differs from the others.
std::vector<Conditions> reference_runs(double size, double until) {
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

std::string reason(const RunEnd& end) {
  const solver::RunResult& result = end.result;
  if (result.outcome != solver::Outcome::out_of_evaluations) return result.message;
  return fmt::format("not finished in {} evaluations, at t = {:.4g} s", end.evaluations - 1, result.last_good_time);
}

RunEnd attempt(const Specimen& specimen, const Conditions& conditions) {
  RunSpec spec{specimen.scene, "", conditions.method, conditions.step, conditions.options};
  spec.scene.end = conditions.until;
  EnergyGuardObserver guard;
  Observer* const observers[] = {&guard};
  return run(spec, specimen.cloth, observers, {.evaluations = conditions.budget});
}

CrossCheckedReference::CrossCheckedReference(const Specimen& specimen, double until, double effort)
    : CrossCheckedReference(
          specimen, until, [&](const Conditions& conditions) { return attempt(specimen, conditions); }, effort) {}

CrossCheckedReference::CrossCheckedReference(const Specimen& specimen, double until,
                                             const std::function<RunEnd(const Conditions&)>& run, double effort)
    : size_(model::size(specimen.scene)), mass_(specimen.cloth.ode.mass), positions_(not_known), centre_(not_known) {
  for (Conditions& conditions : reference_runs(size_, until)) {
    conditions.budget = static_cast<std::int64_t>(effort * static_cast<double>(conditions.budget));
    const RunEnd trial = run(conditions);
    if (!trial.succeeded()) continue;
    if (truth_.size() == 0) {
      truth_ = trial.state.x;
      continue;
    }
    positions_ = reference::rms_distance(trial.state.x, truth_) / size_;
    centre_ = centre_distance(trial.state.x);
    return;
  }
}

double CrossCheckedReference::centre_distance(const solver::Vectors& x) const {
  return reference::centre_of_mass(mass_, x - truth_).norm() / size_;
}

UncertainError CrossCheckedReference::measure(const RunEnd& trial, double bound) const {
  constexpr double telling = 0.25;  // part of the bound
  if (!trial.succeeded() || !(centre_ <= telling * bound)) return {};
  if (positions_ <= telling * bound) return {reference::rms_distance(trial.state.x, truth_) / size_, positions_};
  return {centre_distance(trial.state.x), centre_};
}

}  // namespace drape::bench
