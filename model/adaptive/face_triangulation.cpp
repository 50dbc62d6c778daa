#include "model/adaptive/face_triangulation.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>

#include "model/adaptive/face_projection.hpp"

namespace drape::model {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using FlatKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<FlatKernel, CGAL::Default, CGAL::Exact_predicates_tag>;
using Planar = CGAL::Constrained_triangulation_plus_2<Delaunay>;
using Vertex = Planar::Vertex_handle;

/// One face while it is triangulated.
class FlatFace {
 public:
  FlatFace(const BareFace& face, const HitFace& hit) : face_(face), hit_(hit), normal_(face_normal(face.corners)) {
    const auto& [a, b, c] = face.corners;
    const Vector3d along = (b - a).normalized(), across = normal_.cross(along);
    for (int k = 0; k < 3; ++k) flat_[k] = {along.dot(face.corners[k] - a), across.dot(face.corners[k] - a)};
  }

  /// Inserts corners and border, then the points inside.
  void insert_points(const std::function<Vector3d(int)>& position) {
    for (int k = 0; k < 3; ++k) insert(face_.nodes[k], Vector3d::Unit(k));
    std::vector<std::pair<double, const FacePoint*>> inside;
    for (const FacePoint& point : hit_.points) {
      if (point.barycentric.minCoeff() == 0)
        insert(point.particle, point.barycentric);
      else
        inside.emplace_back(-height(position(point.particle)), &point);
    }
    for (int k = 0; k < 3; ++k) {
      Vertex from = vertices_.at(face_.nodes[k]);
      std::vector<int> border = hit_.borders[k];
      border.push_back(face_.nodes[(k + 1) % 3]);
      for (const int next : border) {
        planar_.insert_constraint(from, vertices_.at(next));
        from = vertices_.at(next);
      }
    }
    std::ranges::sort(inside);  // of those with the same image the highest is kept
    for (const auto& [depth, point] : inside) insert(point->particle, point->barycentric);
  }

  void insert_segments(const std::function<Vector3d(int)>& position, const std::function<int(const VirtualParticle&)>& add) {
    std::vector<std::pair<const FaceSegment*, Planar::Constraint_id>> constraints;
    for (const FaceSegment& segment : hit_.segments) {
      const Vertex from = vertices_.at(segment.ends[0]), to = vertices_.at(segment.ends[1]);
      if (from != to) constraints.emplace_back(&segment, planar_.insert_constraint(from, to));
    }
    std::map<Vertex, VirtualParticle> crossings;
    std::vector<Vertex> order;
    for (const auto& [segment, constraint] : constraints)
      for (const Vertex& vertex : planar_.vertices_in_constraint(constraint)) {
        if (numbers_.contains(vertex)) continue;
        const VirtualParticle lifted = lift_to(*segment, vertex, position);
        const auto [found, is_new] = crossings.try_emplace(vertex, lifted);
        if (is_new) order.push_back(vertex);
        if (height(lifted.position) > height(found->second.position)) found->second = lifted;
      }
    for (const Vertex& vertex : order) numbers_[vertex] = add(crossings.at(vertex));
  }

  std::vector<std::array<int, 3>> triangles() const {
    std::set<Planar::Face_handle> outside;
    mark_outside(planar_.infinite_face(), outside);
    std::vector<std::array<int, 3>> all;
    for (const auto& flat : planar_.finite_face_handles())
      if (!outside.contains(flat))
        all.push_back({numbers_.at(flat->vertex(0)), numbers_.at(flat->vertex(1)), numbers_.at(flat->vertex(2))});
    return all;
  }

 private:
  double height(const Vector3d& point) const { return normal_.dot(point - face_.corners[0]); }

  void insert(int number, const Vector3d& barycentric) {
    const Vector2d at = barycentric[0] * flat_[0] + barycentric[1] * flat_[1] + barycentric[2] * flat_[2];
    const Vertex vertex = planar_.insert({at.x(), at.y()});
    vertices_.emplace(number, vertex);
    numbers_.emplace(vertex, number);
  }

  VirtualParticle lift_to(const FaceSegment& segment, const Vertex& vertex,
                          const std::function<Vector3d(int)>& position) const {
    const auto from = vertices_.at(segment.ends[0])->point(), to = vertices_.at(segment.ends[1])->point();
    const auto way = to - from;
    const double part = lift((vertex->point() - from) * way / way.squared_length(), segment.ratio);
    const Vector3d begin = position(segment.ends[0]), end = position(segment.ends[1]);
    const auto& [first, last] = segment.parameters;
    return {begin + part * (end - begin), segment.edge, first + part * (last - first)};
  }

  /// Marks what is beyond the border: rounded, it may be concave.
  void mark_outside(const Planar::Face_handle& first, std::set<Planar::Face_handle>& outside) const {
    std::vector<Planar::Face_handle> ahead{first};
    while (!ahead.empty()) {
      const Planar::Face_handle flat = ahead.back();
      ahead.pop_back();
      if (!outside.insert(flat).second) continue;
      for (int k = 0; k < 3; ++k)
        if (!planar_.is_constrained({flat, k})) ahead.push_back(flat->neighbor(k));
    }
  }

  const BareFace& face_;
  const HitFace& hit_;
  Vector3d normal_;
  std::array<Vector2d, 3> flat_;
  Planar planar_;
  std::map<int, Vertex> vertices_;
  std::map<Vertex, int> numbers_;  ///< looked up only: addresses have no order that lasts
};

}  // namespace

std::vector<std::array<int, 3>> triangulate(const BareFace& face, const HitFace& hit,
                                            const std::function<Vector3d(int)>& position,
                                            const std::function<int(const VirtualParticle&)>& add) {
  FlatFace flat(face, hit);
  flat.insert_points(position);
  flat.insert_segments(position, add);
  return flat.triangles();
}

}  // namespace drape::model
