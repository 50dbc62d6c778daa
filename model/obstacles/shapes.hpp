#pragma once

#include <memory>

#include "model/obstacles/obstacle.hpp"

namespace drape::model {

/// Shapes with exact formulas. Inside, the nearest part of the surface counts; where several parts are equally near (the centre
/// of a sphere, the axis of a cylinder), the normal is that of one of them. Sides and radii are positive [m].
std::unique_ptr<const Shape> half_space();                            ///< below z = 0
std::unique_ptr<const Shape> sphere(double radius);                   ///< around the origin
std::unique_ptr<const Shape> box(const Eigen::Vector3d& size);        ///< centred, along the axes
std::unique_ptr<const Shape> cylinder(double radius, double height);  ///< centred, around the z axis

}  // namespace drape::model
