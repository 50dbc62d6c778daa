#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <utility>

#include "model/obstacles/obstacle.hpp"

namespace drape::model {

/// A shape with an exact formula of its values. Inside, the nearest part of the surface counts; where several parts are equally
/// near (the centre of a sphere, the axis of a cylinder), the normal is that of one of them.
template <class Derived>
class ExactShape : public ShapeRule, public Shape {
 public:
  std::unique_ptr<const Shape> make() const override { return std::make_unique<Derived>(static_cast<const Derived&>(*this)); }
};

/// p/|p|, or `otherwise` where p has no direction.
template <class Vector>
Vector direction(const Vector& p, const Vector& otherwise) {
  const double norm = p.stableNorm();
  return norm < std::numeric_limits<double>::min() ? otherwise : Vector(p / norm);
}

/// The distance to a convex corner and the normal there: `q` is the signed distance to each of its orthogonal sides.
template <class Vector>
std::pair<double, Vector> nearest_of_corner(const Vector& q) {
  Eigen::Index side = 0;
  const double inside = q.maxCoeff(&side);
  if (inside <= 0) return {inside, Vector::Unit(side)};
  const Vector beyond = q.cwiseMax(0);
  return {beyond.stableNorm(), beyond.stableNormalized()};
}

}  // namespace drape::model
