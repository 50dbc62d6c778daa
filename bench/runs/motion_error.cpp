#include "bench/runs/motion_error.hpp"

#include <cmath>

#include "solver/base/largest.hpp"

namespace drape::bench {
namespace {

using reference::rms_distance;
using solver::State;
using solver::Vectors;

constexpr double still = 1e-3;  ///< of its size: a scene that moves by less in a run is at rest

Eigen::RowVector3d momentum(const model::Cloth& cloth, const State& y) { return cloth.ode.mass.transpose() * y.v; }

Eigen::Vector3d angular_momentum(const model::Cloth& cloth, const Eigen::RowVector3d& centre, const State& y) {
  return reference::angular_momentum(cloth.ode.mass, centre, y);
}

}  // namespace

double total_energy(const model::Cloth& cloth, double t, const State& y) {
  return solver::kinetic_energy(cloth.ode, y.v) + solver::stored_energy(cloth.ode, t, y);
}

MotionScale motion_scale(const model::Cloth& cloth, const reference::Trajectory& trajectory, double size) {
  const double mass = cloth.ode.mass.sum(), slow = still * size / trajectory.times.back();
  const double potential = cloth.ode.potential_energy(0, cloth.start.x);
  MotionScale scale{still * size, slow, mass / 2 * slow * slow};
  for (std::size_t k = 0; k < trajectory.times.size(); ++k) {
    const State& y = trajectory.states[k];
    const double change = cloth.ode.potential_energy(trajectory.times[k], y.x) - potential;
    scale.distance = base::larger(scale.distance, rms_distance(y.x, cloth.start.x));
    scale.velocity = base::larger(scale.velocity, reference::rms(y.v));
    scale.energy = base::larger(scale.energy, solver::kinetic_energy(cloth.ode, y.v) + std::abs(change));
  }
  return scale;
}

results::MotionErrorRecord motion_error(const std::vector<State>& states, const reference::Reference& reference,
                                        const model::Scene& scene, const model::Cloth& cloth) {
  const reference::Trajectory& truth = reference.trajectory;
  const double size = model::size(scene), mass = cloth.ode.mass.sum();
  const MotionScale scale = motion_scale(cloth, truth, size);
  const Eigen::RowVector3d centre = reference::centre_of_mass(cloth.ode.mass, cloth.start.x);
  results::MotionErrorRecord largest{.amplitude = scale.distance / size};
  const auto note = [](double& number, double error) { number = base::larger(number, error); };
  for (std::size_t k = 0; k < truth.times.size(); ++k) {
    const State &y = states.at(k), &exact = truth.states[k];
    const double t = truth.times[k];
    note(largest.position, rms_distance(y.x, exact.x) / size);
    note(largest.velocity, rms_distance(y.v, exact.v) / scale.velocity);
    note(largest.reference_velocity, rms_distance(reference.witnessed.states[k].v, exact.v) / scale.velocity);
    note(largest.energy, std::abs(total_energy(cloth, t, y) - total_energy(cloth, t, exact)) / scale.energy);
    note(largest.momentum, (momentum(cloth, y) - momentum(cloth, exact)).norm() / (mass * scale.velocity));
    note(largest.angular_momentum,
         (angular_momentum(cloth, centre, y) - angular_momentum(cloth, centre, exact)).norm() / (mass * scale.velocity * size));
  }
  largest.relative = largest.position / largest.amplitude;
  return largest;
}

}  // namespace drape::bench
