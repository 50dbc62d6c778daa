// A real sheet: the methods agree with CVODE, the better the smaller their steps, and at the rate that is declared.

#include <gtest/gtest.h>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/reference.hpp"
#include "reference/sundials/cvode.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::hung_sheet_test {
namespace {

using namespace small_problems;
using reference::rms_distance;
using solver::Integrator;
using solver::Outcome;

constexpr double t_end = 0.2;  // [s]: the sheet is falling, its springs swing and are damped

/// A slack sheet hung by two corners, and where it is at the end by CVODE.
struct HungSheet {
  explicit HungSheet(const std::string& damping)
      : cloth(compile(
            model::load_scene("hung-corners", std::vector<model::Override>{{"grid.n", "8"}, {"material.damping", damping}}))),
        end(by_cvode(1e-12)) {}

  State by_cvode(double rtol) const {
    const double times[] = {t_end};
    return reference::cvode(cloth.ode, cloth.start, 0, times, {.rtol = rtol, .size = 0.8}).states[0];
  }

  const model::Cloth cloth;
  const State end;
};

const HungSheet& hung_sheet() {
  static const HungSheet sheet("5");
  return sheet;
}

/// How far apart two states are.
struct Distance {
  double x, v;
  Distance(const State& a, const State& b) : x(rms_distance(a.x, b.x)), v(rms_distance(a.v, b.v)) {}
};

Distance error(const Method& method, int steps) {
  const HungSheet& sheet = hung_sheet();
  Options options = tolerances(1e-10, 1e-11);
  options.linear_solver = &solver::linear_solver("cholesky");
  Integrator integrator(sheet.cloth.ode, method, options, sheet.cloth.start);
  EXPECT_EQ(integrate(integrator, t_end, t_end / steps).outcome, Outcome::success);
  return {integrator.state(), sheet.end};
}

/// From where on the error is ruled by the order. IMEX Euler first has to resolve its artificial damping h k, which is 2 d
/// here; `verlet` divides longer steps, so that its error does not depend on them.
int coarsest(const Method& method) { return method.name == "imex-euler" || method.name == "verlet" ? 1600 : 200; }

class HungSheetWith : public testing::TestWithParam<std::string> {
 protected:
  const Method& method = solver::method(GetParam());
};
INSTANTIATE_TEST_SUITE_P(, HungSheetWith, testing::ValuesIn(names(solver::thesis_methods())),
                         [](const auto& test) { return identifier(test.param); });

TEST_P(HungSheetWith, AgreesWithCvodeAtTheDeclaredRate) {
  DRAPE_SLOW();
  Convergence x, v;
  for (int steps = coarsest(method); steps <= 8 * coarsest(method); steps *= 2) {
    const Distance e = error(method, steps);
    for (Convergence* c : {&x, &v}) c->steps.push_back(t_end / steps);
    x.errors.push_back(e.x);
    v.errors.push_back(e.v);
  }
  EXPECT_TRUE(has_order(x, method.order, 0.15)) << "positions";
  EXPECT_TRUE(has_order(v, method.order, 0.15)) << "velocities";

  const HungSheet& sheet = hung_sheet();
  const Distance uncertainty(sheet.by_cvode(1e-11), sheet.end);
  EXPECT_LE(uncertainty.x, 0.2 * x.errors.back()) << "the reference is not good enough to tell";
  EXPECT_LE(uncertainty.v, 0.2 * v.errors.back()) << "the reference is not good enough to tell";
}

TEST(HungSheet, HasMovedFarBeyondTheErrors) { EXPECT_GE(rms_distance(hung_sheet().end.x, hung_sheet().cloth.start.x), 0.05); }

TEST(HungSheet, IsNotThatOfAnotherMaterial) { EXPECT_GE(rms_distance(hung_sheet().end.x, HungSheet("5.001").end.x), 1e-6); }

}  // namespace
}  // namespace drape::verify::hung_sheet_test
