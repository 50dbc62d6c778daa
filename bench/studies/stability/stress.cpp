#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "bench/studies/stability/stability.hpp"

namespace drape::bench {
namespace {

constexpr double stress_step = 0.01;  ///< [s]
constexpr double modulus = 1e4;       ///< k [N/m]

/// Something that no scene should do to a solver. `then` is what the sheet turns into half way, if it does.
struct Stress {
  const char* name;
  Specimen (*make)(int n);
  Specimen (*then)(int n) = nullptr;
};

Specimen sheet(int n) { return hung_by_corners(n, modulus, 0.5); }

template <class Change>
Specimen changed(int n, const Change& change) {
  model::Scene scene = sheet(n).scene;
  change(scene);
  return {scene, model::compile(scene)};
}

/// Every fifth particle is a factor heavier; weights stay as they are.
Specimen with_masses(int n, double factor) {
  Specimen s = sheet(n);
  for (Eigen::Index i = 0; i < s.cloth.ode.mass.size(); i += 5) s.cloth.ode.mass[i] *= factor;
  return s;
}

Specimen with_tension(int n, double weft, double warp) {
  return changed(n, [=](model::Scene& scene) { scene.sheet.material.tension = {weft, warp}; });
}

Specimen with_gravity(int n, double g) {
  return changed(n, [=](model::Scene& scene) { scene.sheet.gravity *= g; });
}

/// Two neighbours in the middle so far apart, as a part of the spacing.
Specimen with_edge(int n, double length) {
  Specimen s = sheet(n);
  const model::Grid& grid = s.scene.sheet.grid;
  const int i = grid.index(n / 2, n / 2), j = grid.index(n / 2 + 1, n / 2);
  s.cloth.start.x.row(j) = s.cloth.start.x.row(i);
  s.cloth.start.x(j, 0) += length * grid.spacing_u();
  return s;
}

/// All edges compressed: exactly flat, or with a wave of a thousandth of the side, along which the sheet buckles.
Specimen compressed(int n, double stretch, bool wavy) {
  Specimen s = changed(n, [=](model::Scene& scene) { scene.start.stretch = {stretch, stretch}; });
  const double size = model::size(s.scene);
  solver::Vectors& x = s.cloth.start.x;
  if (wavy) x.col(2).array() += 1e-3 * size * (3 * std::numbers::pi / size * (x.col(0) + x.col(1)).array()).sin();
  return s;
}

constexpr Stress stresses[] = {
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

/// A trial to the end; half way the sheet turns into what it then is, if it does.
RunEnd endure(const Stress& stress, int n, Conditions conditions) {
  Specimen specimen = stress.make(n);
  if (!stress.then) return attempt(specimen, conditions);
  conditions.until /= 2;
  RunEnd first = attempt(specimen, conditions);
  if (!first.succeeded()) return first;
  specimen = stress.then(n);
  specimen.cloth.start = first.state;
  return attempt(specimen, conditions);
}

/// A method under one stress.
struct Endured {
  std::string stress, method;
  Judged run;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Endured, stress, method, run)

constexpr results::ColumnOf<Endured> endured_columns[] = {
    {"case", "case", "", "what is done to the sheet", results::Role::key, results::field<&Endured::stress>},
    {"method", "method", "", "time integrator", results::Role::key, results::field<&Endured::method>},
};

std::vector<Endured> endured(const Stress& stress, int n, const Methods& methods) {
  const auto run = [&](const Conditions& conditions) { return endure(stress, n, conditions); };
  const CrossCheckedReference reference(stress.make(n), horizon, run);
  std::vector<Endured> rows;
  for (const solver::Method* method : methods)
    rows.push_back({stress.name, std::string(method->name),
                    judged(run({method, {}, stress_step, horizon, method->explicit_springs() ? 100'000 : 4'000}), reference)});
  return rows;
}

}  // namespace

TableJob stress_cases(bool quick, const Methods& methods) {
  const int n = quick ? 6 : 10;
  const bool few = quick && methods.empty();
  const Methods chosen = few ? Methods{&solver::method("bdf2"), &solver::method("verlet")} : all_or(methods);
  return {static_cast<int>(std::size(stresses)), [=](Checkpoint& checkpoint) {
            std::vector<Endured> rows;
            for (const Stress& stress : stresses) {
              checkpoint.show(stress.name);
              std::ranges::move(checkpoint.once(stress.name, [&] { return endured(stress, n, chosen); }),
                                std::back_inserter(rows));
              checkpoint.advance();
            }
            results::Table table = results::make_table(
                "stability-stress",
                fmt::format("What no scene should do to a solver, h = 0.01 s{}", few ? "; --quick: bdf2 and verlet only" : ""),
                endured_columns, rows);
            results::add_columns(table, judged_columns, rows, [](const Endured& row) { return &row.run; });
            return table;
          }};
}

}  // namespace drape::bench
