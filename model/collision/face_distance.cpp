#include "model/collision/face_distance.hpp"

#include <Eigen/Geometry>

#include "model/collision/proximity.hpp"

namespace drape::model {
namespace {

using Eigen::Vector3d;

bool passes_through(const Corners& face, const Vector3d& p, const Vector3d& q) {
  const auto& [a, b, c] = face;
  const Vector3d n = (b - a).cross(c - a), pq = q - p;
  if (n.dot(p - a) * n.dot(q - a) >= 0) return false;
  const auto side = [&](const Vector3d& from, const Vector3d& to) { return pq.dot((from - p).cross(to - p)); };
  const double ab = side(a, b), bc = side(b, c), ca = side(c, a);
  return (ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0);
}

bool has_near_vertex(const Corners& one, const Corners& other, double distance) {
  for (const Vector3d& p : one)
    if (proximity(PairKind::vertex_face, {p, other[0], other[1], other[2]}).distance < distance) return true;
  return false;
}

bool is_pierced(const Corners& face, const Corners& by) {
  return passes_through(face, by[0], by[1]) || passes_through(face, by[1], by[2]) || passes_through(face, by[2], by[0]);
}

}  // namespace

bool nearer(const Corners& one, const Corners& other, double distance) {
  if (has_near_vertex(one, other, distance) || has_near_vertex(other, one, distance)) return true;
  for (int k = 0; k < 3; ++k)
    for (int m = 0; m < 3; ++m)
      if (proximity(PairKind::edge_edge, {one[k], one[(k + 1) % 3], other[m], other[(m + 1) % 3]}).distance < distance)
        return true;
  return is_pierced(one, other) || is_pierced(other, one);
}

}  // namespace drape::model
