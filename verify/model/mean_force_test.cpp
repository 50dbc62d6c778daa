// The mean force between two states takes as much energy as it gives, and keeps what the force keeps; so does the method that
// is made of it, of a sheet that moves far.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "model/scene_file/scene_file.hpp"
#include "solver/integrator.hpp"
#include "verify/support/model_fixtures.hpp"
#include "verify/support/pinned_sheet.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::mean_force_test {
namespace {

using namespace sheets;
using solver::Integrator;
using solver::Outcome;

constexpr double rounding = 1000 * std::numeric_limits<double>::epsilon();

Eigen::Vector3d torque(const Vectors& x, const Vectors& f) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < x.rows(); ++i) sum += x.row(i).cross(f.row(i));
  return sum;
}

/// Two states far from each other, and the elastic forces between them.
class MeanForceOf : public testing::TestWithParam<Sheet> {
 protected:
  const ForceCase& force = GetParam().force;
  const SplitOde ode = ode_of(force, GetParam().grid.grid);
  const Vectors x0 = deformed(GetParam().grid.grid, 1).x, x1 = deformed(GetParam().grid.grid, 2).x, middle = (x0 + x1) / 2;
  const Vectors in_the_middle = evaluate(ode.force, {middle, at_rest(x0)}), mean = mean_force();
  const double gained = ode.potential_energy(0, x1) - ode.potential_energy(0, x0);

  Vectors mean_force() const {
    Vectors f = in_the_middle;
    ode.mean_excess(0, x0, x1, f);
    return f;
  }
  double size() const { return largest(mean) * largest(x1 - x0) * static_cast<double>(mean.size()); }
  double unbalanced(const Vectors& f) const { return std::abs(gained + f.cwiseProduct(x1 - x0).sum()); }
};
INSTANTIATE_TEST_SUITE_P(, MeanForceOf, testing::ValuesIn(sheets_where([](const Sheet& s) {
                           return s.force.has_energy && ode_of(s.force, s.grid.grid).without_energy.empty();
                         })),
                         name_of);

TEST_P(MeanForceOf, DoesTheWorkThatTheEnergyLoses) { EXPECT_LE(unbalanced(mean), rounding * size()); }

TEST_P(MeanForceOf, KeepsTheMomentaThatTheForceKeeps) {
  if (force.keeps_momentum) {
    EXPECT_LE(mean.colwise().sum().norm(), rounding * largest(mean));
  }
  if (force.keeps_angular) {
    EXPECT_LE(torque(middle, mean).norm(), rounding * largest(mean) * largest(middle));
  }
}

TEST(MeanForce, IsNotTheForceInTheMiddleUnlessTheEnergyIsQuadratic) {
  const Grid grid = five_by_four();
  const Vectors x0 = deformed(grid, 1).x, x1 = deformed(grid, 2).x;
  for (const ForceCase& force : force_cases()) {
    const SplitOde ode = ode_of(force, grid);
    Vectors excess = at_rest(x0);
    ode.mean_excess(0, x0, x1, excess);
    if (force.name.starts_with("all") || force.name == "bent_curves") continue;  // several terms
    const bool quadratic =
        force.name == "unprojected_plate" || force.name == "gravity" || !force.has_energy || !ode.without_energy.empty();
    EXPECT_EQ(largest(excess) == 0, quadratic) << force.name;
  }
}

TEST(MeanForce, DoesNotExistOfAllForces) {
  const std::pair<std::string, std::string> without[] = {{"curves", "curves"},
                                                         {"bent_curves", "curves"},
                                                         {"dahl", "friction"},
                                                         {"jenkin", "friction"},
                                                         {"tables", "tables"},
                                                         {"printed_shear", "printed-shear"},
                                                         {"diagonals", "survey-shear"},
                                                         {"triangles", "survey-shear"},
                                                         {"hinges", "survey-shear"},
                                                         {"baraff_witkin", "survey-shear"},
                                                         {"membrane", "membrane"},
                                                         {"plate", "plate"},
                                                         {"printed_plate", "printed-plate"},
                                                         {"printed_is_border", "printed-plate"},
                                                         {"all_with_a_membrane", "membrane"}};
  for (const ForceCase& force : force_cases()) {
    const model::Cloth cloth = model::compile(scene_of(force, five_by_four()));
    const auto row = std::ranges::find(without, force.name, &std::pair<std::string, std::string>::first);
    if (force.name == "all_of_the_thesis") continue;  // two
    const std::vector<std::string> names =
        row == std::end(without) ? std::vector<std::string>{} : std::vector<std::string>{row->second};
    EXPECT_EQ(cloth.ode.without_energy, names) << force.name;
    EXPECT_EQ(model::forces_without_energy(scene_of(force, five_by_four())), names) << force.name;
    const auto integrator = [&] { Integrator(cloth.ode, solver::method("energy-momentum"), {}, cloth.start); };
    if (names.empty())
      EXPECT_NO_THROW(integrator()) << force.name;
    else
      EXPECT_THROW(integrator(), std::invalid_argument) << force.name;
  }
}

/// What the energy of a run gains or loses at most, over the kinetic energy that it comes to.
double drift(const model::Cloth& cloth, const char* method, double h, int n) {
  Integrator integrator(cloth.ode, solver::method(method), {}, cloth.start);
  const double first = energy(cloth.ode, cloth.start);
  double most = 0, kinetic = 0;
  const auto run = integrate(integrator, n * h, h, [&](const solver::StepReport& step) {
    most = std::max(most, std::abs(energy(cloth.ode, step.y) - first));
    kinetic = std::max(kinetic, kinetic_energy(cloth.ode, step.y.v));
  });
  EXPECT_EQ(run.outcome, Outcome::success) << run.message;
  return most / kinetic;
}

TEST(EnergyMomentum, KeepsTheEnergyOfHungSheets) {
  DRAPE_SLOW();
  const model::Override undamped[] = {{"material.damping", "0"}};
  for (const char* scene : {"hung-edge", "hung-corners"}) {
    const model::Cloth cloth = model::compile(model::load_scene(scene, undamped));
    EXPECT_LE(drift(cloth, "energy-momentum", 0.005, 100), 1e-10) << scene;
    EXPECT_GE(drift(cloth, "midpoint", 0.005, 80), 1e-6) << scene;
  }
}

/// A crumpled sheet in free flight, with all forces that have energies.
model::Cloth free_sheet(bool damped) {
  ForceCase force = force_case("all_with_energies");
  force.gravity.setZero();
  model::Material& m = force.material;
  m.damping = {}, m.shear_damping = m.contraction_damping = 0, m.bend_damping = {};
  if (damped) m.damping = {0.02, 0.03}, m.shear_damping = 0.02;
  const Grid grid = five_by_four();
  model::Cloth cloth = model::compile(scene_of(force, grid));
  cloth.start = deformed(grid, 3);
  return cloth;
}

struct Momenta {
  Eigen::Vector3d linear, angular;
};
Momenta momenta(const SplitOde& ode, const State& y) {
  const Vectors p = ode.mass.asDiagonal() * y.v;
  return {p.colwise().sum(), torque(y.x, p)};
}

TEST(EnergyMomentum, KeepsBothMomentaAndTheEnergyOfAFreeSheet) {
  const model::Cloth cloth = free_sheet(false);
  EXPECT_LE(drift(cloth, "energy-momentum", 0.02, 100), 1e-9);  // as far as stages are solved
  Integrator integrator(cloth.ode, solver::method("energy-momentum"), {}, cloth.start);
  const Momenta first = momenta(cloth.ode, cloth.start);
  for (int k = 0; k < 100; ++k) {
    ASSERT_EQ(integrator.step(0.02).outcome, Outcome::success);
    const Momenta now = momenta(cloth.ode, integrator.state());
    ASSERT_LE((now.linear - first.linear).norm(), 1e-11 * first.linear.norm());
    ASSERT_LE((now.angular - first.angular).norm(), 1e-11 * first.linear.norm());
  }
}

/// −<v, viscous force> [W] at a state.
double dissipated(const SplitOde& ode, const State& y) {
  return (evaluate(ode.force, {y.x, at_rest(y.x)}) - evaluate(ode.force, y)).cwiseProduct(y.v).sum();
}

TEST(EnergyMomentum, LosesWhatDampingTakesInTheMiddleOfEveryStep) {
  const model::Cloth cloth = free_sheet(true);
  const double h = 0.02;
  const auto y = run(cloth, solver::method("energy-momentum"), h, 50);
  for (std::size_t k = 0; k + 1 < y.size(); ++k) {
    const double lost = energy(cloth.ode, y[k]) - energy(cloth.ode, y[k + 1]);
    const State middle{(y[k].x + y[k + 1].x) / 2, (y[k].v + y[k + 1].v) / 2};
    EXPECT_GT(lost, 0);
    EXPECT_NEAR(lost, h * dissipated(cloth.ode, middle), 1e-11 * energy(cloth.ode, y[0])) << "step " << k;
  }
}

}  // namespace
}  // namespace drape::verify::mean_force_test
