#include "model/collision/cloth_pairs.hpp"

#include <algorithm>

namespace drape::model {
namespace {

solver::PairContact::Points nearest_points(const Proximity& pair) { return {pair.weights, pair.normal, pair.distance}; }

}  // namespace

ClothPairs::ClothPairs(const ClothSurface& surface, const ContactRule& rule, std::span<const ObstacleRule> bodies,
                       solver::Counters& work)
    : bodies_(surface, bodies, work), rule_(rule) {
  if (rule.thickness > 0) self_.emplace(surface, work);
}

void ClothPairs::begin(double t, double h) { bodies_.begin(t, h); }

void ClothPairs::find(const Vectors& x0, const Vectors& x1, double part, std::vector<solver::PairContact>& found) {
  std::vector<solver::PairContact> all;
  const auto add = [&](const Approach& approach, double keeps, double friction) {
    all.push_back({approach.begin.particles, approach.kind == PairKind::edge_edge, nearest_points(approach.begin),
                   nearest_points(approach.touch), keeps, friction});
  };
  if (self_) {
    self_->find(x0, x1, part * rule_.thickness, approaches_);
    for (const Approach& approach : approaches_) add(approach, rule_.thickness, rule_.self_friction);
  }
  bodies_.find(x0, x1, part * rule_.distance,
               [&](const Approach& approach, double friction) { add(approach, rule_.distance, friction); });
  std::ranges::sort(all, {}, &solver::PairContact::order);
  const std::vector<char> redundant = on_borders(all, &solver::PairContact::touch);
  found.clear();
  for (std::size_t k = 0; k < all.size(); ++k)
    if (!redundant[k]) found.push_back(all[k]);
}

void ClothPairs::renew(const Vectors& x, std::vector<solver::PairContact>& pairs) const {
  for (solver::PairContact& pair : pairs) {
    const PairKind kind = pair.edges ? PairKind::edge_edge : PairKind::vertex_face;
    FourPoints points;
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Index body = pair.particles[k] - x.rows();
      points[k] = body < 0 ? x.row(pair.particles[k]) : bodies().end.row(body);
    }
    pair.begin = nearest_points(proximity(kind, points));
  }
}

}  // namespace drape::model
