#include "reference/growth.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "reference/cvode.hpp"
#include "reference/linear_motion.hpp"
#include "solver/largest.hpp"

namespace drape::reference {
namespace {

using solver::SplitOde;
using solver::State;
using solver::Vectors;

constexpr double perturbation = 1e-7;  ///< of the size of the scene
constexpr double base_rtol = 1e-5;     ///< of the trajectory about which is linearised
constexpr int steps = 30;              ///< of the linearised motion: they resolve what grows, not what oscillates

double rms(const Vectors& field) { return field.norm() / std::sqrt(static_cast<double>(field.rows())); }

State scaled(const State& y, double factor) { return {factor * y.x, factor * y.v}; }
State sum(const State& a, const State& b) { return {a.x + b.x, a.v + b.v}; }

State unit(const State& y, double duration) { return scaled(y, 1 / perturbation_size(y, duration)); }

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

LinearMotion linearised(const SplitOde& ode, const State& y0, double t0, double h, double size) {
  std::vector<double> middles;
  for (int k = 0; k < steps; ++k) middles.push_back(t0 + (k + 0.5) * h);
  return {ode, cvode(ode, y0, t0, middles, {.rtol = base_rtol, .size = size}), h};
}

/// Leaves of the positions at the ends of the steps those at the ends nearest to the times; or only the largest of these.
void keep(std::vector<Vectors>& positions, double t0, std::span<const double> times, double h, bool only_largest) {
  std::vector<bool> kept(positions.size(), false);
  for (const double t : times)
    if (const long end = std::lround((t - t0) / h); end > 0) kept[static_cast<std::size_t>(end - 1)] = true;
  double largest = 0;
  for (std::size_t k = 0; k < positions.size(); ++k)
    if (kept[k]) largest = std::max(largest, positions[k].norm());
  for (std::size_t k = 0; k < positions.size(); ++k)
    if (!kept[k] || (only_largest && positions[k].norm() < largest)) positions[k].setZero();
}

}  // namespace

double perturbation_size(const State& change, double duration) { return std::hypot(rms(change.x), duration * rms(change.v)); }

State fastest_growing(const SplitOde& ode, const State& y0, double t0, std::span<const double> times, double size, int rounds,
                      unsigned seed) {
  const double duration = times.back() - t0, h = duration / steps;
  LinearMotion motion = linearised(ode, y0, t0, h, size);
  State direction = noise(ode, duration, seed);
  for (int round = 1; round <= rounds; ++round) try {
      std::vector<Vectors> positions = motion.forward(direction);
      keep(positions, t0, times, h, round == rounds);
      State next = motion.transposed(positions);
      next.v /= duration * duration;
      direction = unit(next, duration);
    } catch (const LinearMotion::NotSolved&) {
      break;  // what was found so far is measured, too
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
  if (!ode.contacts) {
    const State direction = fastest_growing(ode, y0, t0, unperturbed.times, size);
    return growth_along(direction, y0, unperturbed, size, solve);
  }
  const double duration = unperturbed.times.back() - t0;
  const Growth first = growth_along(noise(ode, duration, 1), y0, unperturbed, size, solve);
  const State &end = first.perturbed.states.back(), &truth = unperturbed.states.back();
  Growth second = growth_along(unit({end.x - truth.x, end.v - truth.v}, duration), y0, unperturbed, size, solve);
  for (std::size_t k = 0; k < first.factors.size(); ++k)
    second.factors[k] = solver::larger(second.factors[k], first.factors[k]);
  return second;
}

}  // namespace drape::reference
