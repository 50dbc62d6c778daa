#include "bench/peers/springs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "model/phases.hpp"
#include "model/sheet/cells.hpp"
#include "model/sheet/edges.hpp"

namespace drape::bench::peers {
namespace {

using solver::Vectors;

std::vector<double> numbers(const Vectors& vectors) { return {vectors.data(), vectors.data() + vectors.size()}; }

/// A spring between two particles, the lower first.
struct Spring {
  std::array<int, 2> ends;
  double rest, stiffness, drag;
};

Spring between(int i, int j, double rest, double stiffness, double drag) {
  return {{std::min(i, j), std::max(i, j)}, rest, stiffness, drag};
}

/// Tension and damping along edges, shear along the diagonals of cells [Provot 1995].
std::vector<Spring> springs(const model::Sheet& sheet) {
  const model::Material& m = sheet.material;
  std::vector<Spring> all;
  for (const model::Edge& edge : model::edges(sheet.grid)) {
    const double by_length = edge.width / edge.length;
    all.push_back(between(edge.i, edge.j, edge.length, model::along(m.tension, edge) * by_length,
                          model::along(m.damping, edge) * by_length));
  }
  if (m.shear == 0 || m.shear_form != model::ShearForm::diagonals) return all;
  const double u = sheet.grid.spacing_u(), v = sheet.grid.spacing_v(), length = std::hypot(u, v);
  for (const model::Cell& cell : model::cells(sheet.grid)) {
    const double stiffness = m.shear * length * length / (2 * u * v);
    all.push_back(between(cell.corner[1][0], cell.corner[0][1], length, stiffness, 0));
    all.push_back(between(cell.corner[0][0], cell.corner[1][1], length, stiffness, 0));
  }
  return all;
}

/// Sets them particle by particle: what sweeps over springs comes to depends on their order, and that is the usual one.
void set_springs(Problem& problem, const model::Sheet& sheet) {
  problem.drag_along = sheet.material.damping_form == model::DampingForm::projected;
  std::vector<Spring> all = springs(sheet);
  std::ranges::sort(all, {}, &Spring::ends);
  for (const Spring& spring : all) {
    problem.ends.push_back(spring.ends);
    problem.rest.push_back(spring.rest);
    problem.stiffness.push_back(spring.stiffness);
    problem.drag.push_back(spring.drag);
  }
}

std::vector<int> held(const model::Scene& scene, const model::Cloth& cloth) {
  std::vector<int> particles;
  for (const solver::Pin& pin : cloth.ode.pins) {
    if (!pin.all() || !pin.velocity.isZero(0))
      throw std::invalid_argument(
          fmt::format("{}: expected pins that hold all directions and do not move, as the peer has no others", scene.name));
    particles.push_back(pin.particle);
  }
  return particles;
}

/// One sheet of equal cells, smooth and without memory.
bool is_plain(const model::Scene& scene, const model::Cloth& cloth) {
  return scene.panels.empty() && scene.sheet.grid.uniform() && model::phases(scene).size() == 1 && !cloth.ode.has_contacts() &&
         !cloth.ode.memory && !cloth.ode.step_forces;
}

void set_particles(Problem& problem, const model::Scene& scene, const model::Cloth& cloth) {
  problem.mass.assign(cloth.ode.mass.begin(), cloth.ode.mass.end());
  problem.positions = numbers(cloth.start.x);
  problem.velocities = numbers(cloth.start.v);
  problem.pinned = held(scene, cloth);
  std::ranges::copy(scene.sheet.gravity, problem.gravity.begin());
}

/// Whether the springs are all forces of the scene, to round-off, at a state that no force is zero at.
bool are_all(const Problem& problem, const model::Cloth& cloth) {
  constexpr double part = 0.1, round_off = 1e-9;
  const Vectors x0 = cloth.start.x;
  const double length = problem.rest.front();
  const auto wave = [&](double count) {
    return Vectors(Vectors::NullaryExpr(
        x0.rows(), 3, [&](Eigen::Index i, Eigen::Index c) { return std::sin(count * static_cast<double>(3 * i + c + 1)); }));
  };
  const Vectors x = x0 + part * length * wave(1.7), v = length * wave(2.3);
  Vectors force(x.rows(), 3);
  cloth.ode.force(0, x, v, force);
  return (force - spring_force(problem, x, v)).norm() <= round_off * force.norm();
}

}  // namespace

Vectors spring_force(const Problem& problem, const Vectors& x, const Vectors& v) {
  const Eigen::RowVector3d gravity = Eigen::Map<const Eigen::RowVector3d>(problem.gravity.data());
  Vectors force = Eigen::Map<const Eigen::VectorXd>(problem.mass.data(), x.rows()) * gravity;
  for (std::size_t k = 0; k < problem.ends.size(); ++k) {
    const auto [i, j] = problem.ends[k];
    const Eigen::RowVector3d d = x.row(j) - x.row(i), moving = v.row(j) - v.row(i), along = d.normalized();
    const Eigen::RowVector3d drag = problem.drag_along ? Eigen::RowVector3d(moving.dot(along) * along) : moving;
    const Eigen::RowVector3d pull = problem.stiffness[k] * (d - problem.rest[k] * along) + problem.drag[k] * drag;
    force.row(i) += pull;
    force.row(j) -= pull;
  }
  return force;
}

void set_springs(Problem& problem, const model::Scene& scene, const model::Cloth& cloth) {
  const auto refuse = [&] {
    throw std::invalid_argument(fmt::format(
        "{}: expected a uniform sheet with springs and weight only, as with material.shear_form = \"diagonals\"; it "
        "has {}",
        scene.name, fmt::join(cloth.plan.terms, ", ")));
  };
  if (!is_plain(scene, cloth)) refuse();
  set_particles(problem, scene, cloth);
  set_springs(problem, scene.sheet);
  if (problem.ends.empty() || !are_all(problem, cloth)) refuse();
}

void set_membrane(Problem& problem, const model::Scene& scene, const model::Cloth& cloth) {
  const model::Material& m = scene.sheet.material;
  if (!is_plain(scene, cloth) || m.damping.any() || m.tension.weft != m.tension.warp || m.tension.weft == 0 ||
      !cloth.ode.mass.isConstant(cloth.ode.mass[0], 1e-12))
    throw std::invalid_argument(fmt::format(
        "{}: expected an undamped uniform sheet with equal tensions and equal masses, as with grid.border_cells = \"whole\"",
        scene.name));
  set_particles(problem, scene, cloth);
  problem.young = m.tension.weft;
  for (const model::Cell& cell : model::cells(scene.sheet.grid)) {
    const auto& c = cell.corner;
    problem.triangles.push_back({c[0][0], c[1][0], c[1][1]});
    problem.triangles.push_back({c[0][0], c[1][1], c[0][1]});
  }
}

}  // namespace drape::bench::peers
