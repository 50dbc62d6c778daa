// Conditioning: the perturbation that grows most, against the singular values of the motion itself.

#include "reference/growth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/linear_motion.hpp"
#include "reference/reference.hpp"
#include "reference/sundials/cvode.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::growth_test {
namespace {

using namespace small_problems;
using reference::LinearMotion;
using reference::Trajectory;
using testing::AllOf;
using testing::Each;
using testing::Ge;
using testing::Le;

using Overrides = std::vector<model::Override>;

/// A small sheet, how long it is looked at, and CVODE's motions of it.
struct Sheet {
  model::Scene scene;
  double end;  ///< [s]
  model::Cloth cloth = model::compile(scene);
  double size = model::size(scene);

  Sheet(const std::string& name, const Overrides& overrides, double until)
      : scene(model::load_scene(name, overrides)), end(until) {}

  Trajectory solve(const State& start, const std::vector<double>& times) const {
    return reference::cvode(cloth.ode, start, 0, times, {.rtol = 1e-12, .size = size});
  }
  Vectors end_of(const State& start) const { return solve(start, {end}).states[0].x; }

  Trajectory motion() const { return solve(cloth.start, {end}); }
  reference::SolveFrom from() const {
    return [this](const State& start) { return solve(start, {end}); };
  }
  double growth(const State& direction) const {
    return reference::growth_along(direction, cloth.start, motion(), size, from()).factors[0];
  }
};

State noise(const SplitOde& ode, unsigned seed) {
  State y{small_problems::noise(ode.particles(), seed), small_problems::noise(ode.particles(), seed + 1)};
  for (Vectors* part : {&y.x, &y.v}) solver::filter(ode.pins, *part);
  return y;
}

// --- The linearised motion ---------------------------------------------------------------------------------------------------

/// Wind, projected plates and projected damping: neither Jacobian is symmetric, and both change with time.
Sheet windy_sheet() {
  return {"wind",
          {{"grid.n", "4"}, {"material.damping_form", "projected"}, {"material.bend", "0.01"}, {"start.pleats", "[1, 35]"}},
          0.1};
}

struct Linearised {
  static constexpr int steps = 400;  // noise is fast
  const Sheet& sheet;
  const double h = sheet.end / steps;
  LinearMotion motion;

  explicit Linearised(const Sheet& s) : sheet(s), motion(s.cloth.ode, middles(s), s.end / steps) {}

  static Trajectory middles(const Sheet& s) {
    std::vector<double> times;
    for (int k = 0; k < steps; ++k) times.push_back((k + 0.5) * s.end / steps);
    return s.solve(s.cloth.start, times);
  }
};

TEST(LinearMotion, IsThatOfASmallPerturbation) {
  const Sheet sheet = windy_sheet();
  Linearised linear(sheet);
  const State direction = noise(sheet.cloth.ode, 1);
  const double part = 1e-6 * sheet.size;
  const std::vector<Vectors> positions = linear.motion.forward(direction);
  ASSERT_EQ(positions.size(), std::size_t{Linearised::steps});
  const State moved{sheet.cloth.start.x + part * direction.x, sheet.cloth.start.v + part * direction.v};
  const Vectors truth = (sheet.end_of(moved) - sheet.end_of(sheet.cloth.start)) / part;
  EXPECT_LE((positions.back() - truth).norm(), 0.1 * truth.norm());
}

TEST(LinearMotion, HasItsTranspose) {
  const Sheet sheet = windy_sheet();
  Linearised linear(sheet);
  const State direction = noise(sheet.cloth.ode, 1);
  std::vector<Vectors> weights;
  const std::vector<Vectors> positions = linear.motion.forward(direction);
  for (unsigned k = 0; k < Linearised::steps; ++k) weights.push_back(positions[k] + 0.5 * noise(sheet.cloth.ode, 10 + k).x);
  const State transposed = linear.motion.transposed(weights);
  double there = 0, scale = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    there += weights[k].cwiseProduct(positions[k]).sum();
    scale += weights[k].norm() * positions[k].norm();
  }
  const double back = transposed.x.cwiseProduct(direction.x).sum() + transposed.v.cwiseProduct(direction.v).sum();
  EXPECT_NEAR(there, back, 1e-3 * scale);
  EXPECT_GE(std::abs(there), 1e-2 * scale) << "or it would say nothing";
}

// --- Growth ------------------------------------------------------------------------------------------------------------------

struct GrowingSheet {
  const char* name;
  const char* scene;
  Overrides overrides;
  double end;  ///< [s]
};

std::ostream& operator<<(std::ostream& out, const GrowingSheet& sheet) { return out << sheet.name; }

const std::vector<GrowingSheet> growing_sheets{
    {"Folding", "hung-corners", {{"grid.n", "4"}, {"material.damping", "0"}}, 0.3},
    {"Damped", "hung-corners", {{"grid.n", "4"}, {"material.damping", "5"}}, 0.3},
    {"Windy",
     "wind",
     {{"grid.n", "4"}, {"material.damping_form", "projected"}, {"material.bend", "0.01"}, {"start.pleats", "[1, 35]"}},
     0.2}};

class GrowthOf : public testing::TestWithParam<GrowingSheet> {};
INSTANTIATE_TEST_SUITE_P(, GrowthOf, testing::ValuesIn(growing_sheets), [](const auto& test) { return test.param.name; });

TEST_P(GrowthOf, IsMoreThanHalfOfTheLargestSingularValueFromAnySeed) {
  DRAPE_SLOW();
  const auto& [name, scene, overrides, end] = GetParam();
  const Sheet sheet(scene, overrides, end);
  const double largest =
      reference::largest_growth(sheet.cloth.ode, sheet.cloth.start, 0, sheet.motion(), sheet.size, sheet.from());
  for (const unsigned seed : {1u, 2u, 3u}) {
    const State direction =
        reference::fastest_growing(sheet.cloth.ode, sheet.cloth.start, 0, std::vector{end}, sheet.size, 6, seed);
    EXPECT_NEAR(reference::perturbation_size(direction, end), 1, 1e-12);
    EXPECT_THAT(sheet.growth(direction) / largest, AllOf(Ge(0.5), Le(1.02))) << "seed " << seed;
  }
  const State first = reference::fastest_growing(sheet.cloth.ode, sheet.cloth.start, 0, std::vector{end}, sheet.size, 0);
  EXPECT_LE(sheet.growth(first), largest / 2) << "it would do without rounds";
}

/// One coordinate that runs away or oscillates, x'' = sign x; the two others are fixed.
SplitOde coordinate(double sign) {
  SplitOde ode;
  ode.mass = Eigen::VectorXd::Ones(1);
  ode.force = [=](double, const Vectors& x, const Vectors&, Vectors& f) { f << sign * x(0, 0), 0, 0; };
  ode.jacobian = [=](double, const Vectors&, const Vectors&, SparseMatrix& df_dx, SparseMatrix& df_dv) {
    df_dx.resize(3, 3);
    df_dv.resize(3, 3);
    df_dx.insert(0, 0) = sign;
  };
  ode.pins = {{.particle = 0, .held = solver::axes(false, true, true)}};
  return ode;
}

reference::Reference growth_of(double sign, double size) {
  return reference::reference(coordinate(sign), known_motions::single({1, 0, 0}, {0, 0, 0}), 0, std::vector{2.0, 5.0, 10.0},
                              {.rtol = 1e-9, .size = size});
}

TEST(Growth, OfAnyPerturbationIsTheNormOfTheLinearMotion) {
  DRAPE_SLOW();
  const SplitOde ode = coordinate(1);
  const State start = known_motions::single({1, 0, 0}, {0, 0, 0});
  const auto solve = [&](const State& y) { return reference::cvode(ode, y, 0, std::vector{2.0}, {.rtol = 1e-12}); };
  EXPECT_NEAR(reference::largest_growth(ode, start, 0, solve(start), 1, solve), std::hypot(std::cosh(2), std::sinh(2) / 2),
              1e-4);
}

TEST(Growth, IsTheNormOfTheLinearMotion) {
  DRAPE_SLOW();
  for (const double size : {1.0, 10.0}) {
    const reference::Reference unstable = growth_of(1, size), oscillating = growth_of(-1, size);
    for (std::size_t k = 0; k < 3; ++k) {
      const double t = unstable.trajectory.times[k], T = unstable.trajectory.times.back();
      EXPECT_NEAR(unstable.growth[k] / std::hypot(std::cosh(t), std::sinh(t) / T), 1, 0.02) << t << ' ' << size;
    }
    EXPECT_THAT(oscillating.growth, Each(AllOf(Ge(0.0), Le(1.02)))) << size;
    EXPECT_GE(std::ranges::max(oscillating.growth), 0.5) << size;
  }
}

TEST(Growth, TellsAFoldingSheetFromADampedOne) {
  DRAPE_SLOW();
  const auto growth = [](const char* damping) {
    const Sheet sheet("hung-corners", {{"grid.n", "8"}, {"material.damping", damping}}, 0.4);
    const Trajectory motion = sheet.solve(sheet.cloth.start, {0.2, 0.4});
    return std::ranges::max(
        reference::measure_growth(sheet.cloth.ode, sheet.cloth.start, 0, motion, sheet.size, [&](const State& start) {
          return sheet.solve(start, {0.2, 0.4});
        }).factors);
  };
  EXPECT_LE(growth("50"), 2);
  EXPECT_GE(growth("0"), 5);
}

}  // namespace
}  // namespace drape::verify::growth_test
