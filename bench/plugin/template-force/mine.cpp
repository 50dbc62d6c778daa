#include <algorithm>
#include <cmath>

#include "model/plugin.hpp"
#include "model/sheet/edges.hpp"

namespace {

using namespace drape::model;
using Eigen::Matrix3d, Eigen::Vector3d;

// Springs along all edges d of length l and width w at rest, as forces.my-springs.stiffness = k says:
// E = Σ ½ k w l (|d|/l − 1)²,   the pull of an edge on its ends is ∂E/∂d = k w (1/l − 1/|d|) d
std::optional<Term> springs(const Sheet& sheet, std::span<const double> parameters) {
  const double k = parameters[0];
  const std::vector<Edge> all = edges(sheet.grid);
  Term term;
  term.force = [=](const Configuration& c, Vectors& f) {
    for (const auto& [i, j, weft, l, w] : all) {
      const Vector3d d = c.x.row(j) - c.x.row(i);
      add_pull(f, {i, j}, k * w * (1 / l - 1 / d.norm()) * d);
    }
  };
  term.jacobian = [=](const Configuration& c, const JacobianEntries& entries) {
    for (const auto& [i, j, weft, l, w] : all) {
      const Vector3d d = c.x.row(j) - c.x.row(i);
      const Matrix3d along = d * d.transpose() / d.squaredNorm(), across = Matrix3d::Identity() - along;
      const double turn = 1 / l - 1 / d.norm();  // its negative part is not convex
      add_edge_pair(entries.add_dx, {i, j}, {i, j},
                    k * w * (along / l + (entries.exact() ? turn : std::max(turn, 0.0)) * across));
    }
  };
  term.energy = [=](const Vectors& x) {
    double energy = 0;
    for (const auto& [i, j, weft, l, w] : all) energy += k * w * l / 2 * std::pow((x.row(j) - x.row(i)).norm() / l - 1, 2);
    return energy;
  };
  term.without_energy = true;  // has no mean force, which methods that conserve energy need (term.mean_excess)
  return term;
}

const ForceParameter parameters[] = {
    {.name = "stiffness", .unit = "N/m", .description = "k along weft and warp", .range = ForceParameter::Range::non_negative}};

const TermKind rows[] = {{.name = "my-springs",
                          .description = "springs along weft and warp, from a plugin",
                          .make = springs,
                          .parameters = parameters}};

}  // namespace

DRAPE_FORCES(rows)
