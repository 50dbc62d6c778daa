// Forces that are added: what rows have to be, and what scenes make of them. Those that are added stay: in processes of their
// own.

#include "model/scene_file/added_forces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::verify::added_forces_test {
namespace {

using model::ForceParameter;
using model::Scene;
using model::SceneError;
using model::Term;
using model::TermKind;
using solver::Vectors;
using testing::HasSubstr;

constexpr ForceParameter lift[] = {{.name = "lift", .unit = "N", .description = "on every particle"},
                                   {.name = "turns", .unit = "1", .description = "has no part", .usual = 3}};

/// Lifts every particle, on sheets along normals.
std::optional<Term> make(const model::Sheet& sheet, std::span<const double> parameters) {
  if (sheet.grid.nu == 7) throw std::invalid_argument("expected other than 7 particles");
  Term term;
  term.force = [=](const model::Configuration& c, Vectors& f) { f += parameters[0] * c.normals; };
  term.needs_normals = true;
  term.active = true;
  return term;
}

TermKind row() { return {.name = "balloon", .description = "lifts", .make = make, .parameters = lift}; }

std::string refusal(const TermKind& kind) {
  try {
    model::add_forces(std::vector{kind}, "");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(AddedForces, HaveCompleteRows) {
  const auto with = [](const std::function<void(TermKind&)>& change) {
    TermKind kind = row();
    change(kind);
    return refusal(kind);
  };
  EXPECT_THAT(with([](TermKind& kind) { kind.name = "Balloon"; }), HasSubstr("force 'Balloon': expected a name of small"));
  EXPECT_THAT(with([](TermKind& kind) { kind.name = "shear"; }), HasSubstr("force 'shear': there is one of this name"));
  EXPECT_THAT(with([](TermKind& kind) { kind.name = "drag"; }), HasSubstr("force 'drag': there is one of this name"));
  EXPECT_THAT(with([](TermKind& kind) { kind.make = nullptr; }), HasSubstr("expected a description and a function"));
  EXPECT_THAT(with([](TermKind& kind) { kind.description = ""; }), HasSubstr("expected a description and a function"));
  EXPECT_THAT(with([](TermKind& kind) { kind.parameters = {}; }), HasSubstr("expected at least one parameter"));
  const auto with_parameter = [&](const ForceParameter& parameter) {
    const ForceParameter all[] = {lift[0], parameter};
    return with([&](TermKind& kind) { kind.parameters = all; });
  };
  EXPECT_THAT(with_parameter(lift[0]), HasSubstr("parameter 'lift': expected names that differ"));
  EXPECT_THAT(with_parameter({.name = "a.b", .unit = "1", .description = "x"}), HasSubstr("parameter 'a.b': expected a name"));
  EXPECT_THAT(with_parameter({.name = "a", .unit = "", .description = "x"}), HasSubstr("parameter 'a': expected a unit"));
  EXPECT_THAT(with_parameter({.name = "a", .unit = "1", .description = "x", .range = ForceParameter::Range::positive}),
              HasSubstr("parameter 'a': expected a usual value in its range"));
}

/// In a process of its own, in which the force is there. Exit code 0 if all is well.
template <class Body>
void with_balloon(const Body& body) {
  EXPECT_EXIT(
      {
        model::add_forces(std::vector{row()}, "code");
        body();
        std::_Exit(testing::Test::HasFailure() ? 1 : 0);
      },
      testing::ExitedWithCode(0), "");
}

TEST(AddedForces, AreInScenesThatHaveOneOfTheirKeys) {
  with_balloon([] {
    const std::string without = to_toml(model::parse_scene("name = 'x'", "x"));
    EXPECT_THAT(without, testing::Not(HasSubstr("balloon")));
    const Scene scene = model::parse_scene("name = 'x'\ngrid.n = 4\nforces.balloon.lift = 2", "x");
    EXPECT_THAT(to_toml(scene), HasSubstr("forces.balloon.lift = 2\nforces.balloon.turns = 3\n"));
    EXPECT_EQ(to_toml(model::parse_scene(to_toml(scene), "x")), to_toml(scene));
    ASSERT_EQ(scene.sheet.added.size(), 1u);
    EXPECT_EQ(scene.sheet.added[0].code, "code");
    const model::Cloth cloth = model::compile(scene);
    EXPECT_THAT(cloth.plan.terms, testing::ElementsAre("balloon"));
    EXPECT_TRUE(cloth.given) << "it feeds energy";
    Vectors f;
    cloth.ode.force(0, cloth.start.x, cloth.start.v, f);
    EXPECT_EQ(f, Vectors(2 * Eigen::RowVector3d(0, 0, 1).replicate(16, 1)));
  });
}

TEST(AddedForces, RefuseSheetsThatCannotHaveThem) {
  with_balloon([] {
    const auto said = [](const std::string& grid) -> std::string {
      try {
        model::parse_scene("name = 'x'\nforces.balloon.lift = 2\n" + grid, "x.toml");
      } catch (const SceneError& error) {
        return error.what();
      }
      return "";
    };
    EXPECT_EQ(said("grid.n = 4"), "");
    EXPECT_EQ(said("grid.n = 7"), "x.toml: forces.balloon: expected other than 7 particles");
    EXPECT_EQ(said("grid.n = [4, 1]"), "x.toml: forces.balloon: expected a sheet, a chain has no normals");
    EXPECT_EQ(said("[[panels]]\nname = 'a'\n[[panels]]\nname = 'b'\ngrid.n = 7"),
              "x.toml: panel 'b': forces.balloon: expected other than 7 particles");
  });
}

}  // namespace
}  // namespace drape::verify::added_forces_test
