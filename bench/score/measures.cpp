#include "bench/score/measures.hpp"

#include <algorithm>

#include "reference/reference.hpp"

namespace drape::bench {
namespace {

using solver::State;

double depth(const TrueMotion& truth, double t, const solver::Vectors& x) {
  return std::max(0.0, -truth.cloth.contacts->distances(t, x).minCoeff());
}

/// Squares of distances from a reference that is late by τ, over the frames that it has.
struct Misfit {
  double square = 0;  ///< mean of |x(t) − x_ref(t − τ)|² over frames and particles [m²]
  double slope = 0;   ///< of <v_ref, x − x_ref> [m²/s]
  double speed = 0;   ///< of |v_ref|² [m²/s²]
};

Misfit misfit(const ExternalMotion& external, const reference::Trajectory& motion, double tau) {
  Misfit sum;
  int count = 0;
  for (std::size_t k = 0; k < external.times.size(); ++k) {
    const double t = external.times[k] - tau;
    if (t > motion.times.back() * (1 + 1e-9)) break;
    const State y = state_at(motion, t);
    const solver::Vectors r = external.states[k].x - y.x;
    sum.square += r.squaredNorm(), sum.slope += y.v.cwiseProduct(r).sum(), sum.speed += y.v.squaredNorm();
    ++count;
  }
  const double n = count * static_cast<double>(external.states.front().x.rows());
  return {sum.square / n, sum.slope / n, sum.speed / n};
}

/// The best delay of a scan over a quarter of the motion either way, and how far apart they were [s].
std::pair<double, double> scan(const ExternalMotion& external, const reference::Trajectory& motion) {
  constexpr int each_way = 50;
  const double step = longest_lag * external.times.back() / each_way;
  double best = 0, least = misfit(external, motion, 0).square;
  for (int k = 1; k <= each_way; ++k)
    for (const double tau : {k * step, -k * step})
      if (const double square = misfit(external, motion, tau).square; square < least) best = tau, least = square;
  return {best, step};
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
  constexpr int steps = 20;
  const double between = interpolation_error(truth.motion), known = std::ranges::max(truth.uncertainty);
  const double uncertainty = std::hypot(between, known);
  const double longest = longest_lag * external.times.back();
  auto [tau, width] = scan(external, truth.motion);
  Misfit best = misfit(external, truth.motion, tau);
  if (!(best.speed > 0)) return {{}, {std::sqrt(best.square), uncertainty}};
  for (int k = 0; k < steps; ++k) {  // r(τ) = x(t) − x_ref(t − τ), dr/dτ = v_ref
    const double next = std::clamp(tau - std::clamp(best.slope / best.speed, -width, width), -longest, longest);
    const Misfit there = misfit(external, truth.motion, next);
    if (!(there.square < best.square)) break;
    tau = next, best = there;
  }
  return {{tau, uncertainty / std::sqrt(best.speed)}, {std::sqrt(best.square), uncertainty}};
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
