#include "model/collision/approach.hpp"

#include <algorithm>
#include <cmath>

namespace drape::model {
namespace {

constexpr int most_advances = 100;

/// How far the motion goes until a point of the one comes nearer to one of the other than `distance` along the normal, if all
/// do not before its end; infinity if they never do.
double advance(PairKind kind, const FourPoints& x, const FourPoints& x0, const FourPoints& x1, const Eigen::Vector3d& normal,
               double distance) {
  const int firsts = kind == PairKind::vertex_face ? 1 : 2;
  Eigen::Vector4d height, rate;
  for (int k = 0; k < 4; ++k) {
    height[k] = normal.dot(x[k]);
    rate[k] = normal.dot(x1[k] - x0[k]);
  }
  double least = HUGE_VAL;
  for (int one = 0; one < firsts; ++one)
    for (int other = firsts; other < 4; ++other)
      if (const double falls = rate[other] - rate[one]; falls > 0)
        least = std::min(least, (height[one] - height[other] - distance) / falls);
  return least;
}

}  // namespace

FourPoints points_between(const FourPoints& x0, const FourPoints& x1, double part) {
  FourPoints x;
  for (int k = 0; k < 4; ++k) x[k] = x0[k] + part * (x1[k] - x0[k]);
  return x;
}

std::optional<double> first_approach(PairKind kind, const FourPoints& x0, const FourPoints& x1, double distance) {
  const double enough = reached(distance), aim = (distance + enough) / 2;  // so that steps end above `distance`
  double part = 0;
  for (int k = 0; k < most_advances; ++k) {
    const FourPoints x = points_between(x0, x1, part);
    const Proximity now = proximity(kind, x);
    if (now.distance <= enough) return part;
    part += std::max(0.0, advance(kind, x, x0, x1, now.normal, aim));
    if (part > 1) return std::nullopt;
  }
  return part;
}

std::optional<Approach> approach(PairKind kind, const std::array<int, 4>& particles, const Vectors& x0, const Vectors& x1,
                                 double distance, bool may_end) {
  const FourPoints begin = points_of(particles, x0), end = points_of(particles, x1);
  const std::optional<double> part = first_approach(kind, begin, end, distance);
  if (!part) return {};
  const Proximity nearest = proximity(kind, particles, begin);
  Approach found{kind, nearest, nearest, *part};
  if (*part > 0) found.touch = proximity(kind, particles, points_between(begin, end, *part));
  const Proximity last = proximity(kind, particles, end);
  if (last.is_inside() && last.normal.dot(found.touch.normal) > 0) found.touch = last;
  if (kind == PairKind::edge_edge && !may_end && !found.touch.is_inside()) return {};
  if (nearest.distance < distance && last.distance >= distance && !first_approach(kind, begin, end, 0.999 * nearest.distance))
    return {};
  return found;
}

}  // namespace drape::model
