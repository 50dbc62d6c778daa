#include "bench/studies/references_growth.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/growth.hpp"
#include "reference/sundials/cvode.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"

namespace drape::bench {
namespace {

constexpr double bar = 2;       ///< largest factor by which the growth may be underestimated
constexpr double rtol = 1e-12;  // differences of 1e-7 are taken
constexpr int rounds[] = {0, 1, 2, 6};

struct GrowthScene {
  const char *scene, *damping;
  double end;                    ///< [s]
  const char* pleats = nullptr;  ///< of its start, if not those of its file
};
constexpr std::array<GrowthScene, 4> growing{
    {{"hung-corners", "0", 0.3}, {"hung-corners", "0.05", 0.4}, {"hung-corners", "5", 0.3}, {"wind", "5", 0.3, "[1, 35]"}}};

/// Growth of the perturbation that each number of rounds finds, and the largest of all.
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

/// A sheet with its growths.
struct Grown {
  model::Scene scene;
  Growths growths;

  double factor() const { return growths.largest / growths.found.back(); }
};

using results::Cell;
using results::ColumnOf;
using results::Role;
using results::Standing;

constexpr ColumnOf<Grown> sheet_columns[] = {
    {"scene", "scene", "", "its name", Role::key, [](const Grown& row) -> Cell { return row.scene.name; }},
    {"n", "n", "1", "particles a side", Role::key, [](const Grown& row) { return results::to_cell(row.scene.sheet.grid.nu); }},
    {"damping", "d", "N s/m", "linear damping", Role::key,
     [](const Grown& row) -> Cell { return row.scene.sheet.material.damping.weft; }},
    {"end", "end", "s", "when it is measured", Role::key, [](const Grown& row) -> Cell { return row.scene.end; }},
    {"largest", "largest", "1", "largest singular value of the motion, by differences", Role::quantity,
     [](const Grown& row) -> Cell { return row.growths.largest; }},
};

constexpr ColumnOf<double> round_columns[] = {
    {"rounds_{}", "{} rounds", "1", "growth of the perturbation found in this number of rounds", Role::quantity,
     [](const double& growth) -> Cell { return growth; }},
};

results::Verdict judge(double factor) {
  return factor <= bar ? results::Verdict{Standing::met, "as wanted"} : results::Verdict{Standing::missed, "not as wanted"};
}

constexpr ColumnOf<Grown> factor_columns[] = {
    {"factor", "factor", "1", "the largest over the last", Role::quantity,
     [](const Grown& row) -> Cell { return row.factor(); }},
    {"verdict", "verdict", "", "whether the factor is at most 2", Role::verdict,
     [](const Grown& row) -> Cell { return judge(row.factor()); }},
};

results::Table to_table(const std::vector<Grown>& rows) {
  results::Table table =
      results::make_table("growth",
                          "Growth of a small perturbation of the start: of the one that grows most, as rounds "
                          "of the power method find it, and of any",
                          sheet_columns, rows);
  for (std::size_t k = 0; k < std::size(rounds); ++k) {
    const std::string count = std::to_string(rounds[k]);
    results::add_columns(table, round_columns, rows, [k](const Grown& row) { return &row.growths.found[k]; },
                         {count, count, {}});
  }
  results::add_columns(table, factor_columns, rows);
  return table;
}

std::vector<Grown> grown(bool quick, Checkpoint& checkpoint) {
  std::vector<Grown> rows;
  for (const GrowthScene& sheet : growing) {
    std::vector<model::Override> overrides{{"grid.n", quick ? "4" : "6"}, {"material.damping", sheet.damping}};
    if (sheet.pleats != nullptr) overrides.push_back({"start.pleats", sheet.pleats});
    model::Scene scene = model::load_scene(sheet.scene, overrides);
    scene.end = quick ? sheet.end / 2 : sheet.end;
    const std::string name = fmt::format("growth on {}, d = {}", sheet.scene, sheet.damping);
    checkpoint.show(name);
    rows.push_back({scene, checkpoint.once(name, [&] { return grow(scene); })});
    checkpoint.advance();
  }
  return rows;
}

}  // namespace

Job growth_of_perturbations(bool quick) {
  return job(
      "growth", static_cast<int>(growing.size()), [quick](Checkpoint& checkpoint) { return grown(quick, checkpoint); },
      to_table);
}

}  // namespace drape::bench
