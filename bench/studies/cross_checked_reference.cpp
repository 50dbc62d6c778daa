#include "bench/studies/cross_checked_reference.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "bench/runs/energy_guard.hpp"
#include "reference/distance.hpp"

namespace drape::bench {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

struct ReferenceRun {
  RunSpec spec;
  double evaluations;  ///< that it may usually take
};

/// The methods of a reference, the best first. No two share an error: where artificial inertia or damping of one remain,
/// it differs from the others.
std::vector<ReferenceRun> reference_runs(const model::Scene& scene) {
  constexpr double tolerance = 3e-4;
  const double end = scene.end;
  std::vector<ReferenceRun> all;
  const auto add = [&](const char* method, int steps, double evaluations) {
    all.push_back({{scene, "", &solver::method(method), end / steps, {}}, evaluations});
  };
  for (const char* name : {"esdirk3", "tr-bdf2"}) {
    add(name, 8, 5'000);
    all.back().spec.options.error_control = {tolerance, model::size(scene), end};
  }
  add("verlet", 8, 200'000);
  add("midpoint", 50, 5'000);
  add("sbdf2", 400, 5'000);
  return all;
}

}  // namespace

std::string reason(const RunEnd& end) {
  const solver::RunResult& result = end.result;
  if (result.outcome != solver::Outcome::out_of_evaluations) return result.message;
  return fmt::format("not finished in {} evaluations, at t = {:.4g} s", end.evaluations - 1, result.last_good_time);
}

CrossCheckedReference::CrossCheckedReference(const CompiledScene& sheet, double effort)
    : CrossCheckedReference(
          sheet, [&](const RunSpec& spec, const Limits& limits) { return run_guarded(spec, sheet.cloth, limits); }, effort) {}

CrossCheckedReference::CrossCheckedReference(const CompiledScene& sheet, const Run& run, double effort)
    : size_(model::size(sheet.scene)), mass_(sheet.cloth.ode.mass), positions_(not_known), centre_(not_known) {
  for (const auto& [spec, evaluations] : reference_runs(sheet.scene)) {
    const RunEnd end = run(spec, {.evaluations = static_cast<std::int64_t>(effort * evaluations)});
    if (!end.succeeded()) continue;
    if (truth_.size() == 0) {
      truth_ = end.state.x;
      continue;
    }
    positions_ = reference::rms_distance(end.state.x, truth_) / size_;
    centre_ = centre_distance(end.state.x);
    return;
  }
}

double CrossCheckedReference::centre_distance(const solver::Vectors& x) const {
  return reference::centre_distance(mass_, x, truth_) / size_;
}

UncertainError CrossCheckedReference::measure(const RunEnd& end, double bound) const {
  constexpr double telling = 0.25;  // part of the bound
  if (!end.succeeded() || !(centre_ <= telling * bound)) return {};
  if (positions_ <= telling * bound) return {reference::rms_distance(end.state.x, truth_) / size_, positions_};
  return {centre_distance(end.state.x), centre_};
}

}  // namespace drape::bench
