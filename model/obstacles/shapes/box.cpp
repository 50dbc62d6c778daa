#include <cmath>

#include "model/obstacles/shapes/exact_shape.hpp"
#include "model/obstacles/shapes/shape_kinds.hpp"

namespace drape::model {
namespace {

struct Box : ExactShape<Box> {
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  ///< [m]

  Nearest nearest(const Eigen::Vector3d& p) const override {
    auto [distance, normal] = nearest_of_corner<Eigen::Vector3d>(p.cwiseAbs() - size / 2);
    for (int c = 0; c < 3; ++c) normal[c] = std::copysign(normal[c], p[c]);
    return {distance, normal};
  }

  Polygons surface(double /*plane_side*/) const override {
    Polygons polygons;
    for (const double z : {-0.5, 0.5})
      for (const Eigen::Vector3d& corner : square(1).vertices)
        polygons.vertices.emplace_back((corner + Eigen::Vector3d(0, 0, z)).cwiseProduct(size));
    polygons.faces = {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    return polygons;
  }
};

constexpr Key<ShapeRule> box_keys[] = {{"size", "m", "[x, y, z] of its sides", at<&Box::size>, check::positive, true}};

}  // namespace

const ShapeKind shapes::box{.name = "box",
                            .description = "centred in its own frame, along the axes",
                            .smooth = false,
                            .create = create<Box>,
                            .keys = keys_in<box_keys>};

}  // namespace drape::model
