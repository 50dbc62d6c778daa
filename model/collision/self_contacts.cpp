#include "model/collision/self_contacts.hpp"

#include <algorithm>
#include <atomic>
#include <optional>
#include <utility>

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
  const auto box_of = [&](const ClothSurface::Face& face) {
    Eigen::AlignedBox3d box;
    for (const int i : face.corners) {
      const Vector3d begin = x.row(i), end = begin + way_.row(i).transpose();
      box.extend(begin).extend(end);
    }
    return Eigen::AlignedBox3d(box.min() - margin, box.max() + margin);
  };
  base::each_in_parts(base::threads_for(x.rows()), std::ssize(boxes_),
                      [&](std::int64_t k) { boxes_[k] = box_of(surface_.faces()[k]); });
  tree_.refit(boxes_);
}

template <class Visit>
void SelfContacts::each_pair(std::int64_t begin, std::int64_t end, const Vectors& x, double reach, const Visit& visit) const {
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
  tree_.overlapping_pairs(begin, end, [&](int i, int j) {
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

template <class Found, class Compute>
void SelfContacts::find_pairs(const Vectors& x, double reach, base::Collector<Found>& collect, std::vector<Found>& found,
                              const Compute& compute) {
  constexpr int as_particles = 20;  // a face takes that many times as long as the forces on a particle
  found.clear();
  fit(x, reach);
  std::atomic<std::int64_t> pairs = 0;
  collect(base::threads_for(as_particles * std::ssize(boxes_)), tree_.nodes(), found,
          [&](std::int64_t begin, std::int64_t end, std::vector<Found>& part) {
            std::int64_t computed = 0;
            each_pair(begin, end, x, reach, [&](PairKind kind, const std::array<int, 4>& particles, bool may_end) {
              ++computed;
              if (const std::optional<Found> pair = compute(kind, particles, may_end)) part.push_back(*pair);
            });
            pairs += computed;
          });
  pairs_ += pairs;
}

void SelfContacts::find(const Vectors& x0, const Vectors& x1, double distance, std::vector<Approach>& found) {
  way_ = x1 - x0;
  const Eigen::RowVector3d common = way_.colwise().mean();
  way_.rowwise() -= common;
  find_pairs(x0, reached(distance), collect_approaches_, found,
             [&](PairKind kind, const std::array<int, 4>& particles, bool may_end) {
               return approach(kind, particles, x0, x1, distance, may_end);
             });
}

void SelfContacts::near(const Vectors& x, double distance, std::vector<Proximity>& found) {
  way_.setZero(x.rows(), 3);
  find_pairs(x, distance, collect_proximities_, found, [&](PairKind kind, const std::array<int, 4>& particles, bool may_end) {
    const Proximity pair = proximity(kind, particles, points_of(particles, x));
    const bool is_near = pair.distance < distance && (kind == PairKind::vertex_face || may_end || pair.is_inside());
    return is_near ? std::optional(pair) : std::nullopt;
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
