#include "bench/score/measures.hpp"

#include <algorithm>

#include "reference/reference.hpp"

namespace drape::bench {
namespace {

using solver::State;

double depth(const TrueMotion& truth, double t, const solver::Vectors& x) {
  return std::max(0.0, -truth.cloth.contacts->distances(t, x).minCoeff());
}

/// Kinetic energies of frames [J].
std::vector<double> kinetic_energies(const model::Cloth& cloth, std::span<const double> times, std::vector<State> states,
                                     bool differenced) {
  if (differenced) difference(times, states);
  std::vector<double> all;
  for (const State& y : states) all.push_back(solver::kinetic_energy(cloth.ode, y.v));
  return all;
}

/// δ of a motion with kinetic energies K against one with R.
double rate(std::span<const double> times, const std::vector<double>& K, const std::vector<double>& R) {
  double lost = 0, all = 0;
  for (std::size_t k = 0; k < times.size(); ++k)
    lost += times[k] * R[k] * (R[k] - K[k]), all += times[k] * times[k] * R[k] * R[k];
  return lost / all;  // NaN if nothing moves
}

}  // namespace

std::vector<FrameScore> frame_scores(const ExternalMotion& external, const TrueMotion& truth) {
  const auto expected = observe(truth, external.times, external.differenced);
  std::vector<FrameScore> all;
  for (std::size_t k = 0; k < external.times.size(); ++k) {
    const double t = external.times[k];
    const State &y = external.states[k], truly = state_at(truth.motion, t);
    FrameScore frame{t,
                     reference::rms_distance(y.x, truly.x),
                     reference::maximum_distance(y.x, truly.x),
                     uncertainty_at(truth, t),
                     0,
                     observe(truth.scene, truth.cloth, t, y),
                     expected[k]};
    frame.centre = (frame.own.centre - frame.truth.value.centre).norm();
    if (truth.cloth.contacts) frame.depth = depth(truth, t, y.x), frame.true_depth = depth(truth, t, truly.x);
    all.push_back(frame);
  }
  return all;
}

Lag lag(const ExternalMotion& external, const TrueMotion& truth) {
  const double between = interpolation_error(truth.motion), known = std::ranges::max(truth.uncertainty);
  const double uncertainty = std::hypot(between, known);
  const Delay late = delay(external.times, external.states, truth.motion);
  return {{late.seconds, uncertainty / late.speed}, {late.left, uncertainty}};
}

Uncertain damping(const ExternalMotion& external, const TrueMotion& truth, const Lag& late) {
  const double tau = std::isnan(late.seconds.value) ? 0 : late.seconds.value, end = truth.motion.times.back() * (1 + 1e-9);
  std::vector<double> times = external.times, earlier;
  std::erase_if(times, [&](double t) { return t - tau > end; });
  for (const double t : times) earlier.push_back(t - tau);
  const auto energies = [&](std::vector<State> states) {
    states.resize(times.size());
    return kinetic_energies(truth.cloth, times, std::move(states), external.differenced);
  };
  const std::vector<double> R = energies(states_at(truth.motion, times));
  return {rate(times, energies(external.states), energies(states_at(truth.motion, earlier))),
          std::abs(rate(times, energies(states_at(truth.witness, times)), R))};
}

}  // namespace drape::bench
