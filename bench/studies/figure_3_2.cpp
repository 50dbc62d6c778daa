#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "bench/runs/record.hpp"
#include "bench/studies/studies.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"

namespace drape::bench {
namespace {

using results::Datum;
using results::field;
using results::Role;
using results::Standing;

constexpr double figure_step = 0.01;  ///< [s]
constexpr double last_part = 1;       ///< part of the run that is looked at [s]
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
    const Eigen::VectorXd areas = grid.cell_areas();
    Eigen::VectorXd energy = Eigen::VectorXd::Zero(count());
    for (int b = 0; b < grid.nv; ++b)
      energy +=
          factor * areas[grid.index(1, b)] * transform(field.middleRows(grid.index(0, b), grid.nu)).rowwise().squaredNorm();
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
  FunctionObserver observer([&](const solver::StepReport& s) {
    if (s.t <= scene.end - last_part) return;
    const Eigen::ArrayXd edge = s.y.x.col(1).head(scene.sheet.grid.nu);  // the lower one; the start is in the plane y = 0
    seen.swing.push_back(edge.mean());
    seen.wrinkles += (edge - edge.mean()).square().mean();
    seen.bending += waves.bending(s.y.x);
    seen.kinetic += waves.kinetic(s.y.v);
  });
  Observer* const observers[] = {&observer};
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
  std::size_t k = 0;
  checkpoint.each(figure_methods, [&](const auto& method) {
    Flutter& one = all[k++];
    checkpoint.show(fmt::format("{}, d = {}, {}", scene.name, damping, method));
    one = checkpoint.once(fmt::format("{} {}", damping, method), [&] { return flutter(scene, method); });
    checkpoint.advance();
  });
  return all;
}

using Runs = std::vector<Flutters>;  ///< one for each damping

double number(const char* damping) { return std::stod(damping); }

/// How the sheet swings with one method; the truth's swing is that of the same damping.
struct Swing {
  double damping;
  const char* method;
  const Flutter* seen;
  std::optional<results::Verdict> verdict;  ///< in Euler's row
};

constexpr results::ColumnOf<Swing> swing_columns[] = {
    {"damping", "d", "N s/m", "linear damping; 0.2 is the scene's", Role::key, field<&Swing::damping>},
    {"method", "method", "", "time integrator", Role::key, field<&Swing::method>},
    {"peak_to_peak", "swing", "m", "of the free edge's mean, from peak to peak", Role::quantity,
     [](const Swing& row) -> Datum { return row.seen->peak_to_peak(); }},
    {"rms", "rms", "m", "of the same", Role::quantity, [](const Swing& row) -> Datum { return row.seen->rms(); }},
    {"wrinkles", "wrinkles", "m", "root mean square distance of the free edge from its mean", Role::quantity,
     [](const Swing& row) -> Datum { return row.seen->wrinkles; }},
    {"bending", "bending", "J", "energy of the bending along u, mean over time", Role::quantity,
     [](const Swing& row) -> Datum { return row.seen->bending.sum(); }},
    {"kinetic", "kinetic", "J", "energy of all waves along u, mean over time", Role::quantity,
     [](const Swing& row) -> Datum { return row.seen->kinetic.sum(); }},
    {"verdict", "verdict", "", "whether Euler swings less than the truth", Role::verdict, field<&Swing::verdict>},
    {"outcome", "outcome", "", "how the run ended", Role::outcome,
     [](const Swing& row) { return results::to_datum(row.seen->run.outcome); }},
};

results::Table swings(const Runs& runs) {
  std::vector<Swing> rows;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const std::size_t euler = rows.size();
    for (std::size_t method = 0; method < runs[k].size(); ++method)
      rows.push_back({number(dampings[k]), figure_methods[method], &runs[k][method], {}});
    const bool less = runs[k].front().peak_to_peak() < runs[k].back().peak_to_peak();
    rows[euler].verdict = results::check(less, "swings less", "does not swing less");
  }
  return results::make_table("figure-3.2",
                             fmt::format("Figure 3.2: the sheet in the wind, h = {} s, the last second", figure_step),
                             swing_columns, rows);
}

using Energies = std::array<double, 3>;  ///< of the methods, means over the last second [J]

/// Energies of some waves along u.
struct Spectrum {
  double damping;
  std::string waves;  ///< numbers of half-waves: "3", or the first and the last
  Energies bending, kinetic;
  std::optional<results::Verdict> verdict;  ///< where it is not a single wave

  double ratio(Energies Spectrum::*energy, std::size_t method) const { return (this->*energy)[method] / (this->*energy)[2]; }
};

constexpr results::ColumnOf<Spectrum> waves_columns[] = {
    {"damping", "d", "N s/m", "linear damping; 0.2 is the scene's", Role::key, field<&Spectrum::damping>},
    {"waves", "m", "", "half-waves between the side edges", Role::key, field<&Spectrum::waves>},
};
constexpr results::ColumnOf<double> energy_column[] = {
    {"{}", "{}", "J", "energy of these waves, mean over the last second", Role::quantity,
     [](const double& energy) -> Datum { return energy; }},
};
constexpr results::ColumnOf<double> ratio_column[] = {
    {"{}", "{}", "1", "ratio of these energies", Role::quantity, [](const double& ratio) -> Datum { return ratio; }},
};
constexpr results::ColumnOf<Spectrum> waves_verdict[] = {
    {"verdict", "motion", "", "what Euler does to the kinetic energy", Role::verdict, field<&Spectrum::verdict>},
};

/// The energies of all methods, and their ratios to the truth. `name` is that of the energy; if not `seen`, users see the
/// ratios only.
void add_energies(results::Table& table, const std::string& name, const std::vector<Spectrum>& rows, Energies Spectrum::*energy,
                  bool seen) {
  const std::array<const char*, 3> titles{"Euler", "BDF(2)", "truth"};
  for (std::size_t k = 0; k < titles.size(); ++k) {
    const std::string column = fmt::format("{}_{}", name, figure_methods[k]);
    const std::string title = seen ? fmt::format("{}: {}", name, titles[k]) : "";
    add_columns(table, energy_column, rows, [&](const Spectrum& row) { return &(row.*energy)[k]; }, {column, title, ""});
  }
  for (const std::size_t k : {0, 1}) {
    const std::string column = fmt::format("{}_ratio_{}", name, figure_methods[k]);
    const std::string title = fmt::format("{}: {}/truth", name, titles[k]);
    add_columns(table, ratio_column, rows, [&](const Spectrum& row) { return std::optional(row.ratio(energy, k)); },
                {column, title, ""});
  }
}

/// What became of the kinetic energy.
results::Verdict motion_verdict(const Spectrum& row) {
  const double euler = row.ratio(&Spectrum::kinetic, 0), bdf2 = row.ratio(&Spectrum::kinetic, 1);
  if (std::abs(std::log(bdf2)) > std::abs(std::log(euler))) return results::Verdict{Standing::missed, "BDF(2) is not nearer"};
  return {Standing::open, euler < smoothed ? "smoothed by Euler" : "not smoothed"};
}

/// `n` waves from one on.
Spectrum spectrum_of(double damping, const Flutters& all, Eigen::Index first, Eigen::Index n) {
  const auto of = [&](Eigen::VectorXd Flutter::*energy) {
    return Energies{(all[0].*energy).segment(first, n).sum(), (all[1].*energy).segment(first, n).sum(),
                    (all[2].*energy).segment(first, n).sum()};
  };
  Spectrum row{damping,
               n == 1 ? std::to_string(first + 1) : fmt::format("{}–{}", first + 1, first + n),
               of(&Flutter::bending),
               of(&Flutter::kinetic),
               {}};
  if (n > 1) row.verdict = motion_verdict(row);
  return row;
}

/// Single waves, then thirds of them: of single ones a second is too short to say much where the motion is chaotic.
results::Table spectrum(const Runs& runs) {
  std::vector<Spectrum> rows;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const Eigen::Index count = runs[k][0].bending.size(), third = count / 3;
    for (Eigen::Index m = 0; m < count; ++m) rows.push_back(spectrum_of(number(dampings[k]), runs[k], m, 1));
    for (Eigen::Index m = 0; m + third <= count; m += third)
      rows.push_back(spectrum_of(number(dampings[k]), runs[k], m, third));
  }
  results::Table table = results::make_table("figure-3.2-waves", "Figure 3.2: energy of the waves along u, with m half-waves",
                                             waves_columns, rows);
  add_energies(table, "bending", rows, &Spectrum::bending, true);
  add_energies(table, "kinetic", rows, &Spectrum::kinetic, false);
  add_columns(table, waves_verdict, rows);
  return table;
}

}  // namespace

std::vector<Job> figure_3_2(const Question& question) {
  const auto compute = [quick = question.quick](Checkpoint& checkpoint) {
    Runs runs;
    checkpoint.each(dampings, [&](const char* damping) { runs.push_back(compare(damping, quick, checkpoint)); });
    return runs;
  };
  const auto present = [](const Runs& runs) { return std::vector{swings(runs), spectrum(runs)}; };
  return {job("figure-3.2", static_cast<int>(std::size(dampings) * std::size(figure_methods)), compute, present)};
}

}  // namespace drape::bench
