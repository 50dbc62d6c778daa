// Compiling makes of a scene only what it needs: the plan, the counters of work, matrices and masses.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "model/scene_file/scene_file.hpp"
#include "verify/support/model_fixtures.hpp"

namespace drape::verify::compile_test {
namespace {

using namespace sheets;
using model::Cloth;
using model::compile;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Key;
using testing::Pair;
using testing::UnorderedElementsAre;

std::map<std::string, std::int64_t> counts(const SplitOde& ode) {
  std::map<std::string, std::int64_t> all;
  for (const auto& kind : ode.work->kinds()) all[kind.name] = kind.count;
  return all;
}

/// The counts that are not zero after three forces, two explicit forces and one Jacobian.
std::map<std::string, std::int64_t> work_of(const Cloth& cloth) {
  Vectors f;
  SparseMatrix dx, dv;
  const auto& [x, v, z] = cloth.start;
  for (int k = 0; k < 3; ++k) cloth.ode.force(0, x, v, f);
  for (int k = 0; k < 2; ++k) cloth.ode.explicit_force(0, x, v, f);
  cloth.ode.jacobian(0, x, v, dx, dv);
  cloth.ode.potential_energy(0, x);
  auto all = counts(cloth.ode);
  std::erase_if(all, [](const auto& entry) { return entry.second == 0; });
  return all;
}

Cloth cloth_of(const std::string& name) { return compile(scene_of(force_case(name), five_by_four())); }

TEST(Compile, RegistersEveryKindOfWorkWithZero) {
  const Cloth cloth = compile(Scene{});
  const auto all = counts(cloth.ode);
  EXPECT_THAT(all, Each(Pair(testing::_, 0)));
  EXPECT_THAT(all, IsSupersetOf({Key("forces"), Key("explicit_forces"), Key("jacobians"), Key("normals")}));
  for (const auto& kind : model::term_kinds()) EXPECT_THAT(all, Contains(Key("force/" + std::string(kind.name))));
  for (const auto& kind : cloth.ode.work->kinds()) EXPECT_FALSE(kind.description.empty()) << kind.name;
}

TEST(Compile, CountsThePresentForcesAndLeavesTheAbsentAtZero) {
  const auto with = [](auto... more) {
    return UnorderedElementsAre(Pair("forces", 3), Pair("explicit_forces", 2), Pair("jacobians", 1), more...);
  };
  EXPECT_THAT(work_of(compile(Scene{})), with());
  EXPECT_THAT(work_of(cloth_of("tension")), with(Pair("force/tension", 5)));
  EXPECT_THAT(work_of(cloth_of("linear_damping")), with(Pair("force/damping", 3)));  // all of it is D v
  EXPECT_THAT(work_of(cloth_of("projected_damping")), with(Pair("force/projected-damping", 5)));
  EXPECT_THAT(work_of(cloth_of("shear")), with(Pair("force/shear", 5)));
  EXPECT_THAT(work_of(cloth_of("printed_shear")), with(Pair("force/printed-shear", 5)));
  EXPECT_THAT(work_of(cloth_of("contraction")), with(Pair("force/contraction", 5)));
  EXPECT_THAT(work_of(cloth_of("unprojected_plate")), with(Pair("force/plate", 5)));
  EXPECT_THAT(work_of(cloth_of("gravity")), with(Pair("force/gravity", 5)));
  EXPECT_THAT(work_of(cloth_of("plate")), with(Pair("force/plate", 5), Pair("normals", 6)));
  EXPECT_THAT(work_of(cloth_of("wind")), with(Pair("force/wind", 5), Pair("normals", 6)));
  EXPECT_THAT(work_of(cloth_of("air")), with(Pair("force/air", 5), Pair("normals", 6)));
  EXPECT_THAT(work_of(cloth_of("membrane")), with(Pair("force/membrane", 5), Pair("normals", 6)));
}

TEST(Compile, PlansExactlyTheForcesWithNonzeroCoefficients) {
  EXPECT_THAT(compile(Scene{}).plan.terms, IsEmpty());
  EXPECT_THAT(cloth_of("all_with_energies").plan.terms,
              ElementsAre("tension", "projected-damping", "shear", "contraction", "plate", "gravity"));
  EXPECT_THAT(cloth_of("all_of_the_thesis").plan.terms,
              ElementsAre("tension", "damping", "printed-shear", "contraction", "plate", "gravity"));
  EXPECT_THAT(cloth_of("membrane").plan.terms, ElementsAre("membrane"));
}

TEST(Compile, PlansAForceThatIsViscousOnly) {
  Scene scene;
  scene.sheet.material.shear_damping = 1;
  scene.sheet.material.contraction_damping = 1;
  scene.sheet.material.bend_damping = {0, 1};
  EXPECT_THAT(compile(scene).plan.terms, ElementsAre("shear", "contraction", "plate"));
}

TEST(Compile, PlansNormalsOnlyIfAForceAsks) {
  for (const ForceCase& force : force_cases()) {
    const bool asks = force.name == "membrane" || force.name == "plate" || force.name == "printed_plate" ||
                      force.name == "printed_is_border" || force.wind.needs_normals() || force.air != 0 ||
                      force.name.starts_with("all_of") || force.name == "all_with_a_membrane";
    EXPECT_EQ(cloth_of(force.name).plan.normals, asks) << force.name;
  }
}

TEST(Compile, GivesChainsNoForceThatNeedsCells) {
  const Scene scene = scene_of(force_case("all_with_energies"), {6, 1, 1, 0.1});
  EXPECT_THAT(compile(scene).plan.terms, ElementsAre("tension", "projected-damping", "plate", "gravity"));
}

TEST(Compile, GivesMatricesNoEntriesWithoutModuli) {
  for (const ForceCase& force : force_cases()) {
    const Cloth cloth = cloth_of(force.name);
    const Material& m = force.material;
    const int particles = five_by_four().particles(), edges = 31;
    const int entries = particles + 2 * edges;
    EXPECT_EQ(cloth.plan.stiffness_entries, m.tension.any() ? entries : 0) << force.name;
    EXPECT_EQ(cloth.plan.damping_entries, m.damping.any() && m.damping_form == DampingForm::linear ? entries : 0) << force.name;
    EXPECT_EQ(cloth.ode.stiffness.nonZeros(), cloth.plan.stiffness_entries);
    EXPECT_EQ(cloth.ode.damping.nonZeros(), cloth.plan.damping_entries);
  }
}

TEST(Compile, GivesMatricesNoEntriesAlongADirectionWithoutModulus) {
  Scene scene;
  scene.sheet.grid = five_by_four();
  scene.sheet.material.tension = {0, 5};
  EXPECT_EQ(compile(scene).plan.stiffness_entries, 20 + 2 * 15);
}

TEST(Compile, DescribesThePlanInOneLine) {
  Scene scene = scene_of(force_case("all_of_the_thesis"), five_by_four());
  scene.pins = {{.where = "corners", .particles = {}, .directions = {true, false, true}}};
  EXPECT_EQ(to_string(compile(scene).plan),
            "20 particles, 8 of 60 degrees of freedom pinned; forces: tension, damping, printed-shear, contraction, plate, "
            "gravity; normals: yes; internal variables: 0; obstacles: 0; entries of K: 82, of D: 82");
  EXPECT_THAT(to_string(compile(Scene{}).plan), testing::HasSubstr("forces: none; normals: no"));
}

TEST(Compile, GivesDualCellMassesThatSumToDensityTimesArea) {
  for (const auto& [name, grid] : grids()) {
    if (grid.outline.given() || grid.is_cut()) continue;
    Scene scene;
    scene.sheet.grid = grid;
    scene.sheet.material.density = 0.3;
    const double whole = 0.3 * grid.size_u * grid.size_v;
    EXPECT_NEAR(compile(scene).ode.mass.sum(), whole, 1e-14 * whole) << name;
  }
}

TEST(Compile, GivesHalfTheMassOnBordersAndAQuarterInCorners) {
  Scene scene;
  scene.sheet.grid = {3, 3, 1, 1};
  Eigen::VectorXd expected(9);
  expected << 1, 2, 1, 2, 4, 2, 1, 2, 1;
  EXPECT_EQ(compile(scene).ode.mass, expected / 16);
}

TEST(Compile, GivesEveryParticleItsWeight) {
  const Cloth cloth = cloth_of("gravity");
  EXPECT_EQ(evaluate(cloth.ode.force, cloth.start), Vectors(cloth.ode.mass * force_case("gravity").gravity.transpose()));
}

TEST(Compile, LeavesTwoClothsOfOneSceneIndependent) {
  const Scene scene = scene_of(force_case("tension"), five_by_four());
  const Cloth one = compile(scene), other = compile(scene);
  work_of(one);
  EXPECT_EQ(other.ode.work->count("forces"), 0);
}

}  // namespace
}  // namespace drape::verify::compile_test
