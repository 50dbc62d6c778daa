#include "bench/runs/lag.hpp"

#include <algorithm>
#include <cmath>

#include "solver/dense_output.hpp"

namespace drape::bench {
namespace {

using solver::State;

/// Squares of distances from a motion that is late by τ, over the states that it has.
struct Misfit {
  double square = 0;  ///< mean of |x(t) − x_ref(t − τ)|² over states and particles [m²]
  double slope = 0;   ///< of <v_ref, x − x_ref> [m²/s]
  double speed = 0;   ///< of |v_ref|² [m²/s²]
};

/// States at some times, and the motion that they are compared with.
struct Pair {
  std::span<const double> times;
  std::span<const State> states;
  const reference::Trajectory& motion;
};

Misfit misfit(const Pair& pair, double tau) {
  Misfit sum;
  int count = 0;
  for (std::size_t k = 0; k < pair.times.size(); ++k) {
    const double t = pair.times[k] - tau;
    if (t > pair.motion.times.back() * (1 + same_time)) break;
    const State y = state_at(pair.motion, t);
    const solver::Vectors r = pair.states[k].x - y.x;
    sum.square += r.squaredNorm(), sum.slope += y.v.cwiseProduct(r).sum(), sum.speed += y.v.squaredNorm();
    ++count;
  }
  const double n = count * static_cast<double>(pair.states.front().x.rows());
  return {sum.square / n, sum.slope / n, sum.speed / n};
}

/// The best delay of a scan over a quarter of the motion either way, and how far apart they were [s].
struct Scan {
  double best, step;
};

Scan scan(const Pair& pair) {
  constexpr int each_way = 50;
  Scan found{0, longest_lag * pair.times.back() / each_way};
  double least = misfit(pair, 0).square;
  for (int k = 1; k <= each_way; ++k)
    for (const double tau : {k * found.step, -k * found.step})
      if (const double square = misfit(pair, tau).square; square < least) found.best = tau, least = square;
  return found;
}

}  // namespace

State state_at(const reference::Trajectory& motion, double t) {
  const std::vector<double>& times = motion.times;
  if (t < 0) return {motion.states.front().x, solver::Vectors::Zero(motion.states.front().x.rows(), 3)};
  const double close = same_time * times.back();
  const auto k = static_cast<std::size_t>(std::ranges::lower_bound(times, t - close) - times.begin());
  if (k == times.size()) return motion.states.back();
  if (times[k] <= t + close) return motion.states[k];
  return solver::state_within(t, times[k - 1], motion.states[k - 1], times[k], motion.states[k]);
}

double interpolation_error(const reference::Trajectory& motion) {
  constexpr double gain = 16;  // 2⁴: of steps half as long
  double sum = 0;
  int count = 0;
  for (std::size_t k = 1; k + 1 < motion.times.size(); k += 2, ++count) {
    const State between = solver::state_within(motion.times[k], motion.times[k - 1], motion.states[k - 1], motion.times[k + 1],
                                               motion.states[k + 1]);
    sum += (between.x - motion.states[k].x).squaredNorm() / static_cast<double>(between.x.rows());
  }
  return count == 0 ? 0 : std::sqrt(sum / count) / gain;
}

Delay delay(std::span<const double> times, std::span<const State> states, const reference::Trajectory& motion) {
  constexpr int steps = 20;
  const Pair pair{times, states, motion};
  const double longest = longest_lag * times.back();
  auto [tau, width] = scan(pair);
  Misfit best = misfit(pair, tau);
  if (!(best.speed > 0)) return {.left = std::sqrt(best.square)};
  for (int k = 0; k < steps; ++k) {  // r(τ) = x(t) − x_ref(t − τ), dr/dτ = v_ref
    const double next = std::clamp(tau - std::clamp(best.slope / best.speed, -width, width), -longest, longest);
    const Misfit there = misfit(pair, next);
    if (!(there.square < best.square)) break;
    tau = next, best = there;
  }
  return {tau, std::sqrt(best.square), std::sqrt(best.speed)};
}

}  // namespace drape::bench
