// A sheet at rest: every method takes it to the closed-form solution and then has nothing left to do.

#include <gtest/gtest.h>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/exact/tension.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::rest_test {
namespace {

using namespace small_problems;
using solver::Integrator;
using solver::Outcome;
using solver::StageResult;

constexpr double step = 0.002;  // [s]; with longer ones the stiff modes of the midpoint rules die out slowly

/// The sheet of experiment (a), coarser, and its state of rest.
struct PulledSheet {
  model::Scene scene = model::load_scene("tension", std::vector<model::Override>{{"grid.n", "8"}});
  model::Cloth cloth = model::compile(scene);
  Vectors rest = cloth.start.x;

  PulledSheet() {
    const double L = scene.sheet.grid.size_u, force = scene.sheet.material.density * scene.sheet.gravity.norm();
    for (double& u : rest.col(0))  // its right edge is fixed
      u = L - reference::pulled_position({L, scene.sheet.material.tension.weft, force}, L - u);
  }
  double distance(const State& y) const { return (y.x - rest).cwiseAbs().maxCoeff(); }
};

class Rest : public testing::TestWithParam<std::string> {
 protected:
  const Method& method = solver::method(GetParam());
  const PulledSheet sheet;
};
/// Methods that solve their equations; sweeps settle over many steps, and do not look for a rest.
std::vector<Method> solving_methods() {
  std::vector<Method> all = implicit_methods();
  std::erase_if(all, [](const Method& method) { return method.repeats != Method::Repeats::none; });
  return all;
}
INSTANTIATE_TEST_SUITE_P(, Rest, testing::ValuesIn(names(solving_methods())),
                         [](const auto& test) { return identifier(test.param); });

TEST_P(Rest, IsTheClosedFormSolution) {
  Integrator integrator(sheet.cloth.ode, method, tolerances(1e-9, 1e-10), sheet.cloth.start);
  EXPECT_GE(sheet.distance(integrator.state()), 1e-4);
  ASSERT_EQ(integrate(integrator, 2, step).outcome, Outcome::success);
  EXPECT_LE(sheet.distance(integrator.state()), 1e-10);
  EXPECT_LE(integrator.state().v.cwiseAbs().maxCoeff(), 1e-9);
}

TEST_P(Rest, NeedsNoWork) {
  constexpr int most_linear_stages = 4;  // which are solved whatever is left of them
  for (const double tolerance : {1e-6, 1e-12, 0.0}) {
    SCOPED_TRACE(tolerance);
    Integrator integrator(sheet.cloth.ode, method, tolerances(tolerance, tolerance), {sheet.rest, 0 * sheet.rest});
    for (int k = 0; k < 10; ++k) {
      const StageResult result = integrator.step(step);
      ASSERT_EQ(result.outcome, Outcome::success);
      EXPECT_TRUE(method.sub_steps || result.updates <= most_linear_stages) << result.updates;
    }
    EXPECT_LE(sheet.distance(integrator.state()), 1e-12);
  }
}

}  // namespace
}  // namespace drape::verify::rest_test
