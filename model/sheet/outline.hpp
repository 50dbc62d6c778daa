#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "solver/state.hpp"

namespace drape::model {

/// A piece of a curve in the plane of the pattern.
struct CurvePiece {
  enum class Kind {
    line,      ///< from the first point to the second
    arc,       ///< of the circle through three points, from the first to the last
    bezier,    ///< with these control points
    polyline,  ///< straight from each point to the next
  } kind = Kind::line;
  std::vector<Eigen::Vector2d> points;  ///< [m]
  int cells = 0;  ///< of a grid along a piece of its side, with equal lengths; 0: the side says where its particles are

  bool operator==(const CurvePiece&) const = default;
};

/// A curve in the plane, by its arc length.
class Curve {
 public:
  /// The pieces one after the other; at least one.
  explicit Curve(const std::vector<CurvePiece>& pieces);

  double length() const { return pieces_.back().end; }  ///< [m]

  /// The length up to the end of a piece [m].
  double length_up_to(std::size_t piece) const { return pieces_[piece].end; }

  /// The point at a part of the length, from 0 to 1.
  Eigen::Vector2d at(double part) const;

 private:
  struct Measured {
    CurvePiece piece;
    double end;  ///< length up to its end [m]
    std::vector<double>
        passed;  ///< length within it up to equidistant parameters, up to points; empty if its speed is constant
  };
  std::vector<Measured> pieces_;
};

/// The two parts of a piece on both sides of the point at a part of its length, between 0 and 1. They count no cells.
std::array<CurvePiece, 2> divided(const CurvePiece& piece, double part);

/// The four sides of a panel in the plane of its pattern: lower and upper along u, left and right along v; each from the lower
/// left to the upper right. Empty: a rectangle.
struct Outline {
  std::vector<CurvePiece> lower, upper, left, right;

  bool given() const { return !lower.empty() || !upper.empty() || !left.empty() || !right.empty(); }
  bool operator==(const Outline&) const = default;
};

/// The straight sides u and v from the origin and the two opposite ones.
Outline parallelogram(const Eigen::Vector2d& u, const Eigen::Vector2d& v);

/// The places of n particles on a side as parts of its length. `grading`: the last spacing over the first; they grow by a
/// constant factor.
std::vector<double> graded(int n, double grading);

/// The cells that pieces of a side count; 0: they do not.
std::int64_t counted_cells(const std::vector<CurvePiece>& side);

/// Points inside an outline by transfinite interpolation [Gordon, Hall 1973; Etzmuß 2002, 2.7]:
///   s(u, v) = (1 − v) lower(u) + v upper(u) + (1 − u) left(v) + u right(v)
///             − (1 − u)(1 − v) P00 − u (1 − v) P10 − (1 − u) v P01 − u v P11.
/// Row a + |u| b is the point of u[a], v[b]: x, y, and z = 0 [m]. A side whose pieces count cells has its own places, whose
/// number must be that of u or v; u and v of a point are then where the lines between places on opposite sides of the unit
/// square meet.
solver::Vectors transfinite(const Outline& outline, const std::vector<double>& u, const std::vector<double>& v);

}  // namespace drape::model
