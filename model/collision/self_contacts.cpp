#include "model/collision/self_contacts.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "model/collision/approach.hpp"
#include "model/collision/exact_intersection.hpp"
#include "model/collision/face_distance.hpp"

namespace drape::model {
namespace {

using Eigen::Array3d;
using Eigen::Vector3d;

/// Whether a pair stays farther apart than `reach` on a way from x on, as seen along the line between both middles: points that
/// move uniformly are farthest along one direction at the beginning or at the end.
bool stays_apart(PairKind kind, const std::array<int, 4>& particles, const Vectors& x, const Vectors& way, double reach) {
  const FourPoints begin = points_of(particles, x);
  const auto& [a, b, c, d] = begin;
  const bool has_edges = kind == PairKind::edge_edge;
  const Vector3d axis = has_edges ? Vector3d(a + b - c - d) : Vector3d(3 * a - b - c - d);
  Eigen::Array4d first, last;
  for (int k = 0; k < 4; ++k) {
    first[k] = axis.dot(begin[k]);
    last[k] = first[k] + axis.dot(way.row(particles[k]));
  }
  const auto gap = [&](const Eigen::Array4d& height) {
    return has_edges ? std::min(height[0], height[1]) - std::max(height[2], height[3])
                     : height[0] - std::max({height[1], height[2], height[3]});
  };
  const double least = std::min(gap(first), gap(last));
  return least > 0 && least * least > reach * reach * axis.squaredNorm();
}

}  // namespace

SelfContacts::SelfContacts(ClothSurface surface, solver::Counters& work)
    : surface_(std::move(surface)),
      tree_(surface_.centres()),
      boxes_(surface_.faces().size()),
      pairs_(work.counter("self_pairs", "pairs of a vertex and a face or two edges whose distance was computed")) {}

void SelfContacts::fit(const Vectors& x, double reach) {
  const Vector3d margin = Vector3d::Constant(reach / 2);
  for (std::size_t k = 0; k < boxes_.size(); ++k) {
    Eigen::AlignedBox3d& box = boxes_[k];
    box.setEmpty();
    for (const int i : surface_.faces()[k].corners) {
      const Vector3d begin = x.row(i), end = begin + way_.row(i).transpose();
      box.extend(begin).extend(end);
    }
    box = {box.min() - margin, box.max() + margin};
  }
  tree_.refit(boxes_);
}

template <class Visit>
void SelfContacts::each_pair(const Vectors& x, double reach, const Visit& visit) {
  fit(x, reach);
  const auto meet = [&](PairKind kind, const std::array<int, 4>& particles, bool may_end) {
    if (!stays_apart(kind, particles, x, way_, reach)) visit(kind, particles, may_end);
  };
  const auto joined = [&](int i, int j) { return surface_.joined_nodes(i, j); };
  const auto vertices_and_face = [&](const ClothSurface::Face& one, const ClothSurface::Face& other) {
    const auto [a, b, c] = other.corners;
    if (other.is_edge()) return;
    for (const int v : one.vertices) {
      if (v < 0) return;
      if (!joined(v, a) && !joined(v, b) && !joined(v, c)) meet(PairKind::vertex_face, {v, a, b, c}, false);
    }
  };
  tree_.overlapping_pairs([&](int i, int j) {
    const ClothSurface::Face &one = surface_.faces()[i], &other = surface_.faces()[j];
    vertices_and_face(one, other);
    vertices_and_face(other, one);
    for (const int e : one.edges) {
      if (e < 0) break;
      for (const int f : other.edges) {
        if (f < 0) break;
        const ClothSurface::Edge &lower = surface_.edges()[std::min(e, f)], &higher = surface_.edges()[std::max(e, f)];
        const auto [a, b] = lower.ends;
        const auto [c, d] = higher.ends;
        if (!joined(a, c) && !joined(a, d) && !joined(b, c) && !joined(b, d))
          meet(PairKind::edge_edge, {a, b, c, d}, !lower.has_face || !higher.has_face);
      }
    }
  });
}

void SelfContacts::find(const Vectors& x0, const Vectors& x1, double distance, std::vector<Approach>& found) {
  found.clear();
  way_ = x1 - x0;
  const Eigen::RowVector3d common = way_.colwise().mean();
  way_.rowwise() -= common;
  each_pair(x0, reached(distance), [&](PairKind kind, const std::array<int, 4>& particles, bool may_end) {
    ++pairs_;
    const FourPoints begin = points_of(particles, x0), end = points_of(particles, x1);
    const std::optional<double> part = first_approach(kind, begin, end, distance);
    if (!part) return;
    const Proximity nearest = proximity(kind, particles, begin);
    Approach approach{kind, nearest, nearest, *part};
    if (*part > 0) approach.touch = proximity(kind, particles, points_between(begin, end, *part));
    const Proximity last = proximity(kind, particles, end);
    if (last.is_inside() && last.normal.dot(approach.touch.normal) > 0) approach.touch = last;
    if (kind == PairKind::edge_edge && !may_end && !approach.touch.is_inside()) return;
    if (nearest.distance < distance && last.distance >= distance && !first_approach(kind, begin, end, 0.999 * nearest.distance))
      return;
    found.push_back(approach);
  });
}

void SelfContacts::near(const Vectors& x, double distance, std::vector<Proximity>& found) {
  found.clear();
  way_.setZero(x.rows(), 3);
  each_pair(x, distance, [&](PairKind kind, const std::array<int, 4>& particles, bool may_end) {
    ++pairs_;
    const Proximity pair = proximity(kind, particles, points_of(particles, x));
    if (pair.distance < distance && (kind == PairKind::vertex_face || may_end || pair.is_inside())) found.push_back(pair);
  });
}

template <class Visit>
void SelfContacts::each_face_pair(const Vectors& x, double reach, const Visit& visit) {
  way_.setZero(x.rows(), 3);
  fit(x, reach);
  tree_.overlapping_pairs([&](int i, int j) {
    if (!surface_.faces()[i].is_edge() && !surface_.faces()[j].is_edge() && !surface_.joined(i, j))
      visit(i, j, surface_.corners(i, x), surface_.corners(j, x));
  });
}

std::vector<std::array<int, 2>> SelfContacts::intersections(const Vectors& x) {
  std::vector<std::array<int, 2>> all;
  each_face_pair(x, 0, [&](int i, int j, const Corners& one, const Corners& other) {
    if (intersect(one, other)) all.push_back({i, j});
  });
  return all;
}

int SelfContacts::face_pairs(const Vectors& x, double distance) {
  int count = 0;
  each_face_pair(x, distance,
                 [&](int, int, const Corners& one, const Corners& other) { count += nearer(one, other, distance) ? 1 : 0; });
  return count;
}

}  // namespace drape::model
