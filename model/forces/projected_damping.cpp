#include "model/forces/spring_blocks.hpp"
#include "model/forces/term.hpp"
#include "model/sheet/edges.hpp"

namespace drape::model {

/// Viscous tension: σ = d ε̇, ε̇ = <v_j − v_i, n>/l along every edge with n = (x_j − x_i)° [Etzmuß 2002, (2.28), Alg. 1].
std::optional<Term> make_projected_damping(const Sheet& sheet) {
  const WeftWarp d = sheet.material.damping;
  if (!d.any() || sheet.material.damping_form != DampingForm::projected) return {};

  Term term;
  term.law.edge.dashpot = d;
  term.jacobian = [d, all = edges(sheet.grid)](const Configuration& c, const JacobianEntries& entries) {
    for (const Edge& edge : all) {
      if (entries.skips(edge.i, edge.j, entries.exact() ? 4 : 0, 4)) continue;
      const Eigen::Vector3d p = c.x.row(edge.j) - c.x.row(edge.i);
      const Eigen::Vector3d q = c.v.row(edge.j) - c.v.row(edge.i);
      const double weight = along(d, edge) * edge.width;
      const EdgeEnds ends{edge.i, edge.j};
      add_edge_pair(entries.add_dv, ends, ends, weight * viscous_block(p, edge.length));
      if (!entries.exact()) continue;  // the rest is not symmetric
      add_edge_pair(entries.add_dx, ends, ends, weight * viscous_turn_block(p, q, edge.length));
    }
  };
  term.jacobian_in_threads = true;
  return term;
}

}  // namespace drape::model
