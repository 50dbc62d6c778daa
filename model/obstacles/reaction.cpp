#include "model/obstacles/reaction.hpp"

#include <algorithm>

namespace drape::model {
namespace {

/// Speed at which friction has half of its strength, over that which crosses the collision area in the time of a reaction.
constexpr double creeping = 1e-3;

}  // namespace

Reaction::Reaction(std::shared_ptr<Contacts> contacts, const ContactRule& rule, Eigen::VectorXd mass)
    : contacts_(std::move(contacts)), rule_(rule), mass_(std::move(mass)) {}

bool Reaction::acts(double t, const Vectors& x) {
  contacts_->near(t, x, rule_.distance, inside_);
  return !inside_.empty();
}

void Reaction::add(const Vectors& v, const Vectors& before, Vectors& f) const {
  const double tau = rule_.reaction_time, slow = creeping * rule_.distance / tau;
  for (const Depth& at : inside_) {
    const Eigen::Vector3d n = at.normal, F = before.row(at.particle);
    if (F.dot(n) > 0) continue;
    const double m = mass_[at.particle];
    const Eigen::Vector3d w_v = at.velocity - v.row(at.particle).transpose();
    const double normal = -F.dot(n) + m / (tau * tau) * at.depth + 2 * m / tau * w_v.dot(n);
    const Eigen::Vector3d back = w_v - w_v.dot(n) * n;
    f.row(at.particle) += normal * n + at.friction * std::max(0.0, normal) / (back.norm() + slow) * back;
  }
}

}  // namespace drape::model
