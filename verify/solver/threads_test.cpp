// Whole steps of large sheets: the same for any number of threads, contacts and counters included.

#include "verify/support/threads.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/integrator.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::threads_test {
namespace {

using Changes = std::vector<model::Override>;

/// What two steps of a method come to.
struct Motion {
  solver::State y;
  std::vector<std::pair<std::string, std::int64_t>> counts;
};

Motion motion(const std::string& scene, const Changes& changes, const std::string& method, int threads) {
  const Threads allowed(threads);
  const model::Cloth cloth = model::compile(model::load_scene(scene, changes));
  solver::Integrator integrator(cloth.ode, solver::method(method), {}, cloth.start);
  for (int k = 0; k < 2; ++k) EXPECT_EQ(integrator.step(2e-3).outcome, solver::Outcome::success) << method;
  Motion result{integrator.state(), {}};
  for (const solver::Counters::Kind& kind : cloth.ode.work->kinds()) result.counts.emplace_back(kind.name, kind.count);
  return result;
}

void expect_the_same(const std::string& scene, const Changes& changes, const std::string& method) {
  const Motion by_one = motion(scene, changes, method, 1), by_three = motion(scene, changes, method, 3);
  EXPECT_EQ(by_three.y.x, by_one.y.x) << scene << ", " << method;
  EXPECT_EQ(by_three.y.v, by_one.y.v) << scene << ", " << method;
  EXPECT_EQ(by_three.counts, by_one.counts) << scene << ", " << method;
}

TEST(StepsWithThreads, AreTheSameOnLargeSheets) {
  DRAPE_SLOW();
  for (const char* method : {"verlet", "sbdf2", "bdf2"})
    expect_the_same("hung-corners", {{"grid.n", "201"}, {"material.damping", "0.5"}}, method);
}

TEST(StepsWithThreads, AreTheSameInContact) {
  DRAPE_SLOW();
  expect_the_same("ball", {{"grid.n", "201"}}, "sbdf2");
}

TEST(StepsWithThreads, AreTheSameWithFactoredNewtonMatrices) {
  expect_the_same("hung-corners", {{"grid.n", "49"}, {"material.damping", "0.5"}, {"material.tension", "1e6"}},
                  "baraff-witkin");
  expect_the_same("hung-corners", {{"grid.n", "49"}, {"material.damping", "0.5"}, {"material.tension", "1e6"}},
                  "implicit-euler");
}

}  // namespace
}  // namespace drape::verify::threads_test
