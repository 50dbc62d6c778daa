#include "model/obstacles/shapes/exact_shape.hpp"
#include "model/obstacles/shapes/shape_kinds.hpp"

namespace drape::model {
namespace {

class HalfSpace : public ExactShape<HalfSpace> {
 public:
  Nearest nearest(const Eigen::Vector3d& p) const override { return {p.z(), Eigen::Vector3d::UnitZ()}; }
  Polygons surface(double plane_side) const override { return square(plane_side); }
};

}  // namespace

const ShapeKind shapes::plane{.name = "plane",
                              .description = "the half-space below z = 0 of its own frame",
                              .smooth = false,
                              .create = create<HalfSpace>,
                              .keys = [] { return std::span<const Key<ShapeRule>>(); }};

}  // namespace drape::model
