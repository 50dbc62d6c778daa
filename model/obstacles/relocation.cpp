#include "model/obstacles/relocation.hpp"

#include <algorithm>
#include <utility>

namespace drape::model {

Relocation::Relocation(std::shared_ptr<Contacts> contacts, const ContactRule& rule)
    : contacts_(std::move(contacts)), rule_(rule) {}

bool Relocation::operator()(double t, double h, const solver::State& y0, solver::State& y1) {
  if (rule_.detection == DetectionKind::ray)
    contacts_->passed(t, h, y0.x, y1.x, inside_);
  else
    contacts_->near(t + h, y1.x, rule_.distance, inside_);
  found_ = y1.x;
  const double e = rule_.response == ResponseKind::reflect ? rule_.restitution : 0;
  const bool counteracts = rule_.response == ResponseKind::impulse;
  for (const Depth& at : inside_) {
    const Eigen::Vector3d &n = at.normal, moved = y1.x.row(at.particle) - found_.row(at.particle);
    y1.x.row(at.particle) += std::max(0.0, at.depth - moved.dot(n)) * n;
    const Eigen::Vector3d v = y1.v.row(at.particle);
    const double approach = (at.velocity - v).dot(n);
    const double pressed = counteracts ? std::max(0.0, (y0.v.row(at.particle).transpose() - v).dot(n)) : 0;
    if (approach + pressed > 0) y1.v.row(at.particle) += ((1 + e) * approach + pressed) * n;
  }
  return !inside_.empty();
}

}  // namespace drape::model
