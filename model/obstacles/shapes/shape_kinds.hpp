#pragma once

#include <memory>
#include <span>

#include "model/keys/key.hpp"
#include "model/obstacles/obstacle.hpp"

/// The shapes: a file each defines one, this list and the table in shape_kinds.cpp name it.
namespace drape::model::shapes {

extern const ShapeKind plane, sphere, box, cylinder, mannequin, mesh;

/// For their rows.
template <class Rule>
std::shared_ptr<ShapeRule> create() {
  return std::make_shared<Rule>();
}

template <const auto& keys>
std::span<const Key<ShapeRule>> keys_in() {
  return keys;
}

}  // namespace drape::model::shapes
