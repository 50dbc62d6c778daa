#include <memory>

#include "model/forces/term.hpp"
#include "model/sheet/edges.hpp"

namespace drape::model {

/// Linear damping d w/l (v_j − v_i) along every edge [Etzmuß 2002, (3.18)]: all of it is D v. It also damps transverse motion
/// and rigid rotation.
std::optional<Term> make_linear_damping(const Sheet& sheet) {
  const WeftWarp d = sheet.material.damping;
  if (!d.any() || sheet.material.damping_form != DampingForm::linear) return {};

  Term term;
  term.law.edge.drag = d;
  term.jacobian = [d, all = edges(sheet.grid)](const Configuration&, const JacobianEntries& entries) {
    for (const Edge& edge : all) {
      if (entries.skips(edge.i, edge.j, 0, 4)) continue;
      const EdgeEnds ends{edge.i, edge.j};
      add_edge_pair(entries.add_dv, ends, ends, along(d, edge) * edge.width / edge.length * Eigen::Matrix3d::Identity());
    }
  };
  term.jacobian_in_threads = true;
  return term;
}

}  // namespace drape::model
