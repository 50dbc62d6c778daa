#include "model/sheet/cut.hpp"

#include <algorithm>

namespace drape::model {
namespace {

using Eigen::Vector2d;

constexpr int chords = 1024;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

std::vector<Vector2d> closed_polygon(const std::vector<CurvePiece>& curve) {
  std::vector<Vector2d> polygon;
  for (const CurvePiece& piece : curve) {
    const Curve whole({piece});
    const int parts = piece.kind == CurvePiece::Kind::line ? 1 : chords;
    for (int k = 0; k < parts; ++k) polygon.push_back(whole.at(k / double(parts)));
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

bool crosses_itself(std::span<const Vector2d> polygon) {
  const std::size_t n = polygon.size();
  const auto between = [](const Vector2d& p, const Vector2d& q, const Vector2d& r, const Vector2d& s) {
    return cross(q - p, r - p) * cross(q - p, s - p) < 0 && cross(s - r, p - r) * cross(s - r, q - r) < 0;
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j)
      if (between(polygon[i], polygon[i + 1], polygon[j], polygon[(j + 1) % n])) return true;
  return false;
}

}  // namespace drape::model
