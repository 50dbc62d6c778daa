#include <algorithm>
#include <memory>

#include "model/forces/term.hpp"
#include "model/sheet/cells.hpp"
#include "model/sheet/edges.hpp"

namespace drape::model {
namespace {

/// A particle's neighbours as Algorithm 2 takes them: the particle itself where there is none.
struct Star {
  EdgeEnds u, v;  ///< left to right, lower to upper
};

std::vector<Star> stars(const Grid& grid) {
  std::vector<Star> all;
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a)
      all.push_back({{grid.index(std::max(a - 1, 0), b), grid.index(std::min(a + 1, grid.nu - 1), b)},
                     {grid.index(a, std::max(b - 1, 0)), grid.index(a, std::min(b + 1, grid.nv - 1))}});
  return all;
}

/// Stars and their coefficients: stress κ <U, V> + κ_d (<U̇, V> + <U, V̇>), spread with the factors 1/2l.
struct Printed {
  std::vector<Star> stars;
  Eigen::VectorXd area;  ///< dual cells: the algorithm gives force densities
  double kappa, kappa_d, half_u, half_v;
};

/// ± σ/2l V° on the neighbours along u: area of the receiver times the density.
void spread(Vectors& f, EdgeEnds ends, const Eigen::VectorXd& area, const Eigen::Vector3d& density) {
  f.row(ends.begin) += area[ends.begin] * density;
  f.row(ends.end) -= area[ends.end] * density;
}

/// Blocks of the spread density, whose derivative by the edge vector r is `block`.
template <class Add>
void spread_blocks(const Add& add, EdgeEnds ends, EdgeEnds r, const Eigen::VectorXd& area, const Eigen::Matrix3d& block) {
  add(ends.begin, r.end, area[ends.begin] * block);
  add(ends.begin, r.begin, -area[ends.begin] * block);
  add(ends.end, r.end, -area[ends.end] * block);
  add(ends.end, r.begin, area[ends.end] * block);
}

void add_force(const Printed& p, const Configuration& c, Vectors& f) {
  for (const Star& star : p.stars) {
    const Eigen::Vector3d U = difference(c.x, star.u), V = difference(c.x, star.v);
    const Eigen::Vector3d dU = difference(c.v, star.u), dV = difference(c.v, star.v);
    const double sigma = p.kappa * U.dot(V) + p.kappa_d * (dU.dot(V) + U.dot(dV));
    spread(f, star.u, p.area, sigma * p.half_u * V.normalized());
    spread(f, star.v, p.area, sigma * p.half_v * U.normalized());
  }
}

void add_jacobian(const Printed& p, const Configuration& c, const JacobianEntries& entries) {
  if (!entries.exact()) return;  // not symmetric
  const auto &dx = entries.add_dx, &dv = entries.add_dv;
  for (const Star& star : p.stars) {
    const Eigen::Vector3d U = difference(c.x, star.u), V = difference(c.x, star.v);
    const Eigen::Vector3d dU = difference(c.v, star.u), dV = difference(c.v, star.v);
    const Eigen::Vector3d nu = U.normalized(), nv = V.normalized();
    const double sigma = p.kappa * U.dot(V) + p.kappa_d * (dU.dot(V) + U.dot(dV));
    const Eigen::Vector3d by_U = p.kappa * V + p.kappa_d * dV, by_V = p.kappa * U + p.kappa_d * dU;
    const Eigen::Matrix3d turn_u = sigma / U.norm() * (Eigen::Matrix3d::Identity() - nu * nu.transpose());
    const Eigen::Matrix3d turn_v = sigma / V.norm() * (Eigen::Matrix3d::Identity() - nv * nv.transpose());
    spread_blocks(dx, star.u, star.u, p.area, p.half_u * nv * by_U.transpose());
    spread_blocks(dx, star.u, star.v, p.area, p.half_u * (nv * by_V.transpose() + turn_v));
    spread_blocks(dx, star.v, star.u, p.area, p.half_v * (nu * by_U.transpose() + turn_u));
    spread_blocks(dx, star.v, star.v, p.area, p.half_v * nu * by_V.transpose());
    if (p.kappa_d == 0) continue;
    spread_blocks(dv, star.u, star.u, p.area, p.half_u * p.kappa_d * nv * V.transpose());
    spread_blocks(dv, star.u, star.v, p.area, p.half_u * p.kappa_d * nv * U.transpose());
    spread_blocks(dv, star.v, star.u, p.area, p.half_v * p.kappa_d * nu * V.transpose());
    spread_blocks(dv, star.v, star.v, p.area, p.half_v * p.kappa_d * nu * U.transpose());
  }
}

}  // namespace

/// Shear as printed: σ12 = G <(x_right − x_left)/2l, (x_upper − x_lower)/2l>, along unit vectors, missing neighbours replaced
/// by the particle itself [Etzmuß 2002, Alg. 2]. Not the gradient of an energy, and inconsistent at borders: for comparison
/// only.
std::optional<Term> make_printed_shear(const Sheet& sheet) {
  const Material& m = sheet.material;
  const Grid& grid = sheet.grid;
  if ((m.shear == 0 && m.shear_damping == 0) || m.shear_form != ShearForm::printed) return {};
  if (grid.nu < 2 || grid.nv < 2) return {};  // a chain has no angle
  const double lu = grid.spacing_u(), lv = grid.spacing_v();
  Printed printed{stars(grid),  grid.cell_areas(), m.shear / (4 * lu * lv), m.shear_damping / (4 * lu * lv),
                  1 / (2 * lu), 1 / (2 * lv)};
  const auto shared = std::make_shared<const Printed>(std::move(printed));

  Term term;
  term.force = [shared](const Configuration& c, Vectors& f) { add_force(*shared, c, f); };
  term.active = true;
  term.without_energy = m.shear != 0;
  term.jacobian = [shared](const Configuration& c, const JacobianEntries& entries) { add_jacobian(*shared, c, entries); };
  return term;
}

}  // namespace drape::model
