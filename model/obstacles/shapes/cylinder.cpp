#include <cmath>

#include "model/obstacles/shapes/exact_shape.hpp"
#include "model/obstacles/shapes/shape_kinds.hpp"

namespace drape::model {
namespace {

struct Cylinder : ExactShape<Cylinder> {
  double radius = 1;  ///< [m]
  double height = 1;  ///< [m]

  Nearest nearest(const Eigen::Vector3d& p) const override {
    const Eigen::Vector2d across = p.head<2>();
    const auto [distance, n] = nearest_of_corner<Eigen::Vector2d>({across.norm() - radius, std::abs(p.z()) - height / 2});
    const Eigen::Vector2d radial = n[0] * direction<Eigen::Vector2d>(across, Eigen::Vector2d::UnitX());
    return {distance, {radial.x(), radial.y(), std::copysign(n[1], p.z())}};
  }

  Polygons surface(double /*plane_side*/) const override { return turned({{radius, -height / 2}, {radius, height / 2}}); }
};

constexpr Key<ShapeRule> cylinder_keys[] = {{"radius", "m", "from its axis", at<&Cylinder::radius>, check::positive, true},
                                            {"height", "m", "along its axis", at<&Cylinder::height>, check::positive, true}};

}  // namespace

const ShapeKind shapes::cylinder{.name = "cylinder",
                                 .description = "centred in its own frame, its axis along z: a round table",
                                 .smooth = false,
                                 .create = create<Cylinder>,
                                 .keys = keys_in<cylinder_keys>};

}  // namespace drape::model
