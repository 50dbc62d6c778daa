#include "reference/reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "reference/families.hpp"

namespace drape::reference {
namespace {

using solver::SplitOde;
using solver::State;

constexpr double looser = 100;         ///< times the tolerance
constexpr double perturbation = 1e-7;  ///< of the size of the scene

std::vector<double> distances(const Trajectory& a, const Trajectory& b) {
  std::vector<double> result;
  for (std::size_t k = 0; k < a.states.size(); ++k) result.push_back(rms_distance(a.states[k].x, b.states[k].x));
  return result;
}

/// Normal noise in the free coordinates, its velocities those that cross its positions in the duration.
State noise(const SplitOde& ode, double duration) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto draw = [&](double scale) -> solver::Vectors {
    solver::Vectors sample = solver::Vectors::NullaryExpr(ode.particles(), 3, [&] { return scale * normal(random); });
    solver::filter(ode.pins, sample);
    return sample;
  };
  solver::Vectors x = draw(1);
  return {std::move(x), draw(1 / duration)};
}

State difference(const State& a, const State& b) { return {a.x - b.x, a.v - b.v}; }

/// The state moved along a direction so that its positions move by `distance` [m, rms].
State moved(const State& y, const State& direction, double distance) {
  const double scale = distance / rms_distance(direction.x, solver::Vectors::Zero(y.x.rows(), 3));
  return {y.x + scale * direction.x, y.v + scale * direction.v};
}

}  // namespace

double rms_distance(const solver::Vectors& a, const solver::Vectors& b) {
  return std::sqrt((a - b).squaredNorm() / static_cast<double>(a.rows()));
}

Reference reference(const SplitOde& ode, const State& y0, double t0, std::span<const double> times,
                    const SolveOptions& options) {
  const Family &family_a = family("cvode-bdf"), &family_b = family("arkode-esdirk");
  SolveOptions loose = options;
  loose.rtol *= looser;
  Reference result;
  result.name = family_a.name;
  result.witness = family_b.name;
  result.tolerance = options.rtol;
  result.trajectory = family_a.solve(ode, y0, t0, times, options);
  const Trajectory b = family_b.solve(ode, y0, t0, times, options);
  const Trajectory loose_a = family_a.solve(ode, y0, t0, times, loose), loose_b = family_b.solve(ode, y0, t0, times, loose);
  result.error = distances(result.trajectory, b);
  const auto effect_a = distances(result.trajectory, loose_a), effect_b = distances(b, loose_b);
  std::ranges::transform(effect_a, effect_b, std::back_inserter(result.tolerance_effect),
                         [](double p, double q) { return std::max(p, q); });

  const double distance = perturbation * options.size;
  State direction = noise(ode, times.back() - t0);
  result.growth.assign(times.size(), 0);
  for (int round = 0; round < 2; ++round) {
    result.perturbed = family_a.solve(ode, moved(y0, direction, distance), t0, times, options);
    const std::vector<double> grown = distances(result.perturbed, result.trajectory);
    for (std::size_t k = 0; k < times.size(); ++k) result.growth[k] = std::max(result.growth[k], grown[k] / distance);
    direction = difference(result.perturbed.states.back(), result.trajectory.states.back());
  }
  return result;
}

void certify(const Reference& reference, double agreement, double largest_growth, double size) {
  for (std::size_t k = 0; k < reference.error.size(); ++k)
    if (!(reference.growth[k] > largest_growth) && !(reference.error[k] <= agreement * size))
      throw NotCertified(fmt::format(
          "{} and {} disagree by {:.2g} of the size at t = {:g} s, where at most {:g} is allowed (rtol = {})", reference.name,
          reference.witness, reference.error[k] / size, reference.trajectory.times[k], agreement, reference.tolerance));
}

}  // namespace drape::reference
