#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>

#include "model/keys/data.hpp"
#include "model/keys/key.hpp"
#include "model/keys/value.hpp"
#include "model/sheet/outline.hpp"

namespace drape::model {

/// How a point of a curve is read.
using PointReader = std::function<Eigen::Vector2d(const Value&)>;

/// The piece of a curve in a table that may have other keys. Throws SceneError.
CurvePiece read_piece(const Value& value, const PointReader& point, std::span<const KeyInfo> others);

/// A curve in a scene file: pieces that follow each other. Throws SceneError.
std::vector<CurvePiece> read_curve(const std::vector<Value>& entries);

/// Its pieces as a list.
Data curve_data(const std::vector<CurvePiece>& curve);

/// Gives a grid the size of the box around its outline, if that has four sides with the grid's cells.
void fit_size(Grid& grid);

/// Throws SceneError unless the sides of a grid's outline meet in four corners, its lines do not cross, and its cut is closed,
/// does not cross itself and leaves cloth. `origin`: of the scene.
void check_outline(const Grid& grid, const std::string& origin);

}  // namespace drape::model
