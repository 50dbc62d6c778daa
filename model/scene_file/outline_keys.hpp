#pragma once

#include "model/keys/data.hpp"
#include "model/keys/value.hpp"
#include "model/sheet/outline.hpp"

namespace drape::model {

/// A side of a panel in a scene file: pieces that follow each other. Throws SceneError.
std::vector<CurvePiece> read_side(const std::vector<Value>& entries);

/// Its pieces as a list.
Data side_data(const std::vector<CurvePiece>& side);

/// Throws SceneError unless the sides of a grid's outline meet in four corners, and its lines do not cross. `origin`: of the
/// scene.
void check_outline(const Grid& grid, const std::string& origin);

}  // namespace drape::model
