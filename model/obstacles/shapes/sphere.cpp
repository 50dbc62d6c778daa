#include <cmath>
#include <numbers>
#include <vector>

#include "model/obstacles/shapes/exact_shape.hpp"
#include "model/obstacles/shapes/shape_kinds.hpp"

namespace drape::model {
namespace {

struct Sphere : ExactShape<Sphere> {
  double radius = 1;  ///< [m]
  int vertices = 0;   ///< of its surface; 0: it is drawn by quadrilaterals

  Nearest nearest(const Eigen::Vector3d& p) const override {
    return {p.norm() - radius, direction<Eigen::Vector3d>(p, Eigen::Vector3d::UnitZ())};
  }

  Polygons surface(double /*plane_side*/) const override {
    if (vertices > 0) {
      Polygons ringed = ringed_sphere(vertices);
      for (Eigen::Vector3d& vertex : ringed.vertices) vertex *= radius;
      return ringed;
    }
    constexpr int rings = 24;
    std::vector<ProfilePoint> profile;
    for (int k = 0; k < rings; ++k) {
      const double angle = std::numbers::pi * (k + 0.5) / rings;
      profile.push_back({radius * std::sin(angle), -radius * std::cos(angle)});
    }
    return turned(profile);
  }
};

void read_vertices(const Value& value, ShapeRule& rule) {
  constexpr double least = 20, most = 1e5;
  const double given = value.number();
  if (given != 0 && (given < least || given > most || given != std::floor(given)))
    value.fail("0 or a whole number from 20 to 100000");
  at<&Sphere::vertices>.in(rule) = static_cast<int>(given);
}

Data vertices_data(const ShapeRule& rule) { return static_cast<double>(at<&Sphere::vertices>.in(rule)); }

constexpr Key<ShapeRule> sphere_keys[] = {
    {"radius", "m", "from its centre", at<&Sphere::radius>, check::positive, true},
    {"vertices", "1", "of its surface, on rings: what is drawn and divides springs; 0: 24 rings of quadrilaterals",
     read_vertices, vertices_data}};

}  // namespace

const ShapeKind shapes::sphere{.name = "sphere",
                               .description = "around the origin of its own frame",
                               .smooth = true,
                               .create = create<Sphere>,
                               .keys = keys_in<sphere_keys>};

}  // namespace drape::model
