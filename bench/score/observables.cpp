#include "bench/score/observables.hpp"

#include <algorithm>
#include <cmath>

#include "model/sheet/edges.hpp"
#include "reference/distance.hpp"
#include "solver/base/largest.hpp"

namespace drape::bench {
namespace {

double largest_strain(const model::Grid& grid, const solver::Vectors& x) {
  double largest = -1;
  for (const model::Edge& edge : model::edges(grid))
    largest = std::max(largest, (x.row(edge.i) - x.row(edge.j)).norm() / edge.length - 1);
  return largest;
}

/// The observables that are numbers.
constexpr double Observables::*numbers[] = {&Observables::kinetic, &Observables::potential, &Observables::total,
                                            &Observables::lowest, &Observables::stretch};

/// Velocities at all times by differences of second order.
std::vector<solver::Vectors> velocities_of(std::span<const double> times, const std::vector<solver::State>& states) {
  const std::size_t last = times.size() - 1;
  const auto slope = [&](std::size_t k) -> solver::Vectors {
    return (states[k + 1].x - states[k].x) / (times[k + 1] - times[k]);
  };
  std::vector<solver::Vectors> all;
  for (std::size_t k = 0; k <= last; ++k) {
    if (last == 1) {
      all.push_back(slope(0));
      continue;
    }
    const std::size_t middle = std::clamp<std::size_t>(k, 1, last - 1);  // the parabola through it and its neighbours
    const solver::Vectors before = slope(middle - 1);
    const solver::Vectors curvature = (slope(middle) - before) / (times[middle + 1] - times[middle - 1]);
    all.emplace_back(before + curvature * (2 * times[k] - times[middle - 1] - times[middle]));
  }
  return all;
}

}  // namespace

Observables observe(const model::Scene& scene, const model::Cloth& cloth, double t, const solver::State& y) {
  Observables o;
  o.kinetic = solver::kinetic_energy(cloth.ode, y.v);
  o.potential = solver::stored_energy(cloth.ode, t, y);
  o.total = o.kinetic + o.potential;
  o.centre = reference::centre_of_mass(cloth.ode.mass, y.x);
  o.lowest = y.x.col(2).minCoeff();
  o.stretch = largest_strain(scene.sheet.grid, y.x);
  return o;
}

std::vector<UncertainObservables> observe(const TrueMotion& truth, std::span<const double> times, bool differenced) {
  std::vector<solver::State> motion = states_at(truth.motion, times), witness = states_at(truth.witness, times);
  if (differenced)
    for (auto* states : {&motion, &witness}) difference(times, *states);
  std::vector<UncertainObservables> all;
  for (std::size_t k = 0; k < times.size(); ++k) {
    UncertainObservables now = all.empty() ? UncertainObservables() : all.back();
    now.value = observe(truth.scene, truth.cloth, times[k], motion[k]);
    const Observables other = observe(truth.scene, truth.cloth, times[k], witness[k]);
    for (const auto number : numbers)
      now.uncertainty.*number = base::larger(now.uncertainty.*number, std::abs(now.value.*number - other.*number));
    now.centre_distance = base::larger(now.centre_distance, (now.value.centre - other.centre).norm());
    all.push_back(now);
  }
  return all;
}

void difference(std::span<const double> times, std::vector<solver::State>& states) {
  std::vector<solver::Vectors> velocities = velocities_of(times, states);
  for (std::size_t k = 0; k < states.size(); ++k) states[k].v = std::move(velocities[k]);
}

}  // namespace drape::bench
