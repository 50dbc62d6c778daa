#include <array>
#include <memory>

#include "model/cells.hpp"

namespace drape::model {
namespace {

/// The corners of a cell as pairs of one edge p along u and one edge q along v: the quadrants of its particles.
std::array<std::pair<EdgeEnds, EdgeEnds>, 4> quadrants(const Cell& cell) {
  return {
      {{cell.lower(), cell.left()}, {cell.lower(), cell.right()}, {cell.upper(), cell.left()}, {cell.upper(), cell.right()}}};
}

/// Forces of a line of cells on their corners, which follow each other at distance 3 from x; `up` reaches the line above.
/// κ, κ_d: elastic and viscous stress a unit of <p, q> and of its rate.
struct ShearLine {
  int count;
  std::ptrdiff_t up;
  double kappa, kappa_d;
};

template <bool viscous>
void shear_line(const ShearLine& line, const double* x, const double* v, double* __restrict g) {
  const int n = 3 * line.count;
  double* __restrict g00 = g;
  double* __restrict g10 = g + n;
  double* __restrict g01 = g + 2 * n;
  double* __restrict g11 = g + 3 * n;
  const double *const x1 = x + line.up, *const v1 = v + line.up;
  for (int e = 0; e < n; e += 3) {
    double a[3], b[3], c[3], d[3];
    double ac = 0, ad = 0, bc = 0, bd = 0;
    for (int m = 0; m < 3; ++m) {
      a[m] = x[e + 3 + m] - x[e + m];
      b[m] = x1[e + 3 + m] - x1[e + m];
      c[m] = x1[e + m] - x[e + m];
      d[m] = x1[e + 3 + m] - x[e + 3 + m];
      ac += a[m] * c[m];
      ad += a[m] * d[m];
      bc += b[m] * c[m];
      bd += b[m] * d[m];
    }
    ac *= line.kappa;
    ad *= line.kappa;
    bc *= line.kappa;
    bd *= line.kappa;
    if constexpr (viscous)
      for (int m = 0; m < 3; ++m) {
        const double va = v[e + 3 + m] - v[e + m], vb = v1[e + 3 + m] - v1[e + m];
        const double vc = v1[e + m] - v[e + m], vd = v1[e + 3 + m] - v[e + 3 + m];
        ac += line.kappa_d * (va * c[m] + a[m] * vc);
        ad += line.kappa_d * (va * d[m] + a[m] * vd);
        bc += line.kappa_d * (vb * c[m] + b[m] * vc);
        bd += line.kappa_d * (vb * d[m] + b[m] * vd);
      }
    for (int m = 0; m < 3; ++m) {
      const double ga = ac * c[m] + ad * d[m], gb = bc * c[m] + bd * d[m];
      const double gc = ac * a[m] + bc * b[m], gd = ad * a[m] + bd * b[m];
      g00[e + m] = ga + gc;
      g10[e + m] = gd - ga;
      g01[e + m] = gb - gc;
      g11[e + m] = -gb - gd;
    }
  }
}

/// Derivatives of the pulls g_p = s q, g_q = s p with s = κ <p, q> + κ_d (<ṗ, q> + <p, q̇>).
void quadrant_jacobian(const Configuration& c, EdgeEnds P, EdgeEnds Q, double kappa, double kappa_d,
                       const JacobianEntries& entries) {
  const Eigen::Vector3d p = difference(c.x, P), q = difference(c.x, Q);
  const Eigen::Vector3d dp = difference(c.v, P), dq = difference(c.v, Q);
  const double s = kappa * p.dot(q) + kappa_d * (dp.dot(q) + p.dot(dq));
  const double turned = entries.exact() ? 1 : 0;  // what is left out otherwise is indefinite or not symmetric
  const Eigen::Vector3d ds_dp = kappa * q + turned * kappa_d * dq, ds_dq = kappa * p + turned * kappa_d * dp;
  const Eigen::Matrix3d sI = turned * s * Eigen::Matrix3d::Identity();
  const auto &dx = entries.add_dx, &dv = entries.add_dv;
  add_edge_pair(dx, P, P, q * ds_dp.transpose());
  add_edge_pair(dx, P, Q, sI + q * ds_dq.transpose());
  add_edge_pair(dx, Q, P, sI + p * ds_dp.transpose());
  add_edge_pair(dx, Q, Q, p * ds_dq.transpose());
  if (kappa_d == 0) return;
  add_edge_pair(dv, P, P, kappa_d * q * q.transpose());
  add_edge_pair(dv, P, Q, kappa_d * q * p.transpose());
  add_edge_pair(dv, Q, P, kappa_d * p * q.transpose());
  add_edge_pair(dv, Q, Q, kappa_d * p * p.transpose());
}

}  // namespace

/// Conservative shear: W = ½ G <s_u, s_v>² with the viscous stress dG d/dt <s_u, s_v>. Every particle evaluates it in its
/// quadrants, each with the weight l_u l_v/4 and the one-sided differences of its two edges, so that borders are no special
/// case; a cell holds one quadrant of each of its corners.
std::optional<Term> make_shear(const Sheet& sheet) {
  const Material& m = sheet.material;
  const Grid grid = sheet.grid;
  if ((m.shear == 0 && m.shear_damping == 0) || m.shear_form != ShearForm::conservative) return {};
  if (grid.nu < 2 || grid.nv < 2) return {};  // a chain has no angle
  const double area = grid.spacing_u() * grid.spacing_v();
  const ShearLine line{grid.nu - 1, 3 * static_cast<std::ptrdiff_t>(grid.nu), m.shear / (4 * area),
                       m.shear_damping / (4 * area)};
  const auto pull = std::make_shared<std::vector<double>>(12 * static_cast<std::size_t>(line.count));
  const auto all = std::make_shared<const std::vector<Cell>>(cells(grid));

  Term term;
  term.force = [=](const Configuration& c, Vectors& f) {
    const auto kernel = line.kappa_d != 0 ? shear_line<true> : shear_line<false>;
    const int n = 3 * line.count;
    for (int b = 0; b + 1 < grid.nv; ++b) {
      const std::ptrdiff_t first = 3 * static_cast<std::ptrdiff_t>(grid.index(0, b));
      kernel(line, c.x.data() + first, c.v.data() + first, pull->data());
      const std::ptrdiff_t corner[] = {first, first + 3, first + line.up, first + line.up + 3};
      for (int k = 0; k < 4; ++k)
        Eigen::Map<Eigen::ArrayXd>(f.data() + corner[k], n) += Eigen::Map<const Eigen::ArrayXd>(pull->data() + k * n, n);
    }
  };
  term.explicit_force = term.force;
  term.energy = [=](const Vectors& x) {
    double energy = 0;
    for (const Cell& cell : *all)
      for (const auto& [p, q] : quadrants(cell)) {
        const double pq = difference(x, p).dot(difference(x, q));
        energy += 0.5 * line.kappa * pq * pq;
      }
    return energy;
  };
  term.jacobian = [=](const Configuration& c, const JacobianEntries& entries) {
    if (entries.curvature == Curvature::lean) return;
    for (const Cell& cell : *all)
      for (const auto& [p, q] : quadrants(cell)) quadrant_jacobian(c, p, q, line.kappa, line.kappa_d, entries);
  };
  return term;
}

}  // namespace drape::model
