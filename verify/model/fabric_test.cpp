// Fabrics as they were measured, and the materials that are made of them.

#include "model/fabric.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "model/cloth.hpp"
#include "model/keys/scene_error.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/integrator.hpp"

namespace drape::verify::fabric_test {
namespace {

using model::Fabric;
using model::Material;
using model::Scene;
using testing::AnyOf;
using testing::HasSubstr;

Scene scene_with(const std::string& lines) { return model::parse_scene("name = 'x'\n" + lines, "a.toml"); }

/// k1 and k2, G, the bending stiffness along weft and warp: the survey's own numbers for these samples, rounded there.
TEST(Fabric, HasTheModuliThatWereMeasured) {
  const Material& denim = scene_with("material.fabric = 'denim'").sheet.material;
  EXPECT_EQ(denim.density, 0.324);
  EXPECT_NEAR(denim.tension.weft, 411, 0.5);
  EXPECT_NEAR(denim.tension.warp, 2028, 0.5);
  EXPECT_NEAR(denim.shear, 26.7, 0.05);
  EXPECT_NEAR(denim.contraction, 20.47, 0.01);
  EXPECT_NEAR(denim.bend.weft, 64.2e-6, 0.05e-6);
  EXPECT_NEAR(denim.bend.warp, 97.0e-6, 0.05e-6);
  const Material& knit = scene_with("material.fabric = 't-shirt'").sheet.material;
  EXPECT_NEAR(knit.tension.weft, 33.2, 0.05);
  EXPECT_NEAR(knit.tension.warp, 69.0, 0.05);
  EXPECT_EQ(knit.contraction, 0) << "where -29 N/m were measured";
}

/// B and 2HB, in the units of the instrument: 0.118 gf cm²/cm and 0.124 gf cm/cm.
TEST(Fabric, HasTheHysteresisThatKawabatasInstrumentShows) {
  constexpr double gf = 9.80665e-3;  // [N]
  const Material& broad = scene_with("material.fabric = 'cotton-broad'").sheet.material;
  EXPECT_NEAR(broad.bend.weft, 0.118 * gf * 1e-2, 1e-8);
  EXPECT_NEAR(2 * broad.friction.bend.weft, 0.124 * gf, 1e-6);
  EXPECT_NEAR(broad.friction.bend.weft / broad.bend.weft, 52.5, 0.1) << "residual curvature 2HB/2B [1/m]";
}

TEST(Fabric, IsTheMaterialThatOtherKeysChange) {
  const Scene scene = scene_with("[material]\nshear = 7\nfabric = 'tablecloth'\ndamping = 0.1");
  EXPECT_EQ(scene.fabric, "tablecloth");
  EXPECT_EQ(scene.sheet.material.density, 0.128);
  EXPECT_EQ(scene.sheet.material.shear, 7) << "wherever it stands";
  EXPECT_EQ(scene.sheet.material.damping.weft, 0.1);
  EXPECT_EQ(to_toml(model::parse_scene(to_toml(scene), "again.toml")), to_toml(scene));
}

/// The file's own moduli would leave nothing of it.
TEST(Fabric, ThatIsSetReplacesTheMaterialOfTheScene) {
  const model::Override changes[] = {{"material.damping", "0.5"}, {"material.fabric", "denim"}};
  const Scene scene = model::load_scene("hung-corners", changes);
  EXPECT_NEAR(scene.sheet.material.tension.weft, 411, 0.5);
  EXPECT_EQ(scene.sheet.material.density, 0.324);
  EXPECT_EQ(scene.sheet.material.damping.weft, 0.5);
}

class AnyFabric : public testing::TestWithParam<Fabric> {};
INSTANTIATE_TEST_SUITE_P(, AnyFabric, testing::ValuesIn(model::fabrics()), [](const auto& test) {
  std::string name = test.param.name;
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST_P(AnyFabric, IsAClothThatMoves) {
  const Fabric& fabric = GetParam();
  EXPECT_FALSE(fabric.description.empty());
  EXPECT_THAT(fabric.source, AnyOf(HasSubstr("2011"), HasSubstr("2015")));
  Scene scene = scene_with("grid.n = 4\nforces.gravity = [0, 0, -9.81]\npins = [{where = 'left edge'}]");
  scene.sheet.material = fabric.material;
  EXPECT_EQ(scene_with("material.fabric = '" + fabric.name + "'").sheet.material.density, fabric.material.density);
  const model::Cloth cloth = model::compile(scene);
  solver::Integrator integrator(cloth.ode, solver::method("bdf2"), {}, cloth.start);
  EXPECT_EQ(integrate(integrator, 0.1, 0.01).outcome, solver::Outcome::success);
}

std::string message(const std::string& toml) {
  try {
    model::read_fabric(toml, "x", "x.toml");
  } catch (const model::SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(Fabric, ThatIsWrongIsRefusedInOneLine) {
  const std::string good = "description = 'a'\nsource = 'b'\ndensity = 1\n";
  EXPECT_THAT(message("description = "), HasSubstr("x.toml"));
  EXPECT_EQ(message(good), "x.toml: expected the key 'tension'");
  EXPECT_THAT(message(good + "stretching = [[1, 2]]"),
              HasSubstr("x.toml:4: stretching = [ [ 1, 2 ] ]: expected a list of 6 numbers"));
  EXPECT_THAT(message("description = 'a'\nsource = 'b'\ndensity = -1"),
              HasSubstr("x.toml:3: density = -1: expected a number above 0"));
}

}  // namespace
}  // namespace drape::verify::fabric_test
