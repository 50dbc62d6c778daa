#include "bench/score/true_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bench/runs/certified_reference.hpp"
#include "reference/sundials/coordinates.hpp"
#include "results/run_record.hpp"
#include "solver/base/largest.hpp"

namespace drape::bench {
namespace {

constexpr int parts = 200;  ///< into which the motion is divided for interpolation

/// Those asked for after the start and the ends of all parts, each once.
std::vector<double> all_times(std::span<const double> asked, double end) {
  std::vector<double> all(asked.begin(), asked.end());
  for (int k = 1; k <= parts; ++k) {
    const double t = k == parts ? end : end * k / parts;
    const auto next = std::ranges::lower_bound(asked, t - same_time * end);
    if (next == asked.end() || *next > t + same_time * end) all.push_back(t);
  }
  std::ranges::sort(all);
  std::erase_if(all, [](double t) { return t <= 0; });
  return all;
}

/// A trajectory that begins with the start.
reference::Trajectory from_start(const solver::State& start, reference::Trajectory rest) {
  rest.times.insert(rest.times.begin(), 0);
  rest.states.insert(rest.states.begin(), start);
  return rest;
}

/// With contact nothing else is asked of a reference.
void require_known(const model::Scene& scene, const reference::Reference& reference) {
  const double worst = base::largest(reference.error) / model::size(scene);
  if (!(worst <= results::comparable_error))
    throw reference::NotCertified(
        fmt::format("{}: {} and {} disagree by {:.2g} of the size, where positions can be compared up to {:g}", scene.name,
                    reference.name, reference.witness, worst, results::comparable_error));
}

}  // namespace

void require_describable(const model::Scene& scene) {
  if (!scene.panels.empty())
    throw std::invalid_argument(fmt::format("{}: expected a scene of one sheet, not of panels", scene.name));
  if (std::ranges::any_of(scene.pins, &model::PinRule::oblique))
    throw std::invalid_argument(fmt::format("{}: expected pins along axes ('directions'), not 'direction'", scene.name));
}

TrueMotion true_motion(const model::Scene& scene, std::span<const double> times, double agreement,
                       const ReferenceWatch& watch) {
  require_describable(scene);
  TrueMotion truth{scene, model::compile(scene), {}, 0, {}, {}, {}};
  References references(agreement, watch, 1e-10);  // nothing here tells the errors that will be judged by it
  reference::Reference reference = references(scene, truth.cloth, all_times(times, scene.end));
  require_known(scene, reference);
  const solver::State start = reference::prescribed_start(truth.cloth.ode, truth.cloth.start);
  truth.families = fmt::format("{} + {}", reference.name, reference.witness);
  truth.growth = base::largest(reference.growth);
  truth.motion = from_start(start, std::move(reference.trajectory));
  truth.witness = from_start(start, std::move(reference.witnessed));
  truth.uncertainty = std::move(reference.error);
  truth.uncertainty.insert(truth.uncertainty.begin(), 0);
  return truth;
}

std::vector<solver::State> states_at(const reference::Trajectory& motion, std::span<const double> times) {
  std::vector<solver::State> states;
  for (const double t : times) states.push_back(state_at(motion, t));
  return states;
}

double uncertainty_at(const TrueMotion& truth, double t) {
  const auto next = std::ranges::lower_bound(truth.motion.times, t - same_time * truth.motion.times.back());
  const auto k = std::min<std::ptrdiff_t>(next - truth.motion.times.begin(), std::ssize(truth.uncertainty) - 1);
  return truth.uncertainty[static_cast<std::size_t>(k)];
}

}  // namespace drape::bench
