#include "reference/growth.hpp"

#include <cmath>
#include <memory>
#include <random>
#include <utility>

#include "reference/distance.hpp"
#include "reference/linear_motion.hpp"
#include "reference/sundials/peer_solvers.hpp"
#include "solver/base/largest.hpp"

namespace drape::reference {
namespace {

using solver::SplitOde;
using solver::State;
using solver::Vectors;

constexpr double perturbation = 1e-7;  ///< relative to the size of the scene
constexpr double base_rtol = 1e-5;     ///< rtol of the trajectory about which is linearised
constexpr int fewest_steps = 30;       ///< of the linearised motion: enough to resolve growth, not oscillations
constexpr int most_steps = 240;
constexpr double alike = 1.5;       ///< factor between what steps and half of them predict, if they are short enough
constexpr double worthwhile = 1.1;  ///< factor by which a round of the power method has to gain

State scaled(const State& y, double factor) { return {factor * y.x, factor * y.v}; }
State sum(const State& a, const State& b) { return {a.x + b.x, a.v + b.v}; }

/// Scales it to size 1 unless it is 0.
State unit(const State& y, double duration) {
  const double size = perturbation_size(y, duration);
  return size > 0 ? scaled(y, 1 / size) : y;
}

/// Normal noise in the free coordinates, its velocities those that cross its positions in the duration; of size 1.
State noise(const SplitOde& ode, double duration, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&](double scale) -> Vectors {
    Vectors sample = Vectors::NullaryExpr(ode.particles(), 3, [&] { return scale * normal(random); });
    solver::filter(ode.pins, sample);
    return sample;
  };
  Vectors x = draw(1);
  return unit({std::move(x), draw(1 / duration)}, duration);
}

std::unique_ptr<LinearMotion> linearised(const SplitOde& ode, const State& y0, double t0, int steps, double h, double size) {
  std::vector<double> middles;
  for (int k = 0; k < steps; ++k) middles.push_back(t0 + (k + 0.5) * h);
  const SolveOptions options{.rtol = base_rtol, .size = size};
  return std::make_unique<LinearMotion>(ode, solve_by_either(peer_solver("cvode-bdf"), ode, y0, t0, middles, options), h);
}

/// The times [s] at which growth counts, and the steps from t0 on whose ends are nearest to them.
struct Counted {
  double t0;
  std::span<const double> times;
  double h;
};

/// The positions that count, with those at other steps' ends set to 0.
std::vector<Vectors> kept(std::vector<Vectors> positions, const Counted& counted) {
  std::vector<bool> counts(positions.size(), false);
  for (const double t : counted.times)
    if (const long end = std::lround((t - counted.t0) / counted.h); end > 0) counts[static_cast<std::size_t>(end - 1)] = true;
  for (std::size_t k = 0; k < positions.size(); ++k)
    if (!counts[k]) positions[k].setZero();
  return positions;
}

double largest(const std::vector<Vectors>& positions) {
  double result = 0;
  for (const Vectors& x : positions) result = base::larger(result, rms(x));
  return result;
}

/// At most this number of rounds of the power method, as long as they gain more than a tenth. Returns the growth as it was seen
/// last: of the direction, or, where the rounds came to their end, of the one before.
double improve(State& direction, LinearMotion& motion, const Counted& counted, int rounds) {
  const double duration = counted.times.back() - counted.t0;
  double growth = 0;
  for (int round = 1; round <= rounds; ++round) {
    std::vector<Vectors> positions = kept(motion.forward(direction), counted);
    const double before = std::exchange(growth, largest(positions));
    if (growth <= worthwhile * before) break;
    if (round == rounds || growth <= 2 * before)
      for (Vectors& x : positions)
        if (rms(x) < growth) x.setZero();
    State next = motion.transposed(positions);
    next.v /= duration * duration;
    direction = unit(next, duration);
  }
  return growth;
}

}  // namespace

double perturbation_size(const State& change, double duration) { return std::hypot(rms(change.x), duration * rms(change.v)); }

State fastest_growing(const SplitOde& ode, const State& y0, double t0, std::span<const double> times, double size, int rounds,
                      unsigned seed) {
  const double duration = times.back() - t0;
  State direction = noise(ode, duration, seed);
  if (rounds == 0) return direction;
  try {
    auto motion = linearised(ode, y0, t0, fewest_steps, duration / fewest_steps, size);
    for (int steps = fewest_steps; steps <= most_steps; steps *= 2) {
      const double h = duration / steps;
      auto finer = linearised(ode, y0, t0, 2 * steps, h / 2, size);
      const double growth = improve(direction, *motion, {t0, times, h}, rounds);
      const double resolved = largest(kept(finer->forward(direction), {t0, times, h / 2}));
      if (growth <= alike * resolved && resolved <= alike * growth) break;
      motion = std::move(finer);
    }
  } catch (const LinearMotion::NotSolved&) {
    // the intermediate result is measured as well
  }
  return direction;
}

Growth growth_along(const State& direction, const State& y0, const Trajectory& unperturbed, double size,
                    const SolveFrom& solve) {
  const double distance = perturbation * size;
  Growth growth{{}, solve(sum(y0, scaled(direction, distance)))};
  for (std::size_t k = 0; k < unperturbed.states.size(); ++k)
    growth.factors.push_back(rms(growth.perturbed.states[k].x - unperturbed.states[k].x) / distance);
  return growth;
}

double largest_growth(const SplitOde& ode, const State& y0, double t0, const Trajectory& unperturbed, double size,
                      const SolveFrom& solve) {
  const double distance = perturbation * size, duration = unperturbed.times.back() - t0;
  const Vectors& end = unperturbed.states.back().x;
  Vectors free = Vectors::Ones(ode.particles(), 3);
  solver::filter(ode.pins, free);
  Eigen::MatrixXd propagator = Eigen::MatrixXd::Zero(end.size(), 2 * end.size());
  State start = y0;
  const auto differentiate = [&](Eigen::Index column, double& number, double by) {
    number += by;
    propagator.col(column) = ((solve(start).states.back().x - end) / distance).reshaped<Eigen::RowMajor>();
    start = y0;
  };
  for (Eigen::Index k = 0; k < end.size(); ++k) {
    if (free.data()[k] == 0) continue;
    differentiate(k, start.x.data()[k], distance);
    differentiate(end.size() + k, start.v.data()[k], distance / duration);
  }
  const Eigen::MatrixXd normal = propagator * propagator.transpose();
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(normal, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff());
}

Growth measure_growth(const SplitOde& ode, const State& y0, double t0, const Trajectory& unperturbed, double size,
                      const SolveFrom& solve) {
  if (!ode.has_contacts()) {
    const State direction = fastest_growing(ode, y0, t0, unperturbed.times, size);
    return growth_along(direction, y0, unperturbed, size, solve);
  }
  const double duration = unperturbed.times.back() - t0;
  const Growth first = growth_along(noise(ode, duration, 1), y0, unperturbed, size, solve);
  const State &end = first.perturbed.states.back(), &truth = unperturbed.states.back();
  Growth second = growth_along(unit({end.x - truth.x, end.v - truth.v}, duration), y0, unperturbed, size, solve);
  for (std::size_t k = 0; k < first.factors.size(); ++k) second.factors[k] = base::larger(second.factors[k], first.factors[k]);
  return second;
}

}  // namespace drape::reference
