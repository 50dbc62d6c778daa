#include <memory>

#include "model/forces/term.hpp"
#include "model/sheet/metric.hpp"

namespace drape::model {
namespace {

/// A quadrant of a cell. With e = <p, q> − <p, q> at rest its pulls are g_p = s q, g_q = s p, where s = κ e + κ_d ė.
struct Quadrant {
  EdgeEnds p, q;
  double rest;     ///< <p, q> at rest [m²]
  double measure;  ///< [m²], Metric::quadrant_measure

  double stiffness(double modulus) const { return modulus / (4 * measure); }  ///< κ [N/m³]
  double value(const Vectors& x) const { return difference(x, p).dot(difference(x, q)) - rest; }
};

/// All quadrants of a sheet, one cell at a time.
class Quadrants {
 public:
  explicit Quadrants(const Grid& grid) : metric_(grid), cells_(cells(grid)) {}

  template <class F>
  void each(const F& f) const {
    for (const Cell& cell : cells_)
      for (const auto& [p, q] : quadrants(cell)) f(quadrant(cell, p, q));
  }

  /// Those whose blocks are taken: 16 of ∂f/∂x each, and as many of ∂f/∂v if they are `viscous`.
  template <class F>
  void each_in(const JacobianEntries& entries, bool viscous, const F& f) const {
    for (const Cell& cell : cells_) {
      if (entries.skips(cell.corner[0][0], cell.corner[1][1], 64, viscous ? 64 : 0)) continue;
      for (const auto& [p, q] : quadrants(cell)) f(quadrant(cell, p, q));
    }
  }

  /// Their angles: each at one corner of its cell, between the edges that end there.
  void list_angles(double G, std::vector<solver::CompliantConstraint>& constraints) const {
    for (const Cell& cell : cells_)
      for (const int a : {0, 1})
        for (const int b : {0, 1}) {
          const Quadrant at = quadrant(cell, b == 0 ? cell.lower() : cell.upper(), a == 0 ? cell.left() : cell.right());
          constraints.push_back({solver::CompliantConstraint::Kind::angle,
                                 {cell.corner[a][b], cell.corner[1 - a][b], cell.corner[a][1 - b]},
                                 a == b ? at.rest : -at.rest,
                                 1 / at.stiffness(G)});
        }
  }

 private:
  Quadrant quadrant(const Cell& cell, EdgeEnds p, EdgeEnds q) const {
    return {p, q, metric_.product(p, q), metric_.quadrant_measure(cell, p, q)};
  }

  Metric metric_;
  std::vector<Cell> cells_;
};

/// Derivatives of the pulls.
void quadrant_jacobian(const Configuration& c, const Quadrant& quadrant, double kappa, double kappa_d,
                       const JacobianEntries& entries) {
  const auto& [P, Q, rest, measure] = quadrant;
  const Eigen::Vector3d p = difference(c.x, P), q = difference(c.x, Q);
  const Eigen::Vector3d dp = difference(c.v, P), dq = difference(c.v, Q);
  const double s = kappa * (p.dot(q) - rest) + kappa_d * (dp.dot(q) + p.dot(dq));
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

}  // namespace

/// Conservative shear: W = ½ G γ² with γ = <s_u, s_v> less than at rest [Etzmuß 2002, 6.2.1] and the viscous stress dG γ̇. Every
/// particle evaluates it in its quadrants, each with a quarter of the cell's area and the one-sided differences of its two
/// edges, so that borders are not a special case; a cell holds one quadrant of each of its corners.
std::optional<Term> make_shear(const Sheet& sheet) {
  const Material& m = sheet.material;
  const Grid grid = sheet.grid;
  const double G = by_tables(m) ? 0 : m.shear;
  if ((G == 0 && m.shear_damping == 0) || m.shear_form != ShearForm::conservative) return {};
  if (grid.nu < 2 || grid.nv < 2) return {};  // a chain has no angle
  const auto all = std::make_shared<const Quadrants>(grid);

  Term term;
  term.law.cell = {.shear = G / 4, .shear_rate = m.shear_damping / 4};
  term.energy = [=](const Vectors& x) {
    double energy = 0;
    all->each([&](const Quadrant& quadrant) {
      const double e = quadrant.value(x);
      energy += 0.5 * quadrant.stiffness(G) * e * e;
    });
    return energy;
  };
  // The mean of κ e (q, p) is κ (e0 + e1)/2 times the edges in the middle.
  term.mean_excess = [=](const Vectors& x0, const Vectors& x1, Vectors& f) {
    all->each([&](const Quadrant& quadrant) {
      const auto& [p, q, rest, measure] = quadrant;
      const Eigen::Vector3d p0 = difference(x0, p), q0 = difference(x0, q);
      const Eigen::Vector3d p1 = difference(x1, p), q1 = difference(x1, q);
      const double excess = 0.25 * quadrant.stiffness(G) * (p1 - p0).dot(q1 - q0);
      add_pull(f, p, 0.5 * excess * (q0 + q1));
      add_pull(f, q, 0.5 * excess * (p0 + p1));
    });
  };
  if (G > 0) term.list_constraints = [=](auto& constraints) { all->list_angles(G, constraints); };
  term.unconstrained_law.cell.shear_rate = m.shear_damping / 4;
  term.jacobian = [=, rate = m.shear_damping](const Configuration& c, const JacobianEntries& entries) {
    if (entries.curvature == Curvature::tension) return;
    all->each_in(entries, rate != 0, [&](const Quadrant& quadrant) {
      quadrant_jacobian(c, quadrant, quadrant.stiffness(G), quadrant.stiffness(rate), entries);
    });
  };
  term.jacobian_in_threads = true;
  return term;
}

}  // namespace drape::model
