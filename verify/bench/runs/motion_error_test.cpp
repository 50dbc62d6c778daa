// Errors of the whole motion as bench_integrators records them, against two of its own recorded motions.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/reference.hpp"
#include "results/file/run_file.hpp"
#include "verify/support/bench_integrators.hpp"

namespace drape::verify::motion_error_test {
namespace {

using reference::rms_distance;
using results::RunRecord;
using solver::Vectors;
using testing::AllOf;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;
using testing::Lt;

constexpr int side = 5;        ///< particles
constexpr double size = 0.8;   ///< [m]
constexpr double mass = 0.64;  ///< [kg]

/// A coarse method and one that is right, on an undamped sheet that swings down.
std::vector<RunRecord> swinging(const BenchIntegrators& program) {
  program.output({"run", "--scene", "hung-edge", "--set", "grid.n=5", "--set", "material.damping=0", "--set",
                  "material.tension=100", "--until", "0.2", "--method", "implicit-euler,esdirk4", "--step", "0.005",
                  "--trajectory", "every=0.02", "--out", "runs.h5"});
  return results::read_runs(program.folder() / "runs.h5");
}

/// Parts of the mass: half of a cell at an edge, a quarter at a corner.
Eigen::VectorXd masses() {
  const auto part = [](int k) { return k == 0 || k == side - 1 ? 0.5 : 1.0; };
  Eigen::VectorXd m(side * side);
  for (int b = 0; b < side; ++b)
    for (int a = 0; a < side; ++a) m[a + side * b] = mass / ((side - 1) * (side - 1)) * part(a) * part(b);
  return m;
}

Eigen::RowVector3d angular_momentum(const solver::State& y, const Eigen::RowVector3d& centre) {
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (Eigen::Index i = 0; i < y.x.rows(); ++i)
    sum += masses()[i] * Eigen::RowVector3d(y.x.row(i) - centre).cross(Eigen::RowVector3d(y.v.row(i)));
  return sum;
}

TEST(MotionError, IsTheLargestAtTheTenthsOfTheEnd) {
  const BenchIntegrators program;
  const auto runs = swinging(program);
  ASSERT_EQ(runs.size(), 2u);
  const auto &a = *runs[0].trajectory, &b = *runs[1].trajectory;
  ASSERT_EQ(a.times.size(), 11u);
  const Vectors &start = b.states[0].x, none = Vectors::Zero(side * side, 3);
  const Eigen::RowVector3d centre = masses().transpose() * start / mass;
  double x = 0, v = 0, p = 0, l = 0, amplitude = 0, speed = 0;
  for (std::size_t k = 1; k < a.times.size(); ++k) {
    const auto &y = a.states[k], &exact = b.states[k];
    x = std::max(x, rms_distance(y.x, exact.x));
    v = std::max(v, rms_distance(y.v, exact.v));
    p = std::max(p, (masses().transpose() * (y.v - exact.v)).norm());
    l = std::max(l, (angular_momentum(y, centre) - angular_momentum(exact, centre)).norm());
    amplitude = std::max(amplitude, rms_distance(exact.x, start));
    speed = std::max(speed, rms_distance(exact.v, none));
  }
  const results::MotionErrorRecord& error = runs[0].motion_error.value();
  const auto near = [](double value) { return AllOf(Ge(0.98 * value), Le(1.02 * value)); };
  EXPECT_THAT(error.position, near(x / size));
  EXPECT_THAT(error.amplitude, near(amplitude / size));
  EXPECT_THAT(error.relative, near(x / amplitude));
  EXPECT_THAT(error.velocity, near(v / speed));
  EXPECT_THAT(error.momentum, near(p / (mass * speed)));
  EXPECT_THAT(error.angular_momentum, near(l / (mass * speed * size)));
  EXPECT_LE(error.reference_velocity, 1e-6);
  EXPECT_GE(error.position, runs[0].error->rms);
  EXPECT_LE(runs[1].motion_error->position, error.position / 50);
}

TEST(MotionError, HasTheDriftOfTheEnergyOfAnUndampedSheet) {
  const BenchIntegrators program;
  const auto runs = swinging(program);
  ASSERT_EQ(runs.size(), 2u);
  const auto energy = [](const results::StepRecord& s) { return s.kinetic_energy + s.potential_energy; };
  const double start = energy(runs[1].steps.front());
  double scale = 0, drift = 0;
  for (std::size_t k = 3; k < runs[1].steps.size(); k += 4) {
    const results::StepRecord& exact = runs[1].steps[k];
    scale = std::max(scale, exact.kinetic_energy + std::abs(exact.potential_energy - start));
    drift = std::max(drift, std::abs(energy(runs[0].steps[k]) - start));
  }
  EXPECT_THAT(runs[0].motion_error.value().energy, AllOf(Ge(0.98 * drift / scale), Le(1.02 * drift / scale)));
  EXPECT_GE(drift / scale, 1e-3) << "or it would say nothing";
}

TEST(MotionError, OfASheetAtRestIsSmallAndFinite) {
  const BenchIntegrators program;
  program.output({"run", "--scene", "hung-edge", "--set", "grid.n=5", "--set", "forces.gravity=[0, 0, 0]", "--until", "0.05",
                  "--method", "bdf2", "--step", "0.01", "--out", "runs.h5"});
  const RunRecord run = results::read_runs(program.folder() / "runs.h5").at(0);
  EXPECT_THAT(run.error.value().energy, AllOf(Ge(0.0), Lt(1e-6)));
  const results::MotionErrorRecord& error = run.motion_error.value();
  for (const double number : {error.position, error.relative, error.velocity, error.reference_velocity, error.energy,
                              error.momentum, error.angular_momentum})
    EXPECT_THAT(number, AllOf(Ge(0.0), Lt(1e-6)));
}

TEST(MotionError, IsAbsentInOlderFilesWhichAreReadAndComparedAllTheSame) {
  const BenchIntegrators program;
  const std::string old = DRAPE_SOURCE_DIR "/verify/data/runs-schema-4.h5";
  EXPECT_FALSE(results::read_runs(old).at(0).motion_error);
  EXPECT_THAT(program.output({"compare", old, old, "--no-times"}), HasSubstr("accuracy: same (1 cells: 0 worse"));
}

TEST(MotionError, IsShownBesideThatAtTheEnd) {
  const BenchIntegrators program;
  const std::string table = program.output(
      {"run", "--scene", "hung-edge", "--set", "grid.n=5", "--until", "0.05", "--method", "implicit-euler", "--step", "0.01"});
  EXPECT_THAT(table, AllOf(HasSubstr("over the run"), HasSubstr("of its motion")));
}

}  // namespace
}  // namespace drape::verify::motion_error_test
