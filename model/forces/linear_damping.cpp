#include <memory>

#include "model/forces/term.hpp"
#include "model/sheet/edges.hpp"

namespace drape::model {

/// Linear damping d w/l (v_j − v_i) along every edge [Etzmuß 2002, (3.18)]: all of it is D v. It also damps transverse motion
/// and rigid rotation.
std::optional<Term> make_linear_damping(const Sheet& sheet) {
  const WeftWarp d = sheet.material.damping;
  if (!d.any() || sheet.material.damping_form != DampingForm::linear) return {};
  const double lu = sheet.grid.spacing_u(), lv = sheet.grid.spacing_v();
  const auto all = std::make_shared<const std::vector<Edge>>(edges(sheet.grid));

  Term term;
  term.law = {.weft = {.drag = d.weft / lu}, .warp = {.drag = d.warp / lv}};
  term.jacobian = [=](const Configuration&, const JacobianEntries& entries) {
    for (const Edge& edge : *all) {
      const EdgeEnds ends{edge.i, edge.j};
      add_edge_pair(entries.add_dv, ends, ends, along(d, edge) * edge.width / edge.length * Eigen::Matrix3d::Identity());
    }
  };
  term.damping = [=](std::vector<Eigen::Triplet<double>>& D) {
    for (const Edge& edge : *all)
      if (along(d, edge) != 0) add_spring(D, edge.i, edge.j, along(d, edge) * edge.width / edge.length);
  };
  return term;
}

}  // namespace drape::model
