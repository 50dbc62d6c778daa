#include "model/energy_guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drape::model {
namespace {

constexpr double noise = 1e-9;  ///< strain that round-off and unfinished solves may leave in a sheet at rest

/// Largest velocity [m/s] of what pins and obstacles prescribe.
double prescribed_velocity(const Scene& scene) {
  double fastest = 0;
  for (const PinRule& pin : scene.pins) fastest = std::max(fastest, pin.velocity.norm());
  for (const ObstacleRule& obstacle : scene.obstacles)
    for (std::size_t k = 1; k < obstacle.motion.size(); ++k) {
      const KeyFrame &from = obstacle.motion[k - 1], &to = obstacle.motion[k];
      const double angle = (to.rotation - from.rotation).norm() * std::numbers::pi / 180;
      const double way = (to.position - from.position).norm() + 2 * size(scene) * angle;
      fastest = std::max(fastest, way / (to.t - from.t));
    }
  return fastest;
}

/// The largest force per area that wind can be [N/m²].
double largest_load(const Wind& wind) {
  if (!wind.blows()) return 0;
  const double swing = wind.frequency == 0 ? 0 : 1;
  return (std::abs(wind.constant) + swing) * wind.load.norm() * std::max(std::abs(wind.drag), std::abs(wind.lift));
}

/// Ends a run from within its observer.
struct Exceeded {
  double t, last_good_time, energy;
};

std::string describe(const Exceeded& e, const EnergyGuard& guard) {
  return fmt::format("at t = {:.4g} s its energy was {:.3g} J where the scene can have {:.3g} J", e.t, e.energy,
                     guard.limit(e.t));
}

}  // namespace

EnergyGuard::EnergyGuard(const Scene& scene, const Cloth& cloth) {
  const solver::SplitOde& ode = cloth.ode;
  const Sheet& sheet = scene.sheet;
  const Eigen::VectorXd areas = sheet.grid.cell_areas();
  weight_ = sheet.material.density * areas * sheet.gravity.transpose();

  solver::Vectors v = cloth.start.v;
  solver::prescribe(ode.pins, v);
  const double start = energy(solver::kinetic_energy(ode, v), ode.potential_energy(0, cloth.start.x), cloth.start.x);

  solver::Vectors force = weight_;
  solver::filter(ode.pins, force);
  const Eigen::VectorXd root_mass = ode.mass.cwiseSqrt();
  const Eigen::VectorXd forces = force.rowwise().norm() + largest_load(sheet.wind) * areas;
  root_growth_ = forces.cwiseQuotient(root_mass).norm();

  const double w = prescribed_velocity(scene), l = std::min(sheet.grid.spacing_u(), sheet.grid.spacing_v());
  const double k = std::max(sheet.material.tension.weft, sheet.material.tension.warp);
  root_start_ = std::sqrt(2 * std::max(0.0, start) + k * noise * noise * areas.sum());
  root_moved_ = 2 * w * root_mass.norm();
  stretch_ = 0.5 * k * w * w / (l * l) * areas.sum();
}

double EnergyGuard::limit(double t) const {
  const double root = root_start_ + root_growth_ * t + root_moved_;
  return 0.5 * root * root + stretch_ * t * t;
}

double EnergyGuard::energy(double kinetic, double potential, const solver::Vectors& x) const {
  return kinetic + potential + weight_.cwiseProduct(x).sum();
}

solver::RunResult integrate(solver::Integrator& integrator, const solver::SplitOde& ode, const EnergyGuard& guard, double t_end,
                            double h, const solver::Observer& observer) {
  double good = integrator.time();
  solver::RunResult run;
  try {
    return solver::integrate(integrator, t_end, h, [&](const solver::StepReport& step) {
      const double kinetic = solver::kinetic_energy(ode, step.y.v), potential = ode.potential_energy(step.t, step.y.x);
      const double energy = guard.energy(kinetic, potential, step.y.x);
      if (guard.exceeded(step.t, energy)) throw Exceeded{step.t, good, energy};
      good = step.t;
      ++run.steps;
      if (observer) observer(step);
    });
  } catch (const Exceeded& e) {
    run.outcome = solver::Outcome::unstable;
    run.message = describe(e, guard);
    run.last_good_time = e.last_good_time;
    return run;
  }
}

}  // namespace drape::model
