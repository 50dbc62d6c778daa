#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>

#include "bench/runs/energy_guard.hpp"
#include "bench/studies/stability/stability.hpp"

namespace drape::bench {
namespace {

constexpr double stress_step = 0.01;  ///< [s]
constexpr double modulus = 1e4;       ///< k [N/m]

/// Something that no scene should do to a solver. `then` is what the sheet turns into half way, if it does.
struct StressCase {
  const char* name;
  CompiledScene (*make)(int n);
  CompiledScene (*then)(int n) = nullptr;
};

CompiledScene sheet(int n) { return hung_by_corners(n, modulus, 0.5); }

template <class Change>
CompiledScene changed(int n, const Change& change) {
  model::Scene scene = sheet(n).scene;
  change(scene);
  return {scene, model::compile(scene)};
}

/// Every fifth particle is a factor heavier; weights stay as they are.
CompiledScene with_masses(int n, double factor) {
  CompiledScene s = sheet(n);
  for (Eigen::Index i = 0; i < s.cloth.ode.mass.size(); i += 5) s.cloth.ode.mass[i] *= factor;
  return s;
}

CompiledScene with_tension(int n, double weft, double warp) {
  return changed(n, [=](model::Scene& scene) { scene.sheet.material.tension = {weft, warp}; });
}

CompiledScene with_gravity(int n, double g) {
  return changed(n, [=](model::Scene& scene) { scene.sheet.gravity *= g; });
}

/// Two neighbours in the middle so far apart, as a part of the spacing.
CompiledScene with_edge(int n, double length) {
  CompiledScene s = sheet(n);
  const model::Grid& grid = s.scene.sheet.grid;
  const int i = grid.index(n / 2, n / 2), j = grid.index(n / 2 + 1, n / 2);
  s.cloth.start.x.row(j) = s.cloth.start.x.row(i);
  s.cloth.start.x(j, 0) += length * grid.spacing_u();
  return s;
}

/// All edges compressed: exactly flat, or with a wave of a thousandth of the side, along which the sheet buckles.
CompiledScene compressed(int n, double stretch, bool wavy) {
  CompiledScene s = changed(n, [=](model::Scene& scene) { scene.start.stretch = {stretch, stretch}; });
  const double size = model::size(s.scene);
  solver::Vectors& x = s.cloth.start.x;
  if (wavy) x.col(2).array() += 1e-3 * size * (3 * std::numbers::pi / size * (x.col(0) + x.col(1)).array()).sin();
  return s;
}

constexpr StressCase stresses[] = {
    {"masses 1 : 1e4", [](int n) { return with_masses(n, 1e4); }},
    {"masses 1e4 : 1", [](int n) { return with_masses(n, 1e-4); }},
    {"weft 1e4 times the warp", [](int n) { return with_tension(n, 1e6, 1e2); }},
    {"warp 1e4 times the weft", [](int n) { return with_tension(n, 1e2, 1e6); }},
    {"suddenly 1e4 times stiffer", [](int n) { return with_tension(n, 1e2, 1e2); },
     [](int n) { return with_tension(n, 1e6, 1e6); }},
    {"suddenly 1e4 times softer", [](int n) { return with_tension(n, 1e6, 1e6); },
     [](int n) { return with_tension(n, 1e2, 1e2); }},
    {"an edge of length 1e-12", [](int n) { return with_edge(n, 1e-12); }},
    {"an edge of length 0", [](int n) { return with_edge(n, 0); }},
    {"an edge turned inside out", [](int n) { return with_edge(n, -0.5); }},
    {"compressed to 0.7, flat", [](int n) { return compressed(n, 0.7, false); }},
    {"compressed to 0.7, wavy", [](int n) { return compressed(n, 0.7, true); }},
    {"compressed to 0.1, wavy", [](int n) { return compressed(n, 0.1, true); }},
    {"no gravity, at rest", [](int n) { return with_gravity(n, 0); }},
    {"gravity 1e3 times", [](int n) { return with_gravity(n, 1e3); }},
    {"gravity 1e6 times", [](int n) { return with_gravity(n, 1e6); }},
    {"undamped, k = 1e6", [](int n) { return hung_by_corners(n, 1e6, 0); }},
    {"undamped, k = 1e8", [](int n) { return hung_by_corners(n, 1e8, 0); }},
};

/// A run to the end; half way the sheet turns into what it then is, if it does.
RunEnd endure(const StressCase& stress, int n, RunSpec spec, const Limits& limits) {
  if (!stress.then) return run_guarded(spec, stress.make(n).cloth, limits);
  spec.scene.end /= 2;
  RunEnd first = run_guarded(spec, stress.make(n).cloth, limits);
  if (!first.succeeded()) return first;
  CompiledScene sheet = stress.then(n);
  sheet.cloth.start = first.state;
  sheet.scene.end = spec.scene.end;
  spec.scene = sheet.scene;
  return run_guarded(spec, sheet.cloth, limits);
}

/// A method under one stress.
struct Endured {
  std::string stress, method;
  ClassifiedRun run;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Endured, stress, method, run)

constexpr results::ColumnOf<Endured> endured_columns[] = {
    {"case", "case", "", "what is done to the sheet", results::Role::key, results::field<&Endured::stress>},
    {"method", "method", "", "time integrator", results::Role::key, results::field<&Endured::method>},
};

std::vector<Endured> endured(const StressCase& stress, int n, const Methods& methods, Checkpoint& checkpoint) {
  const auto run = [&](const RunSpec& spec, const Limits& limits) { return endure(stress, n, spec, limits); };
  std::optional<CompiledScene> sheet;  // made for the first row that no process before this one has made
  std::optional<CrossCheckedReference> reference;
  std::vector<Endured> rows;
  checkpoint.each(methods, [&](const solver::Method* method) {
    rows.push_back(checkpoint.once(fmt::format("{}, {}", stress.name, method->name), [&] {
      if (!sheet) reference.emplace(sheet.emplace(stress.make(n)), run);
      const Limits limits{.evaluations = usual_evaluations(*method)};
      return Endured{stress.name, std::string(method->name),
                     classified(run({sheet->scene, "", method, stress_step, {}}, limits), *reference)};
    }));
  });
  return rows;
}

}  // namespace

Job stress_cases(bool quick, const Methods& methods) {
  const int n = quick ? 6 : 10;
  const bool few = quick && methods.empty();
  const Methods chosen = few ? Methods{&solver::method("bdf2"), &solver::method("verlet")} : all_or(methods);
  const auto compute = [=](Checkpoint& checkpoint) {
    std::vector<Endured> rows;
    checkpoint.each(stresses, [&](const StressCase& stress) {
      checkpoint.show(stress.name);
      std::ranges::move(endured(stress, n, chosen, checkpoint), std::back_inserter(rows));
      checkpoint.advance();
    });
    return rows;
  };
  const auto present = [=](const std::vector<Endured>& rows) {
    results::Table table = results::make_table(
        "stability-stress",
        fmt::format("What no scene should do to a solver, h = 0.01 s{}", few ? "; --quick: bdf2 and verlet only" : ""),
        endured_columns, rows);
    results::add_columns(table, classified_columns, rows, [](const Endured& row) { return &row.run; });
    return table;
  };
  return job("stability-stress", static_cast<int>(std::size(stresses)), compute, present);
}

}  // namespace drape::bench
