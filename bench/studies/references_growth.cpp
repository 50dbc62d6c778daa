#include "bench/studies/references_growth.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/growth.hpp"
#include "reference/sundials/cvode.hpp"

namespace drape::bench {
namespace {

constexpr double bar = 2;       ///< largest factor by which the growth may be underestimated
constexpr double rtol = 1e-12;  // differences of 1e-7 are taken
constexpr int rounds[] = {0, 1, 2, 6};

struct GrowthScene {
  const char *scene, *damping;
  double end;  ///< [s]
};
constexpr std::array<GrowthScene, growth_parts> growing{
    {{"hung-corners", "0", 0.3}, {"hung-corners", "0.05", 0.4}, {"hung-corners", "5", 0.3}, {"wind", "5", 0.3}}};

/// Of the perturbation that each number of rounds finds, and the largest of all.
struct Growths {
  std::vector<double> found;
  double largest = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Growths, found, largest)

Growths grow(const model::Scene& scene) {
  const model::Cloth cloth = model::compile(scene);
  const double size = model::size(scene);
  const std::vector<double> times{scene.end};
  const auto solve = [&](const solver::State& start) {
    return reference::cvode(cloth.ode, start, 0, times, {.rtol = rtol, .size = size});
  };
  const reference::Trajectory motion = solve(cloth.start);
  Growths growths;
  for (const int count : rounds) {
    const solver::State direction = reference::fastest_growing(cloth.ode, cloth.start, 0, times, size, count);
    growths.found.push_back(reference::growth_along(direction, cloth.start, motion, size, solve).factors.back());
  }
  growths.largest = reference::largest_growth(cloth.ode, cloth.start, 0, motion, size, solve);
  return growths;
}

void add_row(results::TableBuilder& table, const model::Scene& scene, const Growths& growths) {
  table.row();
  table.text("scene", "scene", "its name", scene.name);
  table.count("n", "n", "particles a side", scene.sheet.grid.nu);
  table.number("damping", "d", "N s/m", "linear damping", scene.sheet.material.damping.weft);
  table.number("end", "end", "s", "when it is measured", scene.end);
  table.number("largest", "largest", "1", "largest singular value of the motion, by differences", growths.largest);
  for (std::size_t k = 0; k < growths.found.size(); ++k)
    table.number(fmt::format("rounds_{}", rounds[k]).c_str(), fmt::format("{} rounds", rounds[k]).c_str(), "1",
                 "growth of the perturbation that so many rounds find", growths.found[k]);
  const double factor = growths.largest / growths.found.back();
  table.number("factor", "factor", "1", "the largest over the last", factor);
  table.text("verdict", "verdict", "whether the factor is at most 2", factor <= bar ? "as wanted" : "NOT as wanted");
}

}  // namespace

results::Table growth_of_perturbations(bool quick, Checkpoint& checkpoint) {
  results::TableBuilder table("growth",
                              "Growth of a small perturbation of the start: of the one that grows most, as rounds of the "
                              "power method find it, and of any");
  for (const GrowthScene& sheet : growing) {
    std::vector<model::Override> overrides{{"grid.n", quick ? "4" : "6"}, {"material.damping", sheet.damping}};
    if (std::string_view(sheet.scene) == "wind") overrides.push_back({"start.pleats", "[1, 35]"});  // as many as it can have
    model::Scene scene = model::load_scene(sheet.scene, overrides);
    scene.end = quick ? sheet.end / 2 : sheet.end;
    const std::string name = fmt::format("growth on {}, d = {}", sheet.scene, sheet.damping);
    checkpoint.show(name);
    add_row(table, scene, checkpoint.once(name, [&] { return grow(scene); }));
    checkpoint.advance();
  }
  return table.finish();
}

}  // namespace drape::bench
