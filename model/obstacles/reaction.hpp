#pragma once

#include <memory>

#include "model/obstacles/contacts.hpp"

namespace drape::model {

/// Reaction constraints: inside the collision area the force along the normal is replaced by a critically damped spring to its
/// border, k = m/τ² and d = 2m/τ,
///
///     F⁺ = F⁻ − <F⁻,n> n + k <z − x,n> n + d <w − v,n> n     unless <F⁻,n> > 0     [Etzmuß 2002, (4.1)]
///
/// with Coulomb friction, smoothed at creeping velocities, so that nothing sticks. A force like others: it jumps where it is
/// switched, and no Jacobian knows of it.
class Reaction {
 public:
  Reaction(std::shared_ptr<Contacts> contacts, const ContactRule& rule, Eigen::VectorXd mass);

  /// Whether any particle is in the collision area.
  bool acts(double t, const Vectors& x);

  /// Adds F⁺ − F⁻ to f where the last `acts` found particles; before: F⁻, may be f.
  void add(const Vectors& v, const Vectors& before, Vectors& f) const;

 private:
  std::shared_ptr<Contacts> contacts_;
  ContactRule rule_;
  Eigen::VectorXd mass_;
  std::vector<Depth> inside_;
};

}  // namespace drape::model
