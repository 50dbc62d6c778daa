#include <memory>

#include "model/forces/term.hpp"
#include "model/sheet/cells.hpp"

namespace drape::model {
namespace {

/// Derivatives of the pulls g_p = s q, g_q = s p with s = κ <p, q> + κ_d (<ṗ, q> + <p, q̇>).
void quadrant_jacobian(const Configuration& c, EdgeEnds P, EdgeEnds Q, double kappa, double kappa_d,
                       const JacobianEntries& entries) {
  const Eigen::Vector3d p = difference(c.x, P), q = difference(c.x, Q);
  const Eigen::Vector3d dp = difference(c.v, P), dq = difference(c.v, Q);
  const double s = kappa * p.dot(q) + kappa_d * (dp.dot(q) + p.dot(dq));
  const double turned = entries.exact() ? 1 : 0;  // the terms left out otherwise are indefinite or not symmetric
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

/// Right angles of the quadrants: each at one corner of its cell, between the edges that end there.
void list_quadrants(const std::vector<Cell>& all, double compliance, std::vector<solver::CompliantConstraint>& constraints) {
  for (const Cell& cell : all)
    for (const int a : {0, 1})
      for (const int b : {0, 1})
        constraints.push_back({solver::CompliantConstraint::Kind::right_angle,
                               {cell.corner[a][b], cell.corner[1 - a][b], cell.corner[a][1 - b]},
                               0,
                               compliance});
}

}  // namespace

/// Conservative shear: W = ½ G <s_u, s_v>² with the viscous stress dG d/dt <s_u, s_v>. Every particle evaluates it in its
/// quadrants, each with the weight l_u l_v/4 and the one-sided differences of its two edges, so that borders are not a special
/// case; a cell holds one quadrant of each of its corners.
std::optional<Term> make_shear(const Sheet& sheet) {
  const Material& m = sheet.material;
  const Grid grid = sheet.grid;
  const double G = by_tables(m) ? 0 : m.shear;
  if ((G == 0 && m.shear_damping == 0) || m.shear_form != ShearForm::conservative) return {};
  if (grid.nu < 2 || grid.nv < 2) return {};  // a chain has no angle
  const double area = grid.spacing_u() * grid.spacing_v();
  const double kappa = G / (4 * area), kappa_d = m.shear_damping / (4 * area);
  const auto all = std::make_shared<const std::vector<Cell>>(cells(grid));

  Term term;
  term.law.cell = {.shear = kappa, .shear_rate = kappa_d};
  term.energy = [=](const Vectors& x) {
    double energy = 0;
    for (const Cell& cell : *all)
      for (const auto& [p, q] : quadrants(cell)) {
        const double pq = difference(x, p).dot(difference(x, q));
        energy += 0.5 * kappa * pq * pq;
      }
    return energy;
  };
  // The mean of κ <p, q> (q, p) is κ (<p0, q0> + <p1, q1>)/2 times the edges in the middle.
  term.mean_excess = [=](const Vectors& x0, const Vectors& x1, Vectors& f) {
    for (const Cell& cell : *all)
      for (const auto& [p, q] : quadrants(cell)) {
        const Eigen::Vector3d p0 = difference(x0, p), q0 = difference(x0, q);
        const Eigen::Vector3d p1 = difference(x1, p), q1 = difference(x1, q);
        const double excess = 0.25 * kappa * (p1 - p0).dot(q1 - q0);
        add_pull(f, p, 0.5 * excess * (q0 + q1));
        add_pull(f, q, 0.5 * excess * (p0 + p1));
      }
  };
  if (kappa > 0) term.list_constraints = [=](auto& constraints) { list_quadrants(*all, 1 / kappa, constraints); };
  term.unconstrained_law.cell.shear_rate = kappa_d;
  term.jacobian = [=](const Configuration& c, const JacobianEntries& entries) {
    if (entries.curvature == Curvature::tension) return;
    for (const Cell& cell : *all)
      for (const auto& [p, q] : quadrants(cell)) quadrant_jacobian(c, p, q, kappa, kappa_d, entries);
  };
  return term;
}

}  // namespace drape::model
