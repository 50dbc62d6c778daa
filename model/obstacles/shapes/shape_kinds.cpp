#include "model/obstacles/shapes/shape_kinds.hpp"

namespace drape::model {

std::span<const ShapeKind* const> shape_kinds() {
  static constexpr const ShapeKind* table[] = {&shapes::plane,    &shapes::sphere,    &shapes::box,
                                               &shapes::cylinder, &shapes::mannequin, &shapes::mesh};
  return table;
}

}  // namespace drape::model
