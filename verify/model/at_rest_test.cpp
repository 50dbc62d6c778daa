// A scene in which nothing moves is told from one that only begins at rest.

#include "model/at_rest.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "model/scene_file/scene_file.hpp"

namespace drape::verify::at_rest_test {
namespace {

bool is_at_rest(const std::string& toml) {
  return model::is_at_rest(model::parse_scene("name = 'x'\ngrid.n = 5\n" + toml, "x"));
}

TEST(AtRest, IsASheetWithoutForcesAndVelocities) {
  EXPECT_TRUE(is_at_rest(""));
  EXPECT_TRUE(is_at_rest("material = { tension = 1e4, damping = 5, shear = 100, bend = 1e-3 }"));
  EXPECT_TRUE(is_at_rest("pins = [{ where = 'left edge' }]"));
  EXPECT_TRUE(is_at_rest("forces.wind = [0, 0, 1]\nforces.wind_constant = 0"));
}

TEST(AtRest, IsNoSheetThatWillMove) {
  for (const std::string cause :
       {"forces.gravity = [0, 0, -9.81]", "forces.wind = [0, 0, 1]",
        "forces.wind = [0, 0, 1]\nforces.wind_constant = 0\nforces.wind_frequency = 3", "start.velocity = [0, 1e-9, 0]",
        "material.tension = 10\nstart.stretch = 1.1", "pins = [{ where = 'left edge', velocity = [1, 0, 0] }]",
        "obstacles = [{ shape = 'sphere', radius = 0.1, motion = [{ time = 0, position = [0, 0, -2] }, { time = 1 }] }]"})
    EXPECT_FALSE(is_at_rest(cause)) << cause;
  for (const model::BuiltinScene& builtin : model::builtin_scenes())
    EXPECT_FALSE(model::is_at_rest(model::load_scene(std::string(builtin.name)))) << builtin.name;
}

}  // namespace
}  // namespace drape::verify::at_rest_test
