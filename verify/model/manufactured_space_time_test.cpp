// Order in space and time together: spacings and steps shrink at once, steps like l for methods of second order and like l² for
// those of first, so that errors in space and in time both fall like l² and none can hide behind the other.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "solver/integrator.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/manufactured_materials.hpp"
#include "verify/support/manufactured_sheets.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::manufactured_space_time_test {
namespace {

using namespace manufactured;
using small_problems::identifier;
using solver::Method;

constexpr double duration = 0.6;  // [s]
constexpr int refinements[] = {3, 4, 5, 6};

/// Steps on the grid of refinement k, for a method of an order: the same on the coarsest grid.
int steps(int k, int order) {
  const double finer = static_cast<double>(k) / refinements[0];
  return static_cast<int>(std::lround(110 * (order == 1 ? finer * finer : finer)));
}

double error(const Problem& problem, const Method& method, int n) {
  const solver::Options options = small_problems::tolerances(1e-9, 1e-10);
  solver::Integrator integrator(problem.ode, method, options, problem.start, start_time);
  const auto run = integrate(integrator, start_time + duration, duration / n);
  EXPECT_EQ(run.outcome, solver::Outcome::success) << run.message;
  return l2_norm(problem.ode, integrator.state().x - problem.exact(integrator.time()).x);
}

/// `declared`: the order after which steps are chosen.
Convergence convergence(const Material& material, const Motion& motion, const Method& method, int declared) {
  Convergence measured;
  for (const int k : refinements) {
    measured.steps.push_back(1.0 / k);
    measured.errors.push_back(error(loaded(grid(k), material, motion), method, steps(k, declared)));
  }
  return measured;
}

using Case = std::tuple<std::string, NamedMaterial, Motion>;

const Motion general{.curved = true, .free = true, .moving = true};

/// All forces together, or all with energies, by every method; every force by the thesis' method, carried by tension where it
/// must be.
std::vector<Case> cases() {
  std::vector<Case> all;
  const NamedMaterial together = joint_materials().front(), with_energies = joint_materials()[1];
  for (const Method& method : small_problems::converging_methods())
    for (const bool free : {false, true})
      all.emplace_back(method.name, method.needs_energies ? with_energies : together, Motion{true, free, true});
  for (const NamedMaterial& material : carried_materials())
    if (material.name != together.name && material.name != "membrane") all.emplace_back("bdf2", material, general);
  return all;
}

std::string name_of_case(const testing::TestParamInfo<Case>& test) {
  const auto& [method, material, motion] = test.param;
  return identifier(method) + "_" + material.name + "_" + motion.name();
}

class ManufacturedSpaceTime : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(, ManufacturedSpaceTime, testing::ValuesIn(cases()), name_of_case);

TEST_P(ManufacturedSpaceTime, OrderIsTheSecond) {
  DRAPE_SLOW();
  const auto& [name, named, motion] = GetParam();
  const Method& method = solver::method(name);
  const auto measured = has_order(convergence(named.material, motion, method, method.order), 2);
  EXPECT_TRUE(measured);
}

TEST(ManufacturedSpaceTimeCheck, RejectsAMethodThatIsWorseThanDeclared) {
  const Material material = joint_materials().front().material;
  EXPECT_FALSE(has_order(convergence(material, general, solver::method("imex-euler"), 2), 2));
  EXPECT_FALSE(has_order(convergence(material, general, solver::method("implicit-euler"), 2), 2));
}

}  // namespace
}  // namespace drape::verify::manufactured_space_time_test
