#include <memory>

#include "model/forces/spring_blocks.hpp"
#include "model/forces/term.hpp"
#include "model/sheet/cells.hpp"

namespace drape::model {

/// Tension: σ = k ε, ε = |d|/l − 1 along every edge [Etzmuß 2002, (2.20), Alg. 1]; E = Σ ½ k ε² l w with the strip's width
/// w, half on borders. K takes k w/l (x_j − x_i), the explicit remainder is −k w (x_j − x_i)° [(3.18)].
std::optional<Term> make_tension(const Sheet& sheet) {
  const Material& m = sheet.material;
  const WeftWarp k{m.weft_curve.given() ? 0 : m.tension.weft, m.warp_curve.given() ? 0 : m.tension.warp};
  if (!k.any() || by_tables(m)) return {};
  const auto all = std::make_shared<const std::vector<Edge>>(edges(sheet.grid));

  Term term;
  term.law.edge = {.spring = k, .preload = k};
  term.energy = [=](const Vectors& x) {
    double energy = 0;
    for (const Edge& edge : *all) {
      const double strain = (x.row(edge.j) - x.row(edge.i)).norm() / edge.length - 1;
      energy += 0.5 * along(k, edge) * strain * strain * edge.length * edge.width;
    }
    return energy;
  };
  // The mean of k (|d|/l − 1) d° is k (1/l − 2/(|d0| + |d1|)) (d0 + d1)/2.
  term.mean_excess = [=](const Vectors& x0, const Vectors& x1, Vectors& f) {
    for (const Edge& edge : *all) {
      const EdgeEnds ends{edge.i, edge.j};
      const Eigen::Vector3d d0 = difference(x0, ends), d1 = difference(x1, ends), middle = 0.5 * (d0 + d1);
      const double excess = 1 / middle.norm() - 2 / (d0.norm() + d1.norm());
      add_pull(f, ends, along(k, edge) * edge.width * excess * middle);
    }
  };
  term.list_constraints = [=](std::vector<solver::CompliantConstraint>& constraints) {
    for (const Edge& edge : *all)
      if (along(k, edge) > 0)
        constraints.push_back({solver::CompliantConstraint::Kind::distance,
                               {edge.i, edge.j, edge.j},
                               edge.length,
                               edge.length / (along(k, edge) * edge.width)});
  };
  term.jacobian = [=](const Configuration& c, const JacobianEntries& entries) {
    for (const Edge& edge : *all) {
      if (entries.skips(edge.i, edge.j, 4, 0)) continue;
      const Eigen::Vector3d d = c.x.row(edge.j) - c.x.row(edge.i);
      const EdgeEnds ends{edge.i, edge.j};
      add_edge_pair(entries.add_dx, ends, ends, along(k, edge) * edge.width * tension_block(d, edge.length, entries.exact()));
    }
  };
  term.jacobian_in_threads = true;
  return term;
}

}  // namespace drape::model
