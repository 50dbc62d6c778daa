#include "bench/runs/certified_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ranges>
#include <string>

#include "bench/runs/interruption.hpp"
#include "bench/runs/motion_error.hpp"
#include "bench/runs/verbosity.hpp"
#include "model/phases.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/plausible.hpp"
#include "solver/base/largest.hpp"

namespace drape::bench {
namespace {

using solver::State;

constexpr double reference_tolerances[] = {1e-9, 1e-10, 1e-11, 1e-12};  ///< of references

/// Whether obstacles respond to what is inside at the end of a step, so that no ODE tells the motion: its limit for short steps
/// is that of inelastic constraints.
bool switches(const model::Scene& scene) {
  const model::ResponseKind response = scene.contact.response;
  return !scene.obstacles.empty() && (model::relocates(response) || response == model::ResponseKind::alteration);
}

/// The loosest of them that promises an uncertainty, as it falls with the tolerance; at least the next.
double tightened(double tolerance, double factor) {
  for (const double next : reference_tolerances)
    if (next < 0.99 * tolerance && next <= 1.01 * factor * tolerance) return next;
  return reference_tolerances[std::size(reference_tolerances) - 1];
}

}  // namespace

std::vector<double> compared_times(const model::Scene& scene) {
  constexpr int count = 10;
  std::vector<double> times;
  for (int k = 1; k <= count; ++k) times.push_back(scene.end * k / count);
  return times;
}

References::~References() {
  for (const std::string& message : cache_.messages()) say_note(message);
}

reference::Reference References::operator()(const model::Scene& scene, const model::Cloth& cloth) {
  return (*this)(scene, cloth, compared_times(scene));
}

reference::Reference References::operator()(const model::Scene& scene, const model::Cloth& cloth,
                                            const std::vector<double>& times) {
  return certified(scene, cloth, times, agreement_);
}

reference::Reference References::resolving(const model::Scene& scene, const model::Cloth& cloth, double error) {
  return certified(scene, cloth, compared_times(scene), std::min(agreement_, error / 10));
}

reference::Reference References::certified(const model::Scene& scene, const model::Cloth& cloth,
                                           const std::vector<double>& times, double uncertainty) {
  if (model::phases(scene).size() > 1)
    throw reference::ReferenceError(fmt::format("{}: a scene of several phases or paths has none", scene.name), "PHASES", 0);
  if (scene.contact.response == model::ResponseKind::reflect && !scene.obstacles.empty())
    throw reference::ReferenceError(fmt::format("{}: contact.response = \"reflect\" has none", scene.name), "REFLECTS", 0);
  if (switches(scene)) {
    model::Scene inelastic = scene;
    inelastic.contact.response = model::ResponseKind::constraint;
    return certified(inelastic, model::compile(inelastic), times, uncertainty);
  }
  const double size = model::size(scene);
  reference::Reference reference = tight(scene, cloth, times, uncertainty * size);
  if (cloth.ode.has_contacts()) return reference;  // of first order: its uncertainty decides what is shown
  try {
    reference::certify(reference, agreement_, results::comparable_growth, size);
  } catch (const reference::NotCertified& error) {
    throw reference::NotCertified(fmt::format("{}: {}; allow more by --agreement", scene.name, error.what()));
  }
  return reference;
}

reference::Reference References::tight(const model::Scene& scene, const model::Cloth& cloth, const std::vector<double>& times,
                                       double uncertainty) {
  const auto left = [&] { return watch_.seconds - std::chrono::duration<double>(Clock::now() - begin_).count(); };
  reference::Reference best = at(rtol_, scene, cloth, times, left());
  for (;;) {
    const double worst = std::ranges::max(best.error), tightest = std::ranges::min(reference_tolerances);
    const bool comparable = !cloth.ode.has_contacts() && std::ranges::max(best.growth) <= results::comparable_growth;
    if (!comparable || !(worst > uncertainty) || best.tolerance <= tightest) return best;
    try {
      best = at(tightened(best.tolerance, uncertainty / worst), scene, cloth, times, left());
    } catch (const reference::ReferenceError&) {
      return best;  // its uncertainty says what it is worth
    }
  }
}

reference::Reference References::at(double tolerance, const model::Scene& scene, const model::Cloth& cloth,
                                    const std::vector<double>& times, double seconds) {
  reference::SolveOptions options{.rtol = tolerance, .size = model::size(scene)};
  std::string text = model::to_toml(model::without_trim(scene));
  for (const model::AddedForce& force : scene.sheet.added) text += fmt::format("forces.{} is of {}\n", force.name, force.code);
  const auto key = [&] { return reference::cache_key(text, 0, times, options); };
  const auto check = [&](const reference::Reference& found) {
    reference::require_plausible(found, cloth.ode, cloth.start, 0, times, options.size);
  };
  for (const double tighter : reference_tolerances | std::views::reverse) {
    options.rtol = tighter;
    if (tighter >= tolerance) break;
    if (auto known = cache_.find(key(), check)) return *std::move(known);
  }
  options.rtol = tolerance;
  return reference::cached(
      cache_, key(), [&] { return compute_reference(scene, cloth, times, options, watch_, seconds); }, check,
      check_interruption);
}

results::ErrorRecord distance(const results::RunRecord& run, const reference::Reference& reference, const model::Scene& scene,
                              const model::Cloth& cloth) {
  const double size = model::size(scene), end = reference.trajectory.times.back();
  const State &y = reference.trajectory.states.back(), &perturbed = reference.perturbed.states.back();
  const double energy = total_energy(cloth, end, y), scale = motion_scale(cloth, reference.trajectory, size).energy;
  return {.rms = reference::rms_distance(run.final_state.x, y.x) / size,
          .maximum = reference::maximum_distance(run.final_state.x, y.x) / size,
          .reference = fmt::format("{} + {}", reference.name, reference.witness),
          .reference_tolerance = reference.tolerance,
          .reference_error = base::largest(reference.error) / size,
          .growth = base::largest(reference.growth),
          .energy = std::abs(total_energy(cloth, end, run.final_state) - energy) / scale,
          .energy_spread = std::abs(total_energy(cloth, end, perturbed) - energy) / scale,
          .centre = reference::centre_distance(cloth.ode.mass, run.final_state.x, y.x) / size,
          .centre_spread = reference::centre_distance(cloth.ode.mass, perturbed.x, y.x) / size};
}

}  // namespace drape::bench
