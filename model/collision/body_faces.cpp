#include "model/collision/body_faces.hpp"

#include <Eigen/Geometry>

#include "model/collision/box_tree.hpp"
#include "model/collision/exact_intersection.hpp"
#include "model/collision/face_distance.hpp"

namespace drape::model {
namespace {

std::vector<Corners> triangles_of(const Polygons& polygons) {
  std::vector<Corners> all;
  for (const auto& [a, b, c] : fan_triangles(polygons))
    all.push_back({polygons.vertices[a], polygons.vertices[b], polygons.vertices[c]});
  return all;
}

std::vector<Corners> triangles_of(const ClothSurface& surface, const Vectors& x) {
  std::vector<Corners> all;
  for (int k = 0; k < static_cast<int>(surface.faces().size()); ++k)
    if (!surface.faces()[k].is_edge()) all.push_back(surface.corners(k, x));
  return all;
}

/// A tree of the boxes around triangles, which are larger by `margin` [m] on all sides.
BoxTree tree_of(const std::vector<Corners>& triangles, double margin) {
  BoxTree tree(centres_of(triangles));
  tree.refit(boxes_of(triangles, margin));
  return tree;
}

/// Visits the pairs of a triangle of the cloth and one of a body that are so; `reach`: how far apart they may be then [m].
template <class IsSo, class Visit>
void visit_pairs(const ClothSurface& surface, std::span<const PosedObstacle> bodies, double t, const Vectors& x, double reach,
                 const IsSo& is_so, const Visit& visit) {
  const std::vector<Corners> cloth = triangles_of(surface, x);
  const BoxTree tree = tree_of(cloth, reach);
  for (int body = 0; body < std::ssize(bodies); ++body) {
    const std::vector<Corners> faces = triangles_of(bodies[body].at(t));
    tree.overlapping_pairs(tree_of(faces, 0), [&](int i, int j) {
      if (is_so(cloth[i], faces[j])) visit(i, body);
    });
  }
}

}  // namespace

int face_pairs(const ClothSurface& surface, std::span<const PosedObstacle> bodies, double t, const Vectors& x,
               double distance) {
  int count = 0;
  visit_pairs(
      surface, bodies, t, x, distance, [&](const Corners& one, const Corners& other) { return nearer(one, other, distance); },
      [&](int, int) { ++count; });
  return count;
}

std::vector<BodyIntersection> body_intersections(const ClothSurface& surface, std::span<const PosedObstacle> bodies, double t,
                                                 const Vectors& x) {
  std::vector<BodyIntersection> found;
  visit_pairs(surface, bodies, t, x, 0, intersect, [&](int face, int body) { found.push_back({face, body}); });
  return found;
}

}  // namespace drape::model
