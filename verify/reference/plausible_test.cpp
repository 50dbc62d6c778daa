// A reference that was read is believed only if it can be that of the scene, whatever its checksum.

#include "reference/plausible.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/cache.hpp"
#include "reference/reference_file.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::plausible_test {
namespace {

using reference::Reference;
using testing::HasSubstr;

const std::vector<double> times{0.1, 0.2, 0.3};
constexpr double size = 0.8;

model::Cloth sheet(const char* damping) {
  const std::vector<model::Override> overrides{{"grid.n", "6"}, {"material.damping", damping}};
  return compile(model::load_scene("hung-corners", overrides));
}

Reference reference_of(const model::Cloth& cloth) {
  return reference::reference(cloth.ode, cloth.start, 0, times, {.rtol = 1e-7, .size = size});
}

class PlausibleReference : public testing::Test {
 protected:
  /// What is wrong with a reference of the sheet; empty if nothing is.
  std::string objection(const Reference& reference) const {
    try {
      require_plausible(reference, cloth.ode, cloth.start, 0, times, size);
      return "";
    } catch (const reference::DamagedFile& error) {
      return error.what();
    }
  }

  const model::Cloth cloth = sheet("5");
  const Reference right = reference_of(cloth);
};

TEST_F(PlausibleReference, IsThatOfItsScene) { EXPECT_EQ(objection(right), ""); }

TEST_F(PlausibleReference, IsNotThatOfAnotherSceneWithTheSameParticlesAndTimes) {
  EXPECT_THAT(objection(reference_of(sheet("50"))), HasSubstr("away from where the scene moves"));
}

TEST_F(PlausibleReference, IsNotOneWhosePositionsWereMovedInBothTrajectories) {
  for (const std::size_t k : {0u, 1u, 2u}) {
    Reference moved = right;
    for (auto* trajectory : {&moved.trajectory, &moved.witnessed}) trajectory->states[k].x.col(2).tail(20).array() += 0.005;
    for (std::size_t i = 0; i < times.size(); ++i)
      moved.error[i] = reference::rms_distance(moved.trajectory.states[i].x, moved.witnessed.states[i].x);
    EXPECT_NE(objection(moved), "") << k;
  }
}

TEST_F(PlausibleReference, HasTheUncertaintyOfItsTwoTrajectories) {
  Reference flattered = right;
  flattered.error[1] /= 2;
  EXPECT_THAT(objection(flattered), HasSubstr("uncertainty"));
  Reference moved = right;
  moved.trajectory.states[2].x(17, 1) += 1e-9;
  EXPECT_THAT(objection(moved), HasSubstr("uncertainty"));
}

TEST_F(PlausibleReference, HasThePinsOfTheScene) {
  Reference moved = right;
  for (auto* trajectory : {&moved.trajectory, &moved.witnessed})
    for (solver::State& y : trajectory->states) y.x.array() += 1e-5;
  for (std::size_t i = 0; i < times.size(); ++i)
    moved.error[i] = reference::rms_distance(moved.trajectory.states[i].x, moved.witnessed.states[i].x);
  EXPECT_THAT(objection(moved), HasSubstr("pinned"));
}

TEST(PlausibleReferences, MaySlideAcrossTheDirectionsOfTheirPins) {
  model::Scene scene = model::load_scene("hung-corners", std::vector<model::Override>{{"grid.n", "5"}});
  for (model::PinRule& pin : scene.pins) pin.direction = {0, 1, 3};
  const model::Cloth cloth = compile(scene);
  Reference reference = reference_of(cloth);
  const int corner = cloth.ode.pins.front().particle;
  ASSERT_GE((reference.trajectory.states[2].x - cloth.start.x).row(corner).norm(), 1e-3 * size);
  require_plausible(reference, cloth.ode, cloth.start, 0, times, size);
  for (auto* trajectory : {&reference.trajectory, &reference.witnessed}) trajectory->states[2].x(corner, 2) += 1e-4 * size;
  reference.error[2] = reference::rms_distance(reference.trajectory.states[2].x, reference.witnessed.states[2].x);
  EXPECT_THROW(require_plausible(reference, cloth.ode, cloth.start, 0, times, size), reference::DamagedFile);
}

TEST_F(PlausibleReference, HasTheTimesTheParticlesAndOnlyFiniteNumbers) {
  const std::vector<std::function<void(Reference&)>> damages{
      [](Reference& r) { r.trajectory.times[1] = 0.21; },
      [](Reference& r) { r.witnessed.states.pop_back(); },
      [](Reference& r) { r.perturbed.states[0].v.conservativeResize(5, 3); },
      [](Reference& r) { r.witnessed.states[2].v(3, 1) = std::nan(""); },
      [](Reference& r) { r.growth.clear(); },
  };
  for (const auto& damage : damages) {
    Reference damaged = right;
    damage(damaged);
    EXPECT_NE(objection(damaged), "");
  }
}

TEST_F(PlausibleReference, IsAskedForByWhoeverReadsTheCache) {
  const base::TemporaryFolder folder;
  reference::Cache cache(folder / "cache");
  cache.store("damping = 5", reference_of(sheet("50")));  // sealed, and under the right name
  const auto check = [&](const Reference& found) { require_plausible(found, cloth.ode, cloth.start, 0, times, size); };
  EXPECT_TRUE(cache.find("damping = 5"));
  EXPECT_FALSE(cache.find("damping = 5", check));
  EXPECT_EQ(cache.counts().rejected, 1);
  EXPECT_THAT(cache.messages(), testing::ElementsAre(HasSubstr("is not used: at t = 0.1 s it is")));
}

}  // namespace
}  // namespace drape::verify::plausible_test
