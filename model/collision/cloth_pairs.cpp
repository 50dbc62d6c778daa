#include "model/collision/cloth_pairs.hpp"

#include <algorithm>
#include <utility>

namespace drape::model {
namespace {

solver::PairContact::Points nearest_points(const Proximity& pair) { return {pair.weights, pair.normal, pair.distance}; }

}  // namespace

ClothPairs::ClothPairs(ClothSurface surface, double thickness, double friction, solver::Counters& work)
    : contacts_(std::move(surface), work), thickness_(thickness), friction_(friction) {}

void ClothPairs::find(const Vectors& x0, const Vectors& x1, double distance, std::vector<solver::PairContact>& found) {
  contacts_.find(x0, x1, distance, approaches_);
  std::vector<solver::PairContact> all;
  for (const Approach& approach : approaches_)
    all.push_back({approach.begin.particles, approach.kind == PairKind::edge_edge, nearest_points(approach.begin),
                   nearest_points(approach.touch)});
  std::ranges::sort(all, {}, &solver::PairContact::order);
  const std::vector<char> redundant = on_borders(all, &solver::PairContact::touch);
  found.clear();
  for (std::size_t k = 0; k < all.size(); ++k)
    if (!redundant[k]) found.push_back(all[k]);
}

void ClothPairs::renew(const Vectors& x, std::vector<solver::PairContact>& pairs) const {
  for (solver::PairContact& pair : pairs) {
    const PairKind kind = pair.edges ? PairKind::edge_edge : PairKind::vertex_face;
    pair.begin = nearest_points(proximity(kind, points_of(pair.particles, x)));
  }
}

}  // namespace drape::model
