#include "bench/runs/contact_observer.hpp"

#include <algorithm>
#include <limits>

#include "solver/base/largest.hpp"

namespace drape::bench {

ContactWatch::ContactWatch(const model::Scene& scene, const model::Cloth& cloth) : scene_(scene), cloth_(cloth) {
  record_.clearance = std::numeric_limits<double>::infinity();
}

void ContactWatch::see(double t, const solver::State& y, double kinetic, double potential) {
  if (!cloth_.contacts) return;
  const double energy = kinetic + potential;
  if (!begun_) {
    start_ = potential;
    least_ = energy;
    begun_ = true;
  }
  scale_ = base::larger(scale_, kinetic + std::abs(potential - start_));
  rise_ = base::larger(rise_, energy - least_);
  least_ = std::min(least_, energy);
  record_.clearance = std::min(record_.clearance, cloth_.contacts->distances(t, y.x).minCoeff());
  record_.area = contact_area(scene_, cloth_, t, y.x);
  record_.energy_rise = scale_ > 0 ? rise_ / scale_ : 0;
}

std::optional<results::ContactRecord> ContactWatch::result() const {
  if (!cloth_.contacts) return {};
  return record_;
}

std::vector<bool> in_contact(const model::Scene& scene, const model::Cloth& cloth, double t, const solver::Vectors& x) {
  std::vector<bool> touching;
  if (!cloth.contacts) return touching;
  for (const double distance : cloth.contacts->distances(t, x)) touching.push_back(distance <= 1.05 * scene.contact.distance);
  return touching;
}

double contact_area(const model::Scene& scene, const model::Cloth& cloth, double t, const solver::Vectors& x) {
  const Eigen::VectorXd areas = scene.sheet.grid.cell_areas();
  const std::vector<bool> touching = in_contact(scene, cloth, t, x);
  double area = 0;
  for (std::size_t i = 0; i < touching.size(); ++i)
    if (touching[i]) area += areas[static_cast<Eigen::Index>(i)];
  return area / areas.sum();
}

}  // namespace drape::bench
