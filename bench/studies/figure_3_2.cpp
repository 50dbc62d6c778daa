#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "bench/runs/record.hpp"
#include "bench/studies/studies.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/table_builder.hpp"

namespace drape::bench {
namespace {

constexpr double figure_step = 0.01;  ///< [s]
constexpr double last = 1;            ///< part of the run that is looked at [s]
constexpr double smoothed = 0.95;     ///< energy over the truth's below which it counts as smoothed away

/// Waves between the side edges: the cosines, orthogonal in the dual cells along a line, and the sines of its inner particles.
/// Row m - 1 has m half-waves, 1 ≤ m ≤ n - 2.
class Waves {
 public:
  explicit Waves(const model::Scene& scene) : sheet_(scene.sheet), cosine_(count(), count() + 2), sine_(count(), count()) {
    const double n = count() + 1, norm = std::sqrt(2 / n);
    for (int m = 1; m <= count(); ++m)
      for (int a = 0; a < count() + 2; ++a) {
        const double phase = std::numbers::pi * m * a / n;
        cosine_(m - 1, a) = norm * model::Grid::dual_width(a, count() + 2) * std::cos(phase);
        if (a > 0 && a <= count()) sine_(m - 1, a - 1) = norm * std::sin(phase);
      }
  }

  int count() const { return sheet_.grid.nu - 2; }

  /// ½ B ∫ |s_uu|² of every wave [J]: they add up to the plate's energy of bending along u.
  Eigen::VectorXd bending(const solver::Vectors& x) const {
    const double l = sheet_.grid.spacing_u();
    return sum(
        0.5 * sheet_.material.bend.weft / (l * l * l * l),
        [&](const auto& line) -> Eigen::MatrixXd {
          return sine_ * (line.topRows(count()) - 2 * line.middleRows(1, count()) + line.bottomRows(count()));
        },
        x);
  }

  /// ½ ρ ∫ |v|² of every wave [J]: with those of the means along u and of the saw-teeth they add up to the kinetic energy.
  Eigen::VectorXd kinetic(const solver::Vectors& v) const {
    return sum(
        0.5 * sheet_.material.density, [&](const auto& line) -> Eigen::MatrixXd { return cosine_ * line; }, v);
  }

 private:
  /// Over all lines.
  template <class Transform>
  Eigen::VectorXd sum(double factor, const Transform& transform, const solver::Vectors& field) const {
    const model::Grid& grid = sheet_.grid;
    Eigen::VectorXd energy = Eigen::VectorXd::Zero(count());
    for (int b = 0; b < grid.nv; ++b)
      energy += factor * grid.cell_area(1, b) * transform(field.middleRows(grid.index(0, b), grid.nu)).rowwise().squaredNorm();
    return energy;
  }

  const model::Sheet& sheet_;
  Eigen::MatrixXd cosine_, sine_;
};

/// What is to be seen of a sheet in the wind in the last part of a run. Energies are means over time.
struct Flutter {
  results::RunRecord run;
  std::vector<double> swing;         ///< mean of the free edge's distance from the plane of the start, step by step [m]
  double wrinkles = 0;               ///< root mean square distance of the free edge from this mean [m]
  Eigen::VectorXd bending, kinetic;  ///< wave by wave [J]
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(Flutter, run, swing, wrinkles, bending, kinetic)

  double peak_to_peak() const {
    const auto [low, high] = std::ranges::minmax(swing);
    return high - low;
  }
  double rms() const {
    // a copy, since sums over foreign memory are rounded as it happens to be aligned
    const Eigen::ArrayXd s = Eigen::Map<const Eigen::ArrayXd>(swing.data(), static_cast<Eigen::Index>(swing.size()));
    return std::sqrt((s - s.mean()).square().mean());
  }
};

Flutter flutter(const model::Scene& scene, const char* method) {
  solver::Options options = solver::thesis_options();
  options.max_updates = 20'000;  // with little damping the loop is slow
  const Waves waves(scene);
  Flutter seen;
  seen.bending = seen.kinetic = Eigen::VectorXd::Zero(waves.count());
  FunctionObserver look([&](const solver::StepReport& s) {
    if (s.t <= scene.end - last) return;
    const Eigen::ArrayXd edge = s.y.x.col(1).head(scene.sheet.grid.nu);  // the lower one; the start is in the plane y = 0
    seen.swing.push_back(edge.mean());
    seen.wrinkles += (edge - edge.mean()).square().mean();
    seen.bending += waves.bending(s.y.x);
    seen.kinetic += waves.kinetic(s.y.v);
  });
  Observer* const observers[] = {&look};
  seen.run = record({scene, "", &solver::method(method), figure_step, options}, observers);
  const auto steps = static_cast<double>(seen.swing.size());
  seen.wrinkles = std::sqrt(seen.wrinkles / steps);
  seen.bending /= steps;
  seen.kinetic /= steps;
  return seen;
}

/// The cloth's own damping hides Euler's, which on transverse waves is hσ/2: some 0.01 N s/m with the sheet's weight for σ.
constexpr const char* dampings[] = {"0.2", "0.02", "0.002"};

/// Euler, BDF(2), and the truth for the same particles: sub-steps of some 10⁻⁴ s.
constexpr const char* figure_methods[] = {"implicit-euler", "bdf2", "verlet"};
using Flutters = std::array<Flutter, 3>;

Flutters compare(const char* damping, bool quick, Checkpoint& checkpoint) {
  std::vector<model::Override> overrides{{"material.damping", damping}};
  if (quick) overrides.insert(overrides.end(), {{"grid.n", "8"}, {"end.time", "1.5"}});
  const model::Scene scene = model::load_scene("wind", overrides);
  Flutters all;
  for (std::size_t k = 0; k < all.size(); ++k) {
    checkpoint.show(fmt::format("{}, d = {}, {}", scene.name, damping, figure_methods[k]));
    all[k] =
        checkpoint.once(fmt::format("{} {}", damping, figure_methods[k]), [&] { return flutter(scene, figure_methods[k]); });
    checkpoint.advance();
  }
  return all;
}

using Runs = std::vector<Flutters>;  ///< one for each damping

void add_damping(results::TableBuilder& table, std::size_t k) {
  table.row();
  table.number("damping", "d", "N s/m", "linear damping; 0.2 is the scene's", std::stod(dampings[k]));
}

results::Table swings(const Runs& runs) {
  results::TableBuilder table("figure-3.2",
                              fmt::format("Figure 3.2: the sheet in the wind, h = {} s, the last second", figure_step));
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (const Flutter& seen : runs[k]) {
      add_damping(table, k);
      table.text("method", "method", "time integrator", seen.run.method.substr(0, seen.run.method.find('/')));
      table.number("peak_to_peak", "swing", "m", "of the free edge's mean, from peak to peak", seen.peak_to_peak());
      table.number("rms", "rms", "m", "of the same", seen.rms());
      table.number("wrinkles", "wrinkles", "m", "root mean square distance of the free edge from its mean", seen.wrinkles);
      table.number("bending", "bending", "J", "energy of the bending along u, mean over time", seen.bending.sum());
      table.number("kinetic", "kinetic", "J", "energy of all waves along u, mean over time", seen.kinetic.sum());
      table.text("outcome", "outcome", "how the run ended", std::string(to_string(seen.run.outcome)));
      if (&seen == &runs[k].front())
        table.text("verdict", "verdict", "whether Euler swings less than the truth",
                   seen.peak_to_peak() < runs[k][2].peak_to_peak() ? "swings less" : "does NOT swing less");
    }
  return table.finish();
}

/// Energies of some waves, and their ratios to the truth. `name` is that of the energy; if not `seen`, people see the ratios
/// only. Returns what became of the energy.
std::string add_energies(results::TableBuilder& table, const std::string& name, const std::array<double, 3>& energy,
                         bool seen) {
  const std::array<const char*, 3> titles{"Euler", "BDF(2)", "truth"};
  for (std::size_t k = 0; k < energy.size(); ++k)
    table.number(fmt::format("{}_{}", name, figure_methods[k]).c_str(),
                 seen ? fmt::format("{}: {}", name, titles[k]).c_str() : "", "J",
                 "energy of these waves, mean over the last second", energy[k]);
  for (const std::size_t k : {0, 1})
    table.number(fmt::format("{}_ratio_{}", name, figure_methods[k]).c_str(),
                 fmt::format("{}: {}/truth", name, titles[k]).c_str(), "1", "ratio of these energies", energy[k] / energy[2]);
  const double euler = energy[0] / energy[2], bdf2 = energy[1] / energy[2];
  if (std::abs(std::log(bdf2)) > std::abs(std::log(euler))) return "BDF(2) is NOT nearer";
  return euler < smoothed ? "smoothed by Euler" : "not smoothed";
}

/// Single waves, then thirds of them: of single ones a second is too short to say much where the motion is chaotic.
results::Table spectrum(const Runs& runs) {
  results::TableBuilder table("figure-3.2-waves", "Figure 3.2: energy of the waves along u, with m half-waves");
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const Flutters& all = runs[k];
    const Eigen::Index count = all[0].bending.size(), third = count / 3;
    const auto add = [&](Eigen::Index first, Eigen::Index n) {
      const auto of = [&](Eigen::VectorXd Flutter::*energy) {
        return std::array{(all[0].*energy).segment(first, n).sum(), (all[1].*energy).segment(first, n).sum(),
                          (all[2].*energy).segment(first, n).sum()};
      };
      add_damping(table, k);
      table.text("waves", "m", "half-waves between the side edges",
                 n == 1 ? std::to_string(first + 1) : fmt::format("{}–{}", first + 1, first + n));
      add_energies(table, "bending", of(&Flutter::bending), true);
      const std::string verdict = add_energies(table, "kinetic", of(&Flutter::kinetic), false);
      if (n > 1) table.text("verdict", "motion", "what Euler does to the kinetic energy", verdict);
    };
    for (Eigen::Index m = 0; m < count; ++m) add(m, 1);
    for (Eigen::Index m = 0; m + third <= count; m += third) add(m, third);
  }
  return table.finish();
}

}  // namespace

std::vector<TableJob> figure_3_2(bool quick) {
  const auto runs = std::make_shared<Runs>();  // of the first table, for the second
  return {{static_cast<int>(std::size(dampings) * std::size(figure_methods)),
           [=](Checkpoint& checkpoint) {
             for (const char* damping : dampings) runs->push_back(compare(damping, quick, checkpoint));
             return swings(*runs);
           }},
          {0, [=](Checkpoint&) { return spectrum(*runs); }}};
}

}  // namespace drape::bench
