#include "model/adaptive/face_triangulation.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <memory_resource>
#include <unordered_map>
#include <utility>

#include "model/adaptive/face_projection.hpp"

namespace drape::model {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
struct VertexLabel {
  int number = -1;  ///< −1: segments cross here
};
struct FaceLabel {
  bool outside = false;
};
using FlatKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using LabelledStructure = CGAL::Triangulation_data_structure_2<
    CGAL::Triangulation_vertex_base_with_info_2<VertexLabel, FlatKernel>,
    CGAL::Triangulation_face_base_with_info_2<FaceLabel, FlatKernel, CGAL::Constrained_triangulation_face_base_2<FlatKernel>>>;
using Planar = CGAL::Constrained_Delaunay_triangulation_2<FlatKernel, LabelledStructure, CGAL::Exact_predicates_tag>;
using Vertex = Planar::Vertex_handle;

/// One face while it is triangulated.
class FlatFace {
 public:
  FlatFace(const BareFace& face, const HitFace& hit) : face_(face), hit_(hit), normal_(face_normal(face.corners)) {
    const auto& [a, b, c] = face.corners;
    const Vector3d along = (b - a).normalized(), across = normal_.cross(along);
    for (int k = 0; k < 3; ++k) flat_[k] = {along.dot(face.corners[k] - a), across.dot(face.corners[k] - a)};
    constexpr double beside = 1e-4;
    const auto is_beside = [](const FacePoint& point) {
      return point.barycentric.minCoeff() > 0 && point.barycentric.minCoeff() < beside;
    };
    bulge_ = std::ranges::any_of(hit.points, is_beside) ? 0 : 1e-6;
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
    std::ranges::sort(inside, {}, [](const auto& point) { return std::pair(point.first, point.second->particle); });
    for (const auto& [depth, point] : inside) insert(point->particle, point->barycentric);
  }

  void insert_segments() {
    for (const FaceSegment& segment : hit_.segments) {
      const Vertex from = vertices_.at(segment.ends[0]), to = vertices_.at(segment.ends[1]);
      if (from != to) planar_.insert_constraint(from, to);
    }
  }

  void add_crossings(const std::function<Vector3d(int)>& position, const std::function<int(const VirtualParticle&)>& add) {
    for (const Vertex vertex : planar_.finite_vertex_handles())
      if (vertex->info().number < 0) vertex->info().number = add(crossing(vertex, position));
  }

  std::vector<std::array<int, 3>> triangles() const {
    mark_outside();
    std::vector<std::array<int, 3>> all;
    for (const auto& flat : planar_.finite_face_handles())
      if (!flat->info().outside)
        all.push_back({flat->vertex(0)->info().number, flat->vertex(1)->info().number, flat->vertex(2)->info().number});
    return all;
  }

 private:
  double height(const Vector3d& point) const { return normal_.dot(point - face_.corners[0]); }

  /// If another particle has this place that one is kept.
  void insert(int number, const Vector3d& barycentric) {
    Vector2d at = barycentric[0] * flat_[0] + barycentric[1] * flat_[1] + barycentric[2] * flat_[2];
    for (int k = 0; k < 3; ++k)
      if (barycentric[k] == 0) at += bulge_ * barycentric[(k + 1) % 3] * barycentric[(k + 2) % 3] * (at - flat_[k]);
    const Vertex vertex = planar_.insert({at.x(), at.y()});
    vertices_.emplace(number, vertex);
    if (vertex->info().number < 0) vertex->info().number = number;
  }

  /// The point on the highest of the segments that cross at a vertex, where it is rounded.
  VirtualParticle crossing(const Vertex& vertex, const std::function<Vector3d(int)>& position) const {
    constexpr double rounding = 1e-12;  // [m]
    std::vector<std::pair<double, VirtualParticle>> lifted;
    for (const FaceSegment& segment : hit_.segments) {
      const auto from = vertices_.at(segment.ends[0])->point(), to = vertices_.at(segment.ends[1])->point();
      const auto way = to - from;
      if (from == to) continue;
      const double image = std::clamp((vertex->point() - from) * way / way.squared_length(), 0.0, 1.0);
      const double apart = std::sqrt(CGAL::squared_distance(vertex->point(), from + image * way));
      const double part = lift(image, segment.ratio);
      const Vector3d begin = position(segment.ends[0]), end = position(segment.ends[1]);
      const auto& [first, last] = segment.parameters;
      lifted.push_back({apart, {begin + part * (end - begin), segment.edge, first + part * (last - first)}});
    }
    const double nearest = std::ranges::min(lifted, {}, [](const auto& candidate) { return candidate.first; }).first;
    return std::ranges::max(lifted, {},
                            [&](const auto& candidate) {
                              return candidate.first <= nearest + rounding ? height(candidate.second.position)
                                                                           : -std::numeric_limits<double>::infinity();
                            })
        .second;
  }

  /// Marks triangles beyond the border, which is concave where points are so close that rounding is larger than the bulge.
  void mark_outside() const {
    std::vector<Planar::Face_handle> ahead{planar_.infinite_face()};
    while (!ahead.empty()) {
      const Planar::Face_handle flat = ahead.back();
      ahead.pop_back();
      if (std::exchange(flat->info().outside, true)) continue;
      for (int k = 0; k < 3; ++k)
        if (!flat->is_constrained(k)) ahead.push_back(flat->neighbor(k));
    }
  }

  const BareFace& face_;
  const HitFace& hit_;
  Vector3d normal_;
  std::array<Vector2d, 3> flat_;
  /// How far the border bulges: predicates take many times as long for points that are almost in a line. Points beside the
  /// border have to stay as they are to it.
  double bulge_;
  Planar planar_;
  std::array<std::byte, 8192> buffer_;  ///< enough for most faces
  std::pmr::monotonic_buffer_resource memory_{buffer_.data(), buffer_.size()};
  std::pmr::unordered_map<int, Vertex> vertices_{&memory_};
};

}  // namespace

std::vector<std::array<int, 3>> triangulate(const BareFace& face, const HitFace& hit,
                                            const std::function<Vector3d(int)>& position,
                                            const std::function<int(const VirtualParticle&)>& add) {
  FlatFace flat(face, hit);
  flat.insert_points(position);
  flat.insert_segments();
  flat.add_crossings(position, add);
  return flat.triangles();
}

}  // namespace drape::model
