#include <algorithm>
#include <cmath>
#include <memory>

#include "model/edges.hpp"

namespace drape::model {
namespace {

/// Pulls of one line of springs: g = (linear − k w/|d|) d with d = x_j − x_i and linear = k w/l, or 0 for the remainder
/// that K leaves over.
void pull(const EdgeSweep::Line& line, const Vectors& x, double k, double k_over_l, double* __restrict g) {
  const double* const xi = x.data() + 3 * line.i;
  const double* const xj = x.data() + 3 * line.j;
  const double* const width = line.widths;
  for (int e = 0; e < line.count; ++e) {
    const double d0 = xj[3 * e] - xi[3 * e];
    const double d1 = xj[3 * e + 1] - xi[3 * e + 1];
    const double d2 = xj[3 * e + 2] - xi[3 * e + 2];
    const double s = width[e] * (k_over_l - k / std::sqrt(d0 * d0 + d1 * d1 + d2 * d2));
    g[3 * e] = s * d0;
    g[3 * e + 1] = s * d1;
    g[3 * e + 2] = s * d2;
  }
}

}  // namespace

/// Tension: σ = k ε, ε = |d|/l − 1 along every edge [Etzmuß 2002, (2.20), Alg. 1]; E = Σ ½ k ε² l w with the strip's width
/// w, half on borders. K takes k w/l (x_j − x_i), the explicit remainder is −k w (x_j − x_i)° [(3.18)].
std::optional<Term> make_tension(const Sheet& sheet) {
  const WeftWarp k = sheet.material.tension;
  if (!k.any()) return {};
  const double lu = sheet.grid.spacing_u(), lv = sheet.grid.spacing_v();
  const auto sweep = std::make_shared<EdgeSweep>(sheet.grid);
  const auto all = std::make_shared<const std::vector<Edge>>(edges(sheet.grid));
  const auto forces = [=](const Vectors& x, Vectors& f, bool whole) {
    (*sweep)(f, [&](const EdgeSweep::Line& line, double* g) {
      const double modulus = line.weft ? k.weft : k.warp;
      pull(line, x, modulus, whole ? modulus / (line.weft ? lu : lv) : 0.0, g);
    });
  };

  Term term;
  term.force = [=](const Configuration& c, Vectors& f) { forces(c.x, f, true); };
  term.explicit_force = [=](const Configuration& c, Vectors& f) { forces(c.x, f, false); };
  term.energy = [=](const Vectors& x) {
    double energy = 0;
    for (const Edge& edge : *all) {
      const double strain = (x.row(edge.j) - x.row(edge.i)).norm() / edge.length - 1;
      energy += 0.5 * along(k, edge) * strain * strain * edge.length * edge.width;
    }
    return energy;
  };
  term.jacobian = [=](const Configuration& c, const JacobianEntries& entries) {
    for (const Edge& edge : *all) {
      const Eigen::Vector3d d = c.x.row(edge.j) - c.x.row(edge.i);
      const double r = d.norm();
      const Eigen::Vector3d n = d / r;
      const Eigen::Matrix3d nn = n * n.transpose();
      const double turn = 1 / edge.length - 1 / r;  // negative where the edge is compressed
      const Eigen::Matrix3d block =
          along(k, edge) * edge.width *
          (nn / edge.length + (entries.exact() ? turn : std::max(turn, 0.0)) * (Eigen::Matrix3d::Identity() - nn));
      const EdgeEnds ends{edge.i, edge.j};
      add_edge_pair(entries.add_dx, ends, ends, block);
    }
  };
  term.stiffness = [=](std::vector<Eigen::Triplet<double>>& K) {
    for (const Edge& edge : *all)
      if (along(k, edge) != 0) add_spring(K, edge.i, edge.j, along(k, edge) * edge.width / edge.length);
  };
  return term;
}

}  // namespace drape::model
