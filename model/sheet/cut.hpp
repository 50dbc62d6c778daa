#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "model/sheet/outline.hpp"

namespace drape::model {

/// A closed curve as a polygon, counterclockwise: curved pieces have 1024 chords, so that half a circle has its
/// area to 2e-6.
std::vector<Eigen::Vector2d> closed_polygon(const std::vector<CurvePiece>& curve);

/// Positive if counterclockwise [m²].
double polygon_area(std::span<const Eigen::Vector2d> polygon);

/// The part of a polygon on the left of the line from one point to another [Sutherland, Hodgman 1974]. Where it has several
/// parts, edges of width 0 join them.
std::vector<Eigen::Vector2d> left_part(std::span<const Eigen::Vector2d> polygon, const Eigen::Vector2d& from,
                                       const Eigen::Vector2d& to);

/// Whether two straight lines, from one point to another each, cross between their ends.
bool lines_cross(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Eigen::Vector2d& other_from,
                 const Eigen::Vector2d& other_to);

/// Whether two sides of a polygon cross.
bool crosses_itself(std::span<const Eigen::Vector2d> polygon);

}  // namespace drape::model
