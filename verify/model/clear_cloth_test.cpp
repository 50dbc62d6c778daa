// Cloth that cannot meet itself is refused in one line that says where.

#include "model/clear_cloth.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "model/scene_file/scene_file.hpp"

namespace drape::verify::clear_cloth_test {
namespace {

using testing::HasSubstr;

std::string complaint(const std::string& toml) {
  try {
    model::require_clear_cloth(model::parse_scene("name = 'a'\n" + toml, "a.toml"));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

/// Two squares of 4 × 4 particles and 0.3 m; `upper`: the start of the second.
std::string plates(const std::string& upper, const std::string& thickness = "0.01") {
  return "contact.thickness = " + thickness +
         "\n[grid]\nn = 4\nsize = 0.3\n[[panels]]\nname = 'lower'\n[[panels]]\nname = 'upper'\n" + upper;
}

TEST(ClearCloth, BeginsApartFromItself) {
  EXPECT_EQ(complaint(plates("start.position = [0.02, 0.01, 0.0101]")), "");
  EXPECT_EQ(complaint(plates("start.position = [0.02, 0.01, 0]", "0")), "");
  EXPECT_THAT(
      complaint(plates("start.position = [0.02, 0.01, 0.0099]")),
      AllOf(HasSubstr("expected cloth to begin at least contact.thickness = 0.01 m from itself, not 0.0099 m as particle ["),
            HasSubstr("of panel 'upper'"), HasSubstr("of panel 'lower'")));
}

TEST(ClearCloth, DoesNotBeginThroughItself) {
  EXPECT_THAT(complaint(plates("start.position = [0.02, 0.01, -0.02]\nstart.rotation = [20, 0, 0]")),
              AllOf(HasSubstr("expected cloth that does not begin through itself, as cell ["),
                    HasSubstr("of panel 'lower' and cell ["), HasSubstr("of panel 'upper' do")));
}

TEST(ClearCloth, IsThatOfScenesWhereClothMeetsItself) {
  for (const char* name : {"sphere_drop", "cloth_stack", "twist", "curtain_drawn"}) {
    const model::Scene scene = model::load_scene(name);
    EXPECT_GT(scene.contact.thickness, 0) << name;
    EXPECT_NO_THROW(model::require_clear_cloth(scene)) << name;
  }
}

TEST(ClearCloth, IsThinnerThanItsTriangles) {
  const std::string sheet = "[grid]\nn = [4, 2]\nsize = [0.3, 0.1]\n[contact]\nthickness = ";  // altitudes of 0.1/√2 m
  EXPECT_EQ(complaint(sheet + "0.0353"), "");
  EXPECT_THAT(
      complaint(sheet + "0.0354"),
      HasSubstr(
          "contact.thickness = 0.0354: expected at most half of the smallest altitude of triangles, 0.0354 m in cell [0, 0]"));
}

/// Neighbours of pulled nodes are as near as in a sewn sheet once the nodes have met.
TEST(ClearCloth, MayBePulledTogetherBySeams) {
  const auto two_sheets = [](const char* seams) {
    return fmt::format(
        "grid = {{ n = 5, size = 0.1 }}\ncontact.thickness = 0.005\nphases = [{{ until = 0.1, seams = '{}' }}]\n"
        "end = {{ time = 0.2 }}\n[[panels]]\nname = 'one'\n[[panels]]\nname = 'other'\nstart.position = [0.103, 0, 0]\n"
        "[[seams]]\none = {{ panel = 'one', side = 'right' }}\nother = {{ panel = 'other', side = 'left' }}\n",
        seams);
  };
  EXPECT_EQ(complaint(two_sheets("pulled")), "");
  EXPECT_THAT(complaint(two_sheets("open")),
              HasSubstr("expected cloth to begin at least contact.thickness = 0.005 m from itself, "
                        "not 0.003 m as particle"));
}

}  // namespace
}  // namespace drape::verify::clear_cloth_test
