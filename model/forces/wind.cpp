#include <cmath>
#include <cstdint>

#include "model/forces/term.hpp"
#include "model/sheet/normals.hpp"
#include "solver/base/threads.hpp"

namespace drape::model {

/// Wind f = (a + sin ωt) w on a surface: c_drag <f, N> N + c_lift (f − <f, N> N) [Etzmuß 2002, (2.35)–(2.36)], a force per
/// area. There are no lees. It depends on time, so it has no energy.
std::optional<Term> make_wind(const Sheet& sheet) {
  if (!sheet.wind.blows()) return {};
  const auto wind = [wind = sheet.wind](double t) -> Eigen::Vector3d {
    return (wind.constant + std::sin(wind.frequency * t)) * wind.load;
  };
  const Eigen::VectorXd undivided = sheet.wind.lift * sheet.grid.cell_areas();
  const Eigen::VectorXd along_normal = (sheet.wind.drag - sheet.wind.lift) * sheet.grid.cell_areas();

  Term term;
  term.needs_normals = sheet.wind.needs_normals();
  term.force = [=, divides = term.needs_normals](const Configuration& c, Vectors& f) {
    const Eigen::RowVector3d w = wind(c.t).transpose();
    base::each_in_parts(base::threads_for(f.rows()), f.rows(), [&](std::int64_t i) {
      f.row(i) += undivided[i] * w;
      if (divides) f.row(i) += along_normal[i] * c.normals.row(i).dot(w) * c.normals.row(i);
    });
  };
  term.active = true;
  if (!term.needs_normals) return term;
  term.jacobian = [=, normals = Normals(sheet.grid)](const Configuration& c, const JacobianEntries& entries) {
    if (!entries.exact()) return;  // not symmetric
    const Eigen::Vector3d w = wind(c.t);
    for (int i = 0; i < along_normal.size(); ++i) {
      const Eigen::Matrix3d by_N = along_normal[i] * projection_by_normal(w, c.normals.row(i));
      for (const auto& [j, dN] : normals.derivative(c.x, i)) entries.add_dx(i, j, by_N * dN);
    }
  };
  return term;
}

}  // namespace drape::model
