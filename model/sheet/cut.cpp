#include "model/sheet/cut.hpp"

#include <algorithm>

namespace drape::model {
namespace {

using Eigen::Vector2d;

constexpr int chords = 1024;  // of a curved piece

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

std::vector<Vector2d> closed_polygon(const std::vector<CurvePiece>& curve) {
  std::vector<Vector2d> polygon;
  for (const CurvePiece& piece : curve) {
    const Curve whole({piece});
    if (piece.kind == CurvePiece::Kind::polyline)
      polygon.insert(polygon.end(), piece.points.begin(), piece.points.end() - 1);
    else
      for (int k = 0, parts = piece.kind == CurvePiece::Kind::line ? 1 : chords; k < parts; ++k)
        polygon.push_back(whole.at(k / double(parts)));
  }
  if (polygon_area(polygon) < 0) std::ranges::reverse(polygon);
  return polygon;
}

double polygon_area(std::span<const Vector2d> polygon) {
  double twice = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k)
    twice += cross(polygon[k] - polygon[0], polygon[(k + 1) % polygon.size()] - polygon[0]);
  return twice / 2;
}

std::vector<Vector2d> left_part(std::span<const Vector2d> polygon, const Vector2d& from, const Vector2d& to) {
  std::vector<Vector2d> part;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector2d &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const double p_left = cross(to - from, p - from), q_left = cross(to - from, q - from);
    if (p_left >= 0) part.push_back(p);
    if ((p_left > 0 && q_left < 0) || (p_left < 0 && q_left > 0)) part.emplace_back(p + p_left / (p_left - q_left) * (q - p));
  }
  return part;
}

/// Sides that only meet do not cross: one end of one lies at an end of the other, exactly.
bool lines_cross(const Vector2d& from, const Vector2d& to, const Vector2d& other_from, const Vector2d& other_to) {
  const auto parts = [](const Vector2d& begin, const Vector2d& end, const Vector2d& p, const Vector2d& q) {
    return cross(end - begin, p - begin) * cross(end - begin, q - begin) < 0;
  };
  return parts(from, to, other_from, other_to) && parts(other_from, other_to, from, to);
}

bool crosses_itself(std::span<const Vector2d> polygon) {
  struct Side {
    Vector2d from, to;
    double left() const { return std::min(from.x(), to.x()); }
    double right() const { return std::max(from.x(), to.x()); }
  };
  std::vector<Side> sides;
  for (std::size_t k = 0; k < polygon.size(); ++k) sides.push_back({polygon[k], polygon[(k + 1) % polygon.size()]});
  std::ranges::sort(sides, {}, &Side::left);
  for (auto one = sides.begin(); one != sides.end(); ++one)
    for (auto other = one + 1; other != sides.end() && other->left() <= one->right(); ++other)
      if (lines_cross(one->from, one->to, other->from, other->to)) return true;
  return false;
}

}  // namespace drape::model
