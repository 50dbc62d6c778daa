#include "model/obstacles/repulsion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace drape::model {
namespace {

constexpr double strongest = 1e6;  ///< of the push at the border: beyond it is linear
constexpr double nothing = 1e-16;  ///< part of the push at the border that is none

}  // namespace

Repulsion::Repulsion(std::shared_ptr<Contacts> contacts, const ContactRule& rule, Eigen::VectorXd mass)
    : contacts_(std::move(contacts)),
      rule_(rule),
      mass_(std::move(mass)),
      damping_(rule.response == ResponseKind::field ? 2 * std::sqrt(rule.push / rule.range) : 0),
      nearest_(distance_at(strongest)),
      reach_(distance_at(nothing)) {}

double Repulsion::distance_at(double strength) const {
  if (rule_.response == ResponseKind::penalty) return rule_.distance * std::pow(strength, -1 / rule_.exponent);
  return rule_.distance - rule_.range * std::log(strength);
}

Repulsion::Strength Repulsion::strength(double r) const {
  if (r < nearest_) {
    const Strength last = strength(nearest_);
    return {last.value + last.slope * (r - nearest_), last.slope};
  }
  if (rule_.response == ResponseKind::penalty) {
    const double value = std::pow(rule_.distance / r, rule_.exponent);
    return {value, -rule_.exponent * value / r};
  }
  const double value = std::exp((rule_.distance - r) / rule_.range);
  return {value, -value / rule_.range};
}

void Repulsion::add(double t, const Vectors& x, const Vectors& v, Vectors& f) {
  contacts_->near(t, x, reach_, near_);
  for (const Depth& at : near_) {
    const double recedes = (at.velocity - v.row(at.particle).transpose()).dot(at.normal);
    const double push = strength(rule_.distance - at.depth).value * (rule_.push + damping_ * recedes);
    f.row(at.particle) += mass_[at.particle] * push * at.normal;
  }
}

const Repulsion::Derivatives& Repulsion::derivatives(double t, const Vectors& x, const Vectors& v, bool exact) {
  contacts_->near(t, x, reach_, near_);
  const auto particles = static_cast<std::size_t>(mass_.size());
  derivatives_.by_x.assign(particles, Eigen::Matrix3d::Zero());
  derivatives_.by_v.assign(damping_ > 0 ? particles : 0, Eigen::Matrix3d::Zero());
  for (const Depth& at : near_) {
    const auto i = static_cast<std::size_t>(at.particle);
    const Strength s = strength(rule_.distance - at.depth);
    const double recedes = (at.velocity - v.row(at.particle).transpose()).dot(at.normal);
    double push = rule_.push + damping_ * recedes;
    if (!exact) push = std::max(0.0, push);
    const Eigen::Matrix3d along = mass_[at.particle] * at.normal * at.normal.transpose();
    derivatives_.by_x[i] += s.slope * push * along;
    if (damping_ > 0) derivatives_.by_v[i] -= s.value * damping_ * along;
  }
  return derivatives_;
}

}  // namespace drape::model
