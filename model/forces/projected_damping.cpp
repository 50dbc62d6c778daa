#include <cmath>
#include <memory>

#include "model/edges.hpp"

namespace drape::model {

/// Viscous tension: σ = d ε̇, ε̇ = <v_j − v_i, n>/l along every edge with n = (x_j − x_i)° [Etzmuß 2002, (2.28), Alg. 1].
std::optional<Term> make_projected_damping(const Sheet& sheet) {
  const WeftWarp d = sheet.material.damping;
  if (!d.any() || sheet.material.damping_form != DampingForm::projected) return {};
  const double lu = sheet.grid.spacing_u(), lv = sheet.grid.spacing_v();
  const auto sweep = std::make_shared<EdgeSweep>(sheet.grid);
  const auto all = std::make_shared<const std::vector<Edge>>(edges(sheet.grid));

  Term term;
  term.force = [=](const Configuration& c, Vectors& f) {
    (*sweep)(f, [&](const EdgeSweep::Line& line, double* __restrict g) {
      const double weight = line.weft ? d.weft / lu : d.warp / lv;
      const double *const xi = c.x.data() + 3 * line.i, *const xj = c.x.data() + 3 * line.j;
      const double *const vi = c.v.data() + 3 * line.i, *const vj = c.v.data() + 3 * line.j;
      for (int e = 0; e < line.count; ++e) {
        const double p0 = xj[3 * e] - xi[3 * e], q0 = vj[3 * e] - vi[3 * e];
        const double p1 = xj[3 * e + 1] - xi[3 * e + 1], q1 = vj[3 * e + 1] - vi[3 * e + 1];
        const double p2 = xj[3 * e + 2] - xi[3 * e + 2], q2 = vj[3 * e + 2] - vi[3 * e + 2];
        const double s = weight * line.widths[e] * (p0 * q0 + p1 * q1 + p2 * q2) / (p0 * p0 + p1 * p1 + p2 * p2);
        g[3 * e] = s * p0;
        g[3 * e + 1] = s * p1;
        g[3 * e + 2] = s * p2;
      }
    });
  };
  term.explicit_force = term.force;
  term.jacobian = [=](const Configuration& c, const JacobianEntries& entries) {
    for (const Edge& edge : *all) {
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
