#include "model/collision/body_contacts.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace drape::model {
namespace {

using Eigen::Vector3d;

constexpr double sharp = 1e-3;  ///< sine of the angle between faces above which an edge is convex

Eigen::AlignedBox3d box_of_way(const std::array<int, 3>& corners, const Vectors& x0, const Vectors& x1, double margin) {
  Eigen::AlignedBox3d box;
  for (const int i : corners) box.extend(x0.row(i).transpose()).extend(x1.row(i).transpose());
  const Vector3d around = Vector3d::Constant(margin);
  return {box.min() - around, box.max() + around};
}

/// Edges of triangles that are convex, or the border of one: all, if the surface may deform.
std::set<std::array<int, 2>> searched_edges(const Polygons& surface, const std::vector<std::array<int, 3>>& triangles,
                                            bool is_rigid) {
  struct Side {
    Vector3d normal, opposite;
  };
  std::map<std::array<int, 2>, std::vector<Side>> sides;
  for (const std::array<int, 3>& t : triangles) {
    const Vector3d &a = surface.vertices[t[0]], &b = surface.vertices[t[1]], &c = surface.vertices[t[2]];
    const Vector3d normal = (b - a).cross(c - a).stableNormalized();
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      sides[{low, high}].push_back({normal, surface.vertices[t[(k + 2) % 3]]});
    }
  }
  std::set<std::array<int, 2>> all;
  for (const auto& [edge, both] : sides) {
    const Vector3d& on_edge = surface.vertices[edge[0]];
    const bool is_convex = both.size() != 2 || both[0].normal.dot((both[1].opposite - on_edge).stableNormalized()) < -sharp;
    if (!is_rigid || is_convex) all.insert(edge);
  }
  return all;
}

}  // namespace

BodyContacts::BodyContacts(const ClothSurface& cloth, std::span<const ObstacleRule> bodies, solver::Counters& work)
    : cloth_(cloth),
      cloth_tree_(cloth.centres()),
      body_tree_({}),
      pairs_(work.counter("body_pairs",
                          "pairs of a vertex and a face or two edges, of cloth and bodies, whose distance was computed")) {
  constexpr double no_plane = 0;
  int points = 0;
  for (const ObstacleRule& rule : bodies) {
    const int body = static_cast<int>(bodies_.size());
    bodies_.push_back({PosedObstacle(rule, no_plane), rule.friction, model::moves(rule), points});
    const Polygons surface = bodies_.back().posed.at(0);
    add_faces(surface, body, !rule.shape->moves());
    points += static_cast<int>(surface.vertices.size());
  }
  points_.begin.resize(points, 3);
  place(0, points_.begin);
  points_.end = points_.begin;
  std::vector<Vector3d> centres;
  for (const Face& face : faces_) {
    Vector3d sum = Vector3d::Zero();
    for (const int i : face.corners) sum += points_.begin.row(i).transpose();
    centres.emplace_back(sum / 3);
  }
  body_tree_ = BoxTree(centres);
  cloth_boxes_.resize(cloth.faces().size());
  body_boxes_.resize(faces_.size());
}

void BodyContacts::add_faces(const Polygons& surface, int body, bool is_rigid) {
  const std::vector<std::array<int, 3>> triangles = fan_triangles(surface);
  std::set<std::array<int, 2>> edges = searched_edges(surface, triangles, is_rigid);
  std::set<int> vertices;
  for (const auto& [low, high] : edges) vertices.insert({low, high});
  const int first = bodies_[body].first;
  for (const std::array<int, 3>& t : triangles) {  // each edge and corner goes to the first triangle that has it
    Face face{{first + t[0], first + t[1], first + t[2]}, {}, {}, body};
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      if (edges.erase({low, high}) > 0) face.edges.push_back({first + low, first + high});
      if (vertices.erase(t[k]) > 0) face.vertices.push_back(first + t[k]);
    }
    if (!face.edges.empty() || !face.vertices.empty()) faces_.push_back(std::move(face));
  }
}

void BodyContacts::place(double t, Vectors& x) const {
  std::vector<Vector3d> vertices;
  for (const Body& body : bodies_) body.posed.add_vertices(t, vertices);
  for (std::size_t i = 0; i < vertices.size(); ++i) x.row(static_cast<Eigen::Index>(i)) = vertices[i];
}

void BodyContacts::begin(double t, double h) {
  if (placed_ && std::ranges::none_of(bodies_, &Body::moves)) return;
  place(t, points_.begin);
  place(t + h, points_.end);
  placed_ = true;
  fitted_ = -1;
}

bool BodyContacts::rub() const {
  return std::ranges::any_of(bodies_, [](const Body& body) { return body.friction > 0; });
}

/// Nothing where bodies rest.
void BodyContacts::fit_bodies(double margin) {
  if (margin == fitted_) return;
  for (std::size_t k = 0; k < faces_.size(); ++k)
    body_boxes_[k] = box_of_way(faces_[k].corners, points_.begin, points_.end, margin);
  body_tree_.refit(body_boxes_);
  fitted_ = margin;
}

void BodyContacts::find(const Vectors& x0, const Vectors& x1, double distance, const Visit& visit) {
  if (faces_.empty()) return;
  const auto n = static_cast<int>(x0.rows());
  for (const auto& [joined, cloth, body] : {std::tuple(&x0_, &x0, &points_.begin), std::tuple(&x1_, &x1, &points_.end)}) {
    joined->resize(n + body->rows(), 3);
    *joined << *cloth, *body;
  }
  const double half = reached(distance) / 2;
  for (std::size_t k = 0; k < cloth_boxes_.size(); ++k) cloth_boxes_[k] = box_of_way(cloth_.faces()[k].corners, x0_, x1_, half);
  cloth_tree_.refit(cloth_boxes_);
  fit_bodies(half);
  const auto meet = [&](PairKind kind, const std::array<int, 4>& particles, double friction) {
    ++pairs_;
    if (const auto met = approach(kind, particles, x0_, x1_, distance, false)) visit(*met, friction);
  };
  cloth_tree_.overlapping_pairs(body_tree_, [&](int i, int j) {
    const ClothSurface::Face& face = cloth_.faces()[i];
    const Face& of_body = faces_[j];
    const double friction = bodies_[of_body.body].friction;
    const auto [a, b, c] = face.corners;
    if (!face.is_edge())
      for (const int v : of_body.vertices) meet(PairKind::vertex_face, {n + v, a, b, c}, friction);
    for (const int e : face.edges) {
      if (e < 0) break;
      const auto [from, to] = cloth_.edges()[e].ends;
      for (const auto& [low, high] : of_body.edges) meet(PairKind::edge_edge, {from, to, n + low, n + high}, friction);
    }
  });
}

}  // namespace drape::model
