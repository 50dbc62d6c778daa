#include "model/collision/proximity.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace drape::model {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

/// The square of a sine below which lines are taken as parallel: round-off in the place of a nearest point grows as 1 over it.
constexpr double least_sine_squared = 1e-16;

/// Over the size of what touches: a vector that is shorter is round-off and has no direction.
constexpr double no_direction = 1e-12;

/// The part of the way from a to b at which p is nearest.
double part_along(const Vector3d& a, const Vector3d& b, const Vector3d& p) {
  const Vector3d ab = b - a;
  const double squared = ab.squaredNorm();
  return squared > 0 ? std::clamp(ab.dot(p - a) / squared, 0.0, 1.0) : 0;
}

Vector3d weighted(const Vector4d& weights, const FourPoints& x) {
  return weights[0] * x[0] + weights[1] * x[1] + weights[2] * x[2] + weights[3] * x[3];
}

/// `across`: a normal where they touch, of any length; `size`: of the pair [m].
Proximity from_weights(const Vector4d& weights, const FourPoints& x, const Vector3d& across, double size) {
  const Vector3d apart = weighted(weights, x);
  const double distance = apart.norm();
  if (distance > no_direction * size) return {{0, 1, 2, 3}, weights, apart / distance, distance};
  Vector3d normal = across.stableNormalized();
  if (normal.dot(apart) < 0) normal = -normal;
  return {{0, 1, 2, 3}, weights, normal, distance};
}

/// `n`, or any perpendicular to `along` if it vanishes.
Vector3d perpendicular(const Vector3d& n, const Vector3d& along) {
  if (n.squaredNorm() > 0) return n;
  return along.squaredNorm() > 0 ? along.unitOrthogonal() : Vector3d::UnitZ();
}

Proximity vertex_and_face(const FourPoints& x) {
  const auto& [p, a, b, c] = x;
  const Vector3d ab = b - a, ac = c - a, ap = p - a, n = ab.cross(ac);
  const double squared = n.squaredNorm(), ab_squared = ab.squaredNorm(), ac_squared = ac.squaredNorm();
  const double size = std::sqrt(std::max(ab_squared, ac_squared));
  if (squared > least_sine_squared * ab_squared * ac_squared) {
    const double wb = ap.cross(ac).dot(n) / squared, wc = ab.cross(ap).dot(n) / squared, wa = 1 - wb - wc;
    if (wa > 0 && wb > 0 && wc > 0) return from_weights({1, -wa, -wb, -wc}, x, n, size);
  }
  Vector4d nearest = Vector4d::Zero();
  double least = HUGE_VAL;
  for (int k = 1; k < 4; ++k) {
    const int next = k % 3 + 1;
    const double part = part_along(x[k], x[next], p);
    Vector4d weights{1, 0, 0, 0};
    weights[k] = part - 1;
    weights[next] = -part;
    const double away = weighted(weights, x).squaredNorm();
    if (away < least) least = away, nearest = weights;
  }
  return from_weights(nearest, x, perpendicular(n, ab_squared > ac_squared ? ab : ac), size);
}

/// [Ericson 2005, Real-Time Collision Detection, 5.1.9]
Proximity two_edges(const FourPoints& x) {
  const auto& [a, b, c, d] = x;
  const Vector3d ab = b - a, cd = d - c, ca = a - c;
  const double e = ab.squaredNorm(), f = cd.squaredNorm(), mixed = ab.dot(cd), along_ab = ab.dot(ca), along_cd = cd.dot(ca);
  const double determinant = e * f - mixed * mixed;
  double s =
      determinant > least_sine_squared * e * f ? std::clamp((mixed * along_cd - along_ab * f) / determinant, 0.0, 1.0) : 0;
  double t = f > 0 ? (mixed * s + along_cd) / f : 0;
  if (f == 0 || t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = part_along(a, b, c + t * cd);
  }
  return from_weights({1 - s, s, t - 1, -t}, x, perpendicular(ab.cross(cd), e > f ? ab : cd), std::sqrt(std::max(e, f)));
}

}  // namespace

Proximity proximity(PairKind kind, const FourPoints& x) {
  return kind == PairKind::vertex_face ? vertex_and_face(x) : two_edges(x);
}

Proximity proximity(PairKind kind, const std::array<int, 4>& particles, const FourPoints& x) {
  Proximity found = proximity(kind, x);
  found.particles = particles;
  return found;
}

}  // namespace drape::model
