#include "verify/support/manufactured_sheets.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

namespace drape::verify::manufactured {
namespace {

/// Amplitudes [p][q] of the product of basis p along u and q along v [m].
using Amplitudes = std::array<std::array<Vector3d, 3>, 3>;

reference::SurfaceMode mode(const Amplitudes& amplitudes, const Motion& motion, const Function& time) {
  reference::SurfaceMode all{{}, time};
  for (int p = 0; p < 3; ++p)
    for (int q = 0; q < 3; ++q) {
      const Vector3d& a = amplitudes[p][q];
      all.products.push_back({{a[0], a[1], motion.curved ? a[2] : 0}, basis(p, size_u), basis(q, size_v)});
    }
  return all;
}

/// Swings as a whole if its borders are free, inside of them if not, because pins move with constant velocity.
reference::SurfaceMode swing(const Motion& motion) {
  Amplitudes amplitudes{{{{{0.03, 0.02, 0.05}, {0.03, -0.02, 0.02}, {0.02, -0.01, 0.02}}},
                         {{{0.02, 0.03, -0.03}, {-0.03, 0.02, 0.04}, {0.01, 0.01, -0.01}}},
                         {{{-0.02, 0.01, 0.02}, {0.01, -0.02, 0.03}, {0.04, 0.03, 0.05}}}}};
  for (int p = 0; p < 3 && !motion.free; ++p)
    for (int q = 0; q < 3; ++q)
      if (p < 2 || q < 2) amplitudes[p][q].setZero();
  return mode(amplitudes, motion, {{}, 1, 4.5, 0.4});
}

reference::Directional directional(const model::WeftWarp& modulus) { return {modulus.weft, modulus.warp}; }

}  // namespace

Function basis(int k, double length) {
  if (k < 2) return {k == 0 ? std::vector{1.0} : std::vector{0, 1 / length}};
  Function arch{{0, 7 / 4.0, 0, -15 / 6.0, 0, 15 / 20.0}, 0.5, std::numbers::pi / length, 0};
  for (std::size_t n = 0; n < arch.coefficients.size(); ++n) arch.coefficients[n] /= std::pow(length, n);
  return arch;
}

std::ostream& operator<<(std::ostream& out, const Motion& motion) { return out << motion.name(); }

std::vector<Motion> motions() {
  std::vector<Motion> all;
  for (const bool curved : {false, true})
    for (const bool free : {false, true})
      for (const bool moving : {false, true}) all.push_back({curved, free, moving});
  return all;
}

Surface surface(const Motion& motion) {
  const Amplitudes place{{{{{0.1, -0.2, 0.3}, {0.1, 1.0, -0.05}, {0.03, 0.02, 0.04}}},
                          {{{1.7, 0.05, 0.1}, {0.02, 0.05, 0.15}, {-0.02, 0.03, 0.03}}},
                          {{{0.04, -0.03, 0.05}, {0.03, 0.02, -0.04}, {0.03, -0.03, 0.06}}}}};
  const Amplitudes drift{{{{{0.3, 0.2, 0.1}, {-0.02, 0.1, 0.04}, {0.01, -0.02, 0.02}}},
                          {{{0.15, -0.04, 0.02}, {0.03, 0.01, -0.03}, {0.02, 0.01, -0.01}}},
                          {{{-0.01, 0.02, 0.03}, {0.02, -0.01, 0.01}, {0.02, 0.01, -0.02}}}}};
  Surface s{mode(place, motion, {{1}})};
  if (!motion.moving) return s;
  s.push_back(mode(drift, motion, {{0, 1}}));
  s.push_back(swing(motion));
  return s;
}

Grid grid(int k) { return {3 * k + 1, 2 * k + 1, size_u, size_v}; }

Nodes::Nodes(const Grid& grid, const Surface& surface) {
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a) points_.emplace_back(surface, a * grid.spacing_u(), b * grid.spacing_v());
}

State Nodes::state(double t) const {
  const auto n = static_cast<Eigen::Index>(points_.size());
  State y{Vectors(n, 3), Vectors(n, 3)};
  for (int i = 0; i < n; ++i) {
    const auto [s, rate, acceleration] = points_[i].at(t);
    y.x.row(i) = s(0, 0);
    y.v.row(i) = rate(0, 0);
  }
  return y;
}

reference::ContinuumMaterial continuum(const Material& m) {
  reference::ContinuumMaterial c;
  c.density = m.density;
  c.tension = directional(m.tension);
  (m.damping_form == DampingForm::linear ? c.linear_damping : c.projected_damping) = directional(m.damping);
  c.shear = m.shear, c.shear_damping = m.shear_damping;
  c.contraction = m.contraction, c.contraction_damping = m.contraction_damping;
  c.bend = directional(m.bend), c.bend_damping = directional(m.bend_damping);
  c.bending = m.bend_form == BendForm::membrane ? reference::Bending::membrane
              : m.bend_projected                ? reference::Bending::projected_plate
                                                : reference::Bending::plate;
  return c;
}

reference::DualCell dual_cell(const Grid& grid, int a, int b) {
  const auto side = [](int place, int n) { return place == 0 ? -1 : place == n - 1 ? 1 : 0; };
  return {Grid::dual_width(a, grid.nu) * grid.spacing_u(), Grid::dual_width(b, grid.nv) * grid.spacing_v(), side(a, grid.nu),
          side(b, grid.nv)};
}

reference::DualCell no_traction_on_the_right(const Grid& grid, int a, int b) {
  reference::DualCell cell = dual_cell(grid, a, b);
  if (cell.side_u == 1) cell.side_u = 0;
  return cell;
}

Load::Load(const Grid& grid, const reference::ContinuumMaterial& material, const Surface& surface, CellOf cell)
    : grid_(grid), material_(material), nodes_(grid, surface), cell_(cell), vertex_normals_(grid) {
  for (Vectors* field : {&force_, &bending_, &normals_}) field->setZero(grid.particles(), 3);
}

void Load::add(double t, const Vectors& x, Vectors& f) {
  if (t != time_) evaluate(t);
  f += force_;
  if (material_.bending == reference::Bending::plate) f += bending_;
  if (material_.bending != reference::Bending::projected_plate) return;
  vertex_normals_.evaluate(x, normals_);
  for (int i = 0; i < f.rows(); ++i) f.row(i) += normals_.row(i).dot(bending_.row(i)) * normals_.row(i);
}

void Load::evaluate(double t) {
  time_ = t;
  for (int i = 0; i < grid_.particles(); ++i) {
    const auto [force, bending] = node_load(material_, nodes_.jet(i, t), cell_(grid_, i % grid_.nu, i / grid_.nu));
    force_.row(i) = force;
    bending_.row(i) = bending;
  }
}

void add_load(SplitOde& ode, const SplitOde::Force& add) {
  for (SplitOde::Force* force : {&ode.force, &ode.explicit_force, &ode.unconstrained_force})
    if (*force)
      *force = [original = *force, add](double t, const Vectors& x, const Vectors& v, Vectors& f) {
        original(t, x, v, f);
        add(t, x, v, f);
      };
}

Problem unloaded(const Grid& grid, const Material& material, const Motion& motion) {
  const auto nodes = std::make_shared<const Nodes>(grid, surface(motion));
  Scene scene;
  scene.sheet = {grid, material};
  if (!motion.free) scene.pins.emplace_back().where = "border";
  Problem problem{motion.name(), model::compile(scene).ode, nodes->state(start_time),
                  [nodes](double t) { return nodes->state(t); }};
  for (solver::Pin& pin : problem.ode.pins) pin.velocity = problem.start.v.row(pin.particle);
  return problem;
}

Problem loaded(const Grid& grid, const Material& material, const Motion& motion, const reference::ContinuumMaterial& continuum,
               Load::CellOf cell) {
  Problem problem = unloaded(grid, material, motion);
  const auto load = std::make_shared<Load>(grid, continuum, surface(motion), cell);
  add_load(problem.ode, [load](double t, const Vectors& x, const Vectors&, Vectors& f) { load->add(t, x, f); });
  return problem;
}

Problem loaded(const Grid& grid, const Material& material, const Motion& motion) {
  return loaded(grid, material, motion, continuum(material));
}

double l2_norm(const SplitOde& ode, const Vectors& difference) {
  return std::sqrt(ode.mass.dot(difference.rowwise().squaredNorm()) / ode.mass.sum());
}

}  // namespace drape::verify::manufactured
