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
      const Eigen::Vector3d p = c.x.row(edge.j) - c.x.row(edge.i);
      const Eigen::Vector3d q = c.v.row(edge.j) - c.v.row(edge.i);
      const double r = p.norm();
      const Eigen::Vector3d n = p / r;
      const Eigen::Matrix3d nn = n * n.transpose();
      const Eigen::Matrix3d P = Eigen::Matrix3d::Identity() - nn;
      const double weight = along(d, edge) * edge.width / edge.length;
      const EdgeEnds ends{edge.i, edge.j};
      add_edge_pair(entries.add_dv, ends, ends, weight * nn);
      if (!entries.exact()) continue;  // the rest is not symmetric
      add_edge_pair(entries.add_dx, ends, ends, weight / r * (n * (P * q).transpose() + q.dot(n) * P));
    }
  };
  return term;
}

}  // namespace drape::model
