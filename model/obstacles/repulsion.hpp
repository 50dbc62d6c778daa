#pragma once

#include <memory>
#include <vector>

#include "model/obstacles/contacts.hpp"

namespace drape::model {

/// Fields around obstacles that push along the normal n, smooth and without a switch. r is the distance from the surface, d
/// that of the border of the collision area, c the push on a unit of mass there:
///
///     penalty:  F = m c (d/r)ⁿ n                                            [Etzmuß 2002, 4.1]
///     field:    F = m exp((d − r)/e) (c + b <w − v,n>) n,   b = 2 √(c/e)    [Terzopoulos, Fleischer 1988; Etzmuß 2002, 4.2]
///
/// The first is a potential, which gives back what it takes. The second is damped, critically in a rest at the border; as
/// printed it would attract, since its gradient points away from the obstacle. Neither has friction. Where it is a million
/// times that at the border a field goes on linearly, so that what went through the surface has a way back.
class Repulsion {
 public:
  Repulsion(std::shared_ptr<Contacts> contacts, const ContactRule& rule, Eigen::VectorXd mass);

  /// Adds F to f.
  void add(double t, const Vectors& x, const Vectors& v, Vectors& f);

  /// ∂F/∂x [N/m] and ∂F/∂v [N s/m] of each particle.
  struct Derivatives {
    std::vector<Eigen::Matrix3d> by_x, by_v;  ///< the second empty if there is no damping
  };

  /// As if surfaces were planes; `exact`: else negative semidefinite.
  const Derivatives& derivatives(double t, const Vectors& x, const Vectors& v, bool exact);

 private:
  /// F over m c without damping, and its derivative by r [1/m].
  struct Strength {
    double value, slope;
  };
  Strength strength(double r) const;
  double distance_at(double strength) const;

  std::shared_ptr<Contacts> contacts_;
  ContactRule rule_;
  Eigen::VectorXd mass_;
  double damping_;          ///< b [1/s]
  double nearest_, reach_;  ///< distances from the surface between which the field is as above, and beyond which it is 0 [m]
  std::vector<Depth> near_;
  Derivatives derivatives_;
};

}  // namespace drape::model
