#pragma once

#include <functional>

#include "model/obstacles/obstacle.hpp"

namespace drape::verify {

using DistanceField = std::function<model::Nearest(const Eigen::Vector3d&)>;

/// How far a field is from being a signed distance with its gradient, at worst of some random points in |x|, |y|, |z| < extent:
/// 0 up to round-off, the gradient up to the second order of a difference of 1e-6 extent.
struct FieldErrors {
  double growth = 0;    ///< part by which a difference of distances exceeds the distance of the points
  double length = 0;    ///< of the normal, from 1
  double gradient = 0;  ///< of the distance, by central differences, from the normal
  double surface = 0;   ///< distance of the point that should be the nearest one
};
FieldErrors field_errors(const DistanceField& field, double extent);

/// Expects that no such error exceeds round-off and the error of the difference.
void expect_distance_field(const DistanceField& field, double extent);

}  // namespace drape::verify
