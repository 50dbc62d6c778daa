#include "model/collision/cloth_pairs.hpp"

#include <utility>

namespace drape::model {
namespace {

solver::PairContact::Points nearest_points(const Proximity& pair) { return {pair.weights, pair.normal, pair.distance}; }

}  // namespace

ClothPairs::ClothPairs(ClothSurface surface, double thickness, solver::Counters& work)
    : contacts_(std::move(surface), work), thickness_(thickness) {}

void ClothPairs::find(const Vectors& x0, const Vectors& x1, double distance, std::vector<solver::PairContact>& found) {
  contacts_.find(x0, x1, distance, approaches_);
  found.clear();
  for (const Approach& approach : approaches_)
    found.push_back({approach.begin.particles, approach.kind == PairKind::edge_edge, nearest_points(approach.begin),
                     nearest_points(approach.touch)});
}

void ClothPairs::renew(const Vectors& x, std::vector<solver::PairContact>& pairs) const {
  for (solver::PairContact& pair : pairs) {
    const PairKind kind = pair.edges ? PairKind::edge_edge : PairKind::vertex_face;
    pair.begin = nearest_points(proximity(kind, points_of(pair.particles, x)));
  }
}

}  // namespace drape::model
