#include <cmath>
#include <numbers>
#include <vector>

#include "model/obstacles/shapes/exact_shape.hpp"
#include "model/obstacles/shapes/shape_kinds.hpp"

namespace drape::model {
namespace {

struct Sphere : ExactShape<Sphere> {
  double radius = 1;  ///< [m]

  Nearest nearest(const Eigen::Vector3d& p) const override {
    return {p.norm() - radius, direction<Eigen::Vector3d>(p, Eigen::Vector3d::UnitZ())};
  }

  Polygons surface(double /*plane_side*/) const override {
    constexpr int rings = 24;
    std::vector<ProfilePoint> profile;
    for (int k = 0; k < rings; ++k) {
      const double angle = std::numbers::pi * (k + 0.5) / rings;
      profile.push_back({radius * std::sin(angle), -radius * std::cos(angle)});
    }
    return turned(profile);
  }
};

constexpr Key<ShapeRule> sphere_keys[] = {{"radius", "m", "from its centre", at<&Sphere::radius>, check::positive, true}};

}  // namespace

const ShapeKind shapes::sphere{.name = "sphere",
                               .description = "around the origin of its own frame",
                               .smooth = true,
                               .create = create<Sphere>,
                               .keys = keys_in<sphere_keys>};

}  // namespace drape::model
