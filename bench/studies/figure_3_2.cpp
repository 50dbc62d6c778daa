#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/studies.hpp"
#include "model/scene_file.hpp"
#include "results/table_builder.hpp"

namespace drape::bench {
namespace {

/// Energy [J] of the bending along u, wave by wave: the sine transform of the second differences of every line, so that the
/// parts add up to ½ B ∫ |s_uu|² as the plate has it. Wave m has m half-waves between the side edges.
Eigen::VectorXd bending_energy(const model::Sheet& sheet, const solver::Vectors& x) {
  const model::Grid& grid = sheet.grid;
  const int waves = grid.nu - 2;
  const double l = grid.spacing_u();
  Eigen::MatrixXd sine(waves, waves);  // orthogonal
  for (int m = 0; m < waves; ++m)
    for (int a = 0; a < waves; ++a)
      sine(m, a) = std::sqrt(2.0 / (waves + 1)) * std::sin(std::numbers::pi * (m + 1) * (a + 1) / (waves + 1));
  Eigen::VectorXd energy = Eigen::VectorXd::Zero(waves);
  for (int b = 0; b < grid.nv; ++b) {
    const auto line = x.middleRows(grid.index(0, b), grid.nu);
    const Eigen::MatrixXd curvature =
        (line.topRows(waves) - 2 * line.middleRows(1, waves) + line.bottomRows(waves)) / (l * l);
    energy += 0.5 * sheet.material.bend.weft * grid.cell_area(1, b) * (sine * curvature).rowwise().squaredNorm();
  }
  return energy;
}

/// What is to be seen of a sheet in the wind in the last part of a run, means over time.
struct Flutter {
  std::string name;
  results::RunRecord run;
  std::vector<double> swing;  ///< mean of the free edge's distances from its plane at the start, at every step [m]
  double wrinkles = 0;        ///< root mean square distance of the free edge from this mean [m]
  Eigen::VectorXd energy;     ///< wave by wave [J]
};

Flutter flutter(const model::Scene& scene, const char* method, double step, double last) {
  const model::Grid& grid = scene.sheet.grid;
  Flutter seen{fmt::format("{}, {} s", method, step), {}, {}, 0, Eigen::VectorXd::Zero(grid.nu - 2)};
  seen.run = record({scene, "", &solver::method(method), step, {}}, [&](const solver::StepReport& s) {
    if (s.t <= scene.end - last) return;
    const Eigen::ArrayXd edge = s.y.x.col(1).head(grid.nu);  // the lower one
    seen.swing.push_back(edge.mean());
    seen.wrinkles += (edge - edge.mean()).square().mean();
    seen.energy += bending_energy(scene.sheet, s.y.x);
  });
  const auto steps = static_cast<double>(seen.swing.size());
  seen.wrinkles = std::sqrt(seen.wrinkles / steps);
  seen.energy /= steps;
  return seen;
}

results::Table compute(bool, Progress& progress) {
  results::TableBuilder table("figure-3.2", "");
  const auto scene = model::load_scene("wind");
  std::vector<Flutter> all;
  for (auto [m, h] : {std::pair{"implicit-euler", 0.01}, {"bdf2", 0.01}, {"bdf2", 0.005},{"midpoint", 0.01}, {"bdf2", 0.0025}, {"bdf2", 0.00125}, {"bdf2", 0.01/16}, {"midpoint", 0.00125}}) {
    all.push_back(flutter(scene, m, h, 1));
    table.row();
    const auto& f = all.back();
    table.text("n", "n", "", f.name);
    table.text("o", "o", "", f.run.outcome);
    const auto [lo, hi] = std::ranges::minmax(f.swing);
    table.number("pp", "pp", "m", "", hi - lo);
    table.number("wr", "wrinkles", "m", "", f.wrinkles);
    table.number("E", "E", "J", "", f.energy.sum());
    for (int m2 = 0; m2 < f.energy.size(); ++m2) table.number(fmt::format("e{}", m2).c_str(), fmt::format("e{}", m2+1).c_str(), "1", "", f.energy[m2]*1e6);
    progress.advance();
  }
  return table.finish();
}

}  // namespace

std::vector<TableJob> figure_3_2(bool quick) {
  return {{8, [quick](Progress& progress) { return compute(quick, progress); }}};
}

}  // namespace drape::bench
