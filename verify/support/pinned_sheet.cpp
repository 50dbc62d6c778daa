#include "verify/support/pinned_sheet.hpp"

#include <gtest/gtest.h>

#include "verify/support/small_problems.hpp"

namespace drape::verify {

reference::PinnedSheet tense_sheet() {
  reference::PinnedSheet s;
  s.nu = 7, s.nv = 6;
  s.size_u = 1, s.size_v = 0.8;
  s.strain_u = 0.3, s.strain_v = 0.2;
  s.density = 0.2;
  s.k1 = 40, s.k2 = 30;
  return s;
}

model::Scene scene_of(const reference::PinnedSheet& s) {
  model::Scene scene;
  scene.sheet.grid = {s.nu, s.nv, s.size_u, s.size_v};
  model::Material& m = scene.sheet.material;
  m.density = s.density;
  m.tension = {s.k1, s.k2};
  m.contraction = s.contraction;
  m.damping = {s.d1, s.d2};
  m.bend = {s.B1, s.B2};
  m.bend_damping = {s.dB1, s.dB2};
  m.bend_projected = s.plate_projected;
  scene.pins = {{.where = "border", .particles = {}}};
  scene.start.stretch = {1 + s.strain_u, 1 + s.strain_v};
  return scene;
}

std::vector<solver::State> run(const model::Cloth& cloth, const solver::Method& method, double h, int n) {
  solver::Integrator integrator(cloth.ode, method, small_problems::tolerances(1e-12, 1e-13), cloth.start);
  std::vector<solver::State> states = {integrator.state()};
  for (int k = 0; k < n; ++k) {
    EXPECT_EQ(integrator.step(h).outcome, solver::Outcome::success) << method.name << ", step " << k;
    states.push_back(integrator.state());
  }
  return states;
}

double energy(const solver::SplitOde& ode, const solver::State& y) {
  return kinetic_energy(ode, y.v) + ode.potential_energy(0, y.x);
}

std::vector<double> energies(const model::Cloth& cloth, const solver::Method& method, double h, int n) {
  std::vector<double> all;
  for (const solver::State& y : run(cloth, method, h, n)) all.push_back(energy(cloth.ode, y));
  return all;
}

}  // namespace drape::verify
