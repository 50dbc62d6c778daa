#include "bench/foreign/measures.hpp"

#include <algorithm>

#include "reference/reference.hpp"

namespace drape::bench {
namespace {

using solver::State;

double depth(const TrueMotion& truth, double t, const solver::Vectors& x) {
  return std::max(0.0, -truth.cloth.contacts->distances(t, x).minCoeff());
}

double centre_distance(const Observables& a, const Observables& b) { return (a.centre - b.centre).norm(); }

/// Squares of distances from a reference that is late by τ, over the frames that it has.
struct Misfit {
  double square = 0;  ///< mean of |x(t) − x_ref(t − τ)|² over frames and particles [m²]
  double slope = 0;   ///< of <v_ref, x − x_ref> [m²/s]
  double speed = 0;   ///< of |v_ref|² [m²/s²]
};

Misfit misfit(const ForeignMotion& foreign, const reference::Trajectory& motion, double tau) {
  Misfit sum;
  int count = 0;
  for (std::size_t k = 0; k < foreign.times.size(); ++k) {
    const double t = foreign.times[k] - tau;
    if (t > motion.times.back() * (1 + 1e-9)) break;
    const State y = state_at(motion, t);
    const solver::Vectors r = foreign.states[k].x - y.x;
    sum.square += r.squaredNorm(), sum.slope += y.v.cwiseProduct(r).sum(), sum.speed += y.v.squaredNorm();
    ++count;
  }
  const double n = count * static_cast<double>(foreign.states.front().x.rows());
  return {sum.square / n, sum.slope / n, sum.speed / n};
}

/// The best delay of a scan over a quarter of the motion either way, and how far apart they were [s].
std::pair<double, double> scan(const ForeignMotion& foreign, const reference::Trajectory& motion) {
  constexpr int each_way = 50;
  const double step = foreign.times.back() / (4 * each_way);
  double best = 0, least = misfit(foreign, motion, 0).square;
  for (int k = 1; k <= each_way; ++k)
    for (const double tau : {k * step, -k * step})
      if (const double square = misfit(foreign, motion, tau).square; square < least) best = tau, least = square;
  return {best, step};
}

/// ∫ 2 E_kin dt of the reference from the start to each of the times [J s], by the trapezoidal rule.
std::vector<double> actions(const TrueMotion& truth, const std::vector<double>& times) {
  const reference::Trajectory& motion = truth.motion;
  std::vector<double> all;
  double action = 0, before = 0, last = solver::kinetic_energy(truth.cloth.ode, motion.states[0].v);
  std::size_t k = 1;
  for (const double t : times) {
    for (; k < motion.times.size() && motion.times[k] <= t * (1 + 1e-9); ++k) {
      const double kinetic = solver::kinetic_energy(truth.cloth.ode, motion.states[k].v);
      action += (kinetic + last) * (motion.times[k] - before);
      before = motion.times[k], last = kinetic;
    }
    all.push_back(action);
  }
  return all;
}

/// Slope of the line through the origin.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  double xy = 0, xx = 0;
  for (std::size_t k = 0; k < x.size(); ++k) xy += x[k] * y[k], xx += x[k] * x[k];
  return xy / xx;  // NaN if nothing moves
}

}  // namespace

std::vector<FrameScore> frame_scores(const ForeignMotion& foreign, const TrueMotion& truth) {
  const auto expected = observe(truth, foreign.times, foreign.differenced);
  std::vector<FrameScore> all;
  for (std::size_t k = 0; k < foreign.times.size(); ++k) {
    const double t = foreign.times[k];
    const State &y = foreign.states[k], truly = state_at(truth.motion, t);
    FrameScore frame{t,
                     reference::rms_distance(y.x, truly.x),
                     (y.x - truly.x).rowwise().norm().maxCoeff(),
                     uncertainty_at(truth, t),
                     0,
                     observe(truth.scene, truth.cloth, t, y),
                     expected[k]};
    frame.centre = centre_distance(frame.own, frame.truth.value);
    if (truth.cloth.contacts) frame.depth = depth(truth, t, y.x), frame.true_depth = depth(truth, t, truly.x);
    all.push_back(frame);
  }
  return all;
}

Lag lag(const ForeignMotion& foreign, const TrueMotion& truth) {
  constexpr int steps = 20;
  const double between = interpolation_error(truth.motion), known = std::ranges::max(truth.uncertainty);
  const double uncertainty = std::hypot(between, known);
  auto [tau, width] = scan(foreign, truth.motion);
  Misfit best = misfit(foreign, truth.motion, tau);
  if (!(best.speed > 0)) return {{}, {std::sqrt(best.square), uncertainty}};
  for (int k = 0; k < steps; ++k) {  // r(τ) = x(t) − x_ref(t − τ), dr/dτ = v_ref
    const double next = tau - std::clamp(best.slope / best.speed, -width, width);
    const Misfit there = misfit(foreign, truth.motion, next);
    if (!(there.square < best.square)) break;
    tau = next, best = there;
  }
  return {{tau, uncertainty / std::sqrt(best.speed)}, {std::sqrt(best.square), uncertainty}};
}

Uncertain damping(const std::vector<FrameScore>& frames, const ForeignMotion& foreign, const TrueMotion& truth) {
  const std::vector<double> action = actions(truth, foreign.times);
  std::vector<State> witness = states_at(truth.witness, foreign.times);
  if (foreign.differenced) difference(foreign.times, witness);
  std::vector<double> lost, lost_by_witness;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const double energy = frames[k].truth.value.total;
    lost.push_back(energy - frames[k].own.total);
    lost_by_witness.push_back(energy - observe(truth.scene, truth.cloth, foreign.times[k], witness[k]).total);
  }
  return {slope(action, lost), std::abs(slope(action, lost_by_witness))};
}

}  // namespace drape::bench
