#include <algorithm>
#include <array>
#include <memory>

#include "model/forces/term.hpp"
#include "model/sheet/metric.hpp"

namespace drape::model {
namespace {

/// An edge of a cell with its strain ε = |p|/l − 1 and strain rate.
struct Strained {
  EdgeEnds ends;
  double length;
  double r;           ///< |p|
  Eigen::Vector3d n;  ///< p°
  Eigen::Vector3d q;  ///< ṗ
  double strain, rate;

  Strained(const Configuration& c, EdgeEnds edge, double l) : ends(edge), length(l), q(difference(c.v, edge)) {
    const Eigen::Vector3d p = difference(c.x, edge);
    r = p.norm();
    n = p / r;
    strain = r / l - 1;
    rate = q.dot(n) / l;
  }
};

/// The edges of a cell in two pairs: those along u and those along v. Each pair pulls with the other's mean strain.
struct Pairs {
  std::array<Strained, 2> u, v;

  Pairs(const Configuration& c, const Cell& cell, const Metric& metric)
      : u{Strained(c, cell.lower(), metric.length(cell.lower())), Strained(c, cell.upper(), metric.length(cell.upper()))},
        v{Strained(c, cell.left(), metric.length(cell.left())), Strained(c, cell.right(), metric.length(cell.right()))} {}
};

/// Half the pull of an edge of length l is C12 times a quarter of the cell's area, over l.
struct Moduli {
  double elastic, viscous;  ///< C12 A/4, d12 A/4, of a cell of area A

  Moduli(const CellLaw& law, const Metric& metric, const Cell& cell) {
    const auto [u, v] = metric.sides(cell);
    elastic = law.contraction * u * v, viscous = law.contraction_rate * u * v;
  }
  double stress(const std::array<Strained, 2>& other) const {
    return elastic * (other[0].strain + other[1].strain) + viscous * (other[0].rate + other[1].rate);
  }
};

void add_jacobians(const Moduli& moduli, const std::array<Strained, 2>& pair, const std::array<Strained, 2>& other,
                   const JacobianEntries& entries) {
  const auto &dx = entries.add_dx, &dv = entries.add_dv;
  const double stress = entries.exact() ? moduli.stress(other) : std::max(moduli.stress(other), 0.0);
  for (const Strained& p : pair) {
    const Eigen::Matrix3d turn = (Eigen::Matrix3d::Identity() - p.n * p.n.transpose()) / p.r;
    add_edge_pair(dx, p.ends, p.ends, stress / p.length * turn);
    if (!entries.exact()) continue;  // the coupling is indefinite
    for (const Strained& s : other) {
      const Eigen::Vector3d strain_by_s = s.n / s.length;
      const Eigen::Vector3d rate_by_s = (s.q - s.q.dot(s.n) * s.n) / (s.r * s.length);
      add_edge_pair(dx, p.ends, s.ends,
                    p.n / p.length * (moduli.elastic * strain_by_s + moduli.viscous * rate_by_s).transpose());
      if (moduli.viscous != 0) add_edge_pair(dv, p.ends, s.ends, moduli.viscous * p.n / p.length * strain_by_s.transpose());
    }
  }
}

/// An edge of a cell between two states, in the middle of them and on average.
struct Averaged {
  EdgeEnds ends;
  double length;
  Eigen::Vector3d middle;  ///< p̄ = (p0 + p1)/2
  double inverse;          ///< 1/|p̄|
  double mean_inverse;     ///< 2/(|p0| + |p1|), so that |p1| − |p0| = mean_inverse <p̄, p1 − p0>

  Averaged(const Vectors& x0, const Vectors& x1, EdgeEnds edge, double l) : ends(edge), length(l) {
    const Eigen::Vector3d p0 = difference(x0, edge), p1 = difference(x1, edge);
    middle = 0.5 * (p0 + p1);
    inverse = 1 / middle.norm();
    mean_inverse = 2 / (p0.norm() + p1.norm());
  }

  double strain() const { return 1 / (inverse * length) - 1; }
  double mean_strain() const { return 1 / (mean_inverse * length) - 1; }
};

/// A product of strains changes by each one's change times the other's mean.
void add_mean_excess(double elastic, const std::array<Averaged, 2>& pair, const std::array<Averaged, 2>& other, Vectors& f) {
  const double strain = other[0].strain() + other[1].strain();
  const double mean_strain = other[0].mean_strain() + other[1].mean_strain();
  for (const Averaged& p : pair) {
    const double excess = mean_strain * p.mean_inverse - strain * p.inverse;
    add_pull(f, p.ends, elastic / p.length * excess * p.middle);
  }
}

}  // namespace

/// Transverse contraction σ11 = C12 ε22 + d12 ε̇22, σ22 = C12 ε11 + d12 ε̇11 [Etzmuß 2002, (2.22)] in the consistent form
/// E = Σ_cells C12 A ½(ε_lower + ε_upper) ½(ε_left + ε_right). Algorithm 5 as printed is half a cell off.
std::optional<Term> make_contraction(const Sheet& sheet) {
  const Material& m = sheet.material;
  const double modulus = by_tables(m) ? 0 : m.contraction;
  if (modulus == 0 && m.contraction_damping == 0) return {};
  if (sheet.grid.nu < 2 || sheet.grid.nv < 2) return {};  // a chain has no cells
  const CellLaw law{.contraction = modulus / 4, .contraction_rate = m.contraction_damping / 4};
  const auto all = std::make_shared<const std::vector<Cell>>(cells(sheet.grid));
  const auto metric = std::make_shared<const Metric>(sheet.grid);

  Term term;
  term.law.cell = law;
  if (const double d12 = m.contraction_damping; d12 * d12 > m.damping.weft * m.damping.warp)  // else damping takes more
    term.active_law.cell.contraction_rate = law.contraction_rate;
  term.energy = [=](const Vectors& x) {
    double energy = 0;
    const auto strain = [&](EdgeEnds edge) { return difference(x, edge).norm() / metric->length(edge) - 1; };
    for (const Cell& cell : *all)
      energy += Moduli(law, *metric, cell).elastic * (strain(cell.lower()) + strain(cell.upper())) *
                (strain(cell.left()) + strain(cell.right()));
    return energy;
  };
  term.mean_excess = [=](const Vectors& x0, const Vectors& x1, Vectors& f) {
    const auto averaged = [&](EdgeEnds edge) { return Averaged(x0, x1, edge, metric->length(edge)); };
    for (const Cell& cell : *all) {
      const std::array u{averaged(cell.lower()), averaged(cell.upper())};
      const std::array v{averaged(cell.left()), averaged(cell.right())};
      const double elastic = Moduli(law, *metric, cell).elastic;
      add_mean_excess(elastic, u, v, f);
      add_mean_excess(elastic, v, u, f);
    }
  };
  term.jacobian = [=](const Configuration& c, const JacobianEntries& entries) {
    for (const Cell& cell : *all) {
      const Pairs pairs(c, cell, *metric);
      const Moduli moduli(law, *metric, cell);
      add_jacobians(moduli, pairs.u, pairs.v, entries);
      add_jacobians(moduli, pairs.v, pairs.u, entries);
    }
  };
  term.jacobian_in_threads = true;
  return term;
}

}  // namespace drape::model
