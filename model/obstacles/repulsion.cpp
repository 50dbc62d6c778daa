#include "model/obstacles/repulsion.hpp"

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
      reach_(distance_at(nothing)),
      by_x_(static_cast<std::size_t>(mass_.size())),
      by_v_(by_x_) {}

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

void Repulsion::visit(double t, const Vectors& x, const Vectors& v, const JacobianEntries& entries) {
  contacts_->near(t, x, reach_, near_);
  by_x_.assign(by_x_.size(), Eigen::Matrix3d::Zero());
  by_v_.assign(by_v_.size(), Eigen::Matrix3d::Zero());
  for (const Depth& at : near_) {
    const auto i = static_cast<std::size_t>(at.particle);
    const Strength s = strength(rule_.distance - at.depth);
    const double recedes = (at.velocity - v.row(at.particle).transpose()).dot(at.normal);
    double push = rule_.push + damping_ * recedes;
    if (!entries.exact()) push = std::max(0.0, push);
    const Eigen::Matrix3d along = mass_[at.particle] * at.normal * at.normal.transpose();
    by_x_[i] += s.slope * push * along;
    by_v_[i] -= s.value * damping_ * along;
  }
  for (std::size_t i = 0; i < by_x_.size(); ++i) {
    entries.add_dx(static_cast<int>(i), static_cast<int>(i), by_x_[i]);
    if (damping_ > 0) entries.add_dv(static_cast<int>(i), static_cast<int>(i), by_v_[i]);
  }
}

}  // namespace drape::model
