#include "bench/runs/contact_observer.hpp"

#include <algorithm>
#include <limits>

#include "solver/base/largest.hpp"

namespace drape::bench {

void ContactObserver::begin(const model::Scene& scene, const model::Cloth& cloth, const solver::State&) {
  scene_ = &scene;
  cloth_ = &cloth;
  if (!cloth.contacts) return;
  if (!record_) record_.emplace().clearance = std::numeric_limits<double>::infinity();
  start_ = cloth.ode.potential_energy(cloth.begin, cloth.start.x);
  least_ = std::numeric_limits<double>::infinity();
  see(cloth.begin, cloth.start);
}

void ContactObserver::see(double t, const solver::State& y) {
  if (!record_) return;
  const double kinetic = solver::kinetic_energy(cloth_->ode, y.v), potential = solver::stored_energy(cloth_->ode, t, y);
  const double energy = kinetic + potential;
  least_ = std::min(least_, energy);
  scale_ = base::larger(scale_, kinetic + std::abs(potential - start_));
  rise_ = base::larger(rise_, energy - least_);
  record_->clearance = std::min(record_->clearance, cloth_->contacts->distances(t, y.x).minCoeff());
  record_->area = contact_area(*scene_, *cloth_, t, y.x);
  record_->energy_rise = scale_ > 0 ? rise_ / scale_ : 0;
}

std::vector<bool> in_contact(const model::Scene& scene, const model::Cloth& cloth, double t, const solver::Vectors& x) {
  std::vector<bool> touching;
  if (!cloth.contacts) return touching;
  for (const double distance : cloth.contacts->distances(t, x))
    touching.push_back(distance <= contact_reach * scene.contact.distance);
  return touching;
}

double contact_area(const model::Scene& scene, const model::Cloth& cloth, double t, const solver::Vectors& x) {
  const Eigen::VectorXd areas = cloth.garment->areas();
  const std::vector<bool> touching = in_contact(scene, cloth, t, x);
  double area = 0;
  for (std::size_t i = 0; i < touching.size(); ++i)
    if (touching[i]) area += areas[static_cast<Eigen::Index>(i)];
  return area / areas.sum();
}

}  // namespace drape::bench
