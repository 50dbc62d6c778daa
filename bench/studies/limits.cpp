#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"
#include "solver/base/noise.hpp"

namespace drape::bench {
namespace {

using results::field;
using results::Role;
using results::Standing;

constexpr double limit_tension = 100;     ///< k [N/m] of the sheet
constexpr double far_beyond = 10;         ///< h [s]: the numerical stiffness is of the order of 1e7
constexpr double limit_agreement = 0.05;  ///< of an onset with its closed form
constexpr double perturbation = 1e-8;     ///< of the flat sheet, over a spacing
constexpr double largest_growth = 1e3;    ///< of the perturbation, above which a method is unstable
constexpr double bisection_accuracy = 0.005;

/// A force that is not in K, and the ratio ω²/κ that it gives a mode, at most.
struct ExplicitForce {
  const char *name, *formula;
  void (*set)(model::Material& material, double ratio, double l);  ///< such that this is the largest ratio; l: spacing [m]
  const char *key, *unit;
  double (*value)(const model::Material& material);
};

/// A homogeneous shear of a free sheet, x along v and y along u, has ω²/κ = 2 G/k: more than plane waves have, G/k along weft
/// and warp and ½ + G/k along a diagonal. The plate has B Λ/k where Λ <= 8/l² is the eigenvalue of the sheet's second
/// difference.
constexpr ExplicitForce explicit_forces[] = {
    {"shear", "2 G/k", [](model::Material& m, double ratio, double) { m.shear = ratio * limit_tension / 2; }, "material.shear",
     "N/m", [](const model::Material& m) { return m.shear; }},
    {"plate", "8 B/(k l²)",
     [](model::Material& m, double ratio, double l) {
       m.bend = {ratio * limit_tension * l * l / 8, ratio * limit_tension * l * l / 8};
     },
     "material.bend", "N m", [](const model::Material& m) { return m.bend.weft; }},
};

/// A method with what theory says: the largest ratio ω²/κ for which it is stable, or its loop converges, for every h.
struct LimitedMethod {
  const char* name;
  double bound;
  bool loop;
};
constexpr LimitedMethod limited_methods[] = {{"imex-euler", 2, false},    {"sbdf2", 4.0 / 3, false},
                                             {"imex-midpoint", 1, false}, {"implicit-euler", 2, true},
                                             {"bdf2", 2, true},           {"midpoint", 2, true}};

RunSpec spec_of(const LimitedMethod& limited, const ExplicitForce& force, double ratio, bool quick) {
  const int steps = limited.loop ? 3 : 400;
  model::Scene scene = model::load_scene("hung-edge", std::vector<model::Override>{{"grid.n", quick ? "12" : "20"}});
  scene.pins.clear();
  scene.sheet.gravity.setZero();
  scene.sheet.material = {};
  scene.sheet.material.density = 1;
  scene.sheet.material.tension = {limit_tension, limit_tension};
  force.set(scene.sheet.material, ratio, scene.sheet.grid.spacing_u());
  scene.end = steps * far_beyond;
  solver::Options options = solver::thesis_options();
  options.linear_solver = &solver::linear_solver("cholesky");  // without errors that a marginally stable method would keep
  options.max_updates = 3'000;
  return {scene, "", &solver::method(limited.name), far_beyond, options};
}

/// Whether a method is stable with this ratio, or its loop converges.
bool keeps(const LimitedMethod& limited, const ExplicitForce& force, double ratio, bool quick) {
  const RunSpec spec = spec_of(limited, force, ratio, quick);
  model::Cloth cloth = model::compile(spec.scene);
  const double size = perturbation * spec.scene.sheet.grid.spacing_u();
  const solver::Vectors flat = cloth.start.x;
  cloth.start.x += size * base::noise(flat.size(), 7).reshaped(flat.rows(), 3);
  const RunEnd end = run(spec, cloth);
  if (!end.succeeded()) return false;
  return (end.state.x - flat).cwiseAbs().maxCoeff() <= largest_growth * size;
}

/// Where a method ceases to be stable, or its loop to converge.
struct Onset {
  std::string force, formula, key, unit, method, what;
  double bound = 0, onset = 0, value = 0;

  results::Verdict verdict() const {
    if (onset == 0) return {Standing::open, "not bracketed"};
    return results::check(std::abs(onset / bound - 1) <= limit_agreement, "as in theory", "not as in theory");
  }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Onset, force, formula, key, unit, method, what, bound, onset, value)

Onset find_onset(const LimitedMethod& limited, const ExplicitForce& force, bool quick) {
  Onset row{force.name,   force.formula, force.key, force.unit, limited.name, limited.loop ? "the loop converges" : "stable",
            limited.bound};
  double low = 0.55 * limited.bound, high = 1.6 * limited.bound;
  if (!keeps(limited, force, low, quick) || keeps(limited, force, high, quick)) return row;
  while (high - low > bisection_accuracy * limited.bound) {
    const double middle = (low + high) / 2;
    (keeps(limited, force, middle, quick) ? low : high) = middle;
  }
  row.onset = (low + high) / 2;
  row.value = force.value(spec_of(limited, force, row.onset, quick).scene.sheet.material);
  return row;
}

constexpr results::ColumnOf<Onset> onset_columns[] = {
    {"force", "force", "", "that is not in K", Role::key, field<&Onset::force>},
    {"method", "method", "", "time integrator, h = 10 s", Role::key, field<&Onset::method>},
    {"what", "up to here", "", "what becomes of it below the limit", Role::note, field<&Onset::what>},
    {"ratio", "ω²/κ", "", "largest ratio of a mode of the sheet in closed form", Role::note, field<&Onset::formula>},
    {"bound", "in theory", "1", "largest ratio for which it is so with every h", Role::quantity, field<&Onset::bound>},
    {"onset", "measured", "1", "the same on the sheet, by bisection", Role::quantity, field<&Onset::onset>},
    {"value", "modulus", "", "of the force, at the measured limit", Role::note,
     [](const Onset& row) { return results::to_datum(fmt::format("{} = {:.4g} {}", row.key, row.value, row.unit)); }},
    {"verdict", "verdict", "", "whether both agree within 5 %", Role::verdict,
     [](const Onset& row) { return results::to_datum(row.verdict()); }},
};

std::vector<Onset> onsets(bool quick, Checkpoint& checkpoint) {
  std::vector<Onset> rows;
  checkpoint.each(explicit_forces, [&](const ExplicitForce& force) {
    checkpoint.each(limited_methods, [&](const LimitedMethod& limited) {
      const std::string id = fmt::format("{}, {}", force.name, limited.name);
      checkpoint.show(id);
      rows.push_back(checkpoint.once(id, [&] { return find_onset(limited, force, quick); }));
      checkpoint.advance();
    });
  });
  return rows;
}

}  // namespace

std::vector<Job> limits(const Question& question) {
  const auto parts = static_cast<int>(std::size(explicit_forces) * std::size(limited_methods));
  return {job(
      "limits", parts, [quick = question.quick](Checkpoint& checkpoint) { return onsets(quick, checkpoint); },
      [](const std::vector<Onset>& rows) {
        return results::make_table(
            "limits",
            "Where IMEX methods become unstable, and the thesis' loop ceases to converge, with forces that "
            "are not in K: a flat sheet of 0.8 m, k = 100 N/m, undamped",
            onset_columns, rows);
      })};
}

}  // namespace drape::bench
