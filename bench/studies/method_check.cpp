#include "bench/studies/method_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/motion_error.hpp"
#include "bench/runs/record.hpp"
#include "bench/studies/refinement.hpp"
#include "bench/studies/stability/stability.hpp"
#include "bench/studies/work_precision/work_precision.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/theory/linear_prediction.hpp"
#include "results/verdict.hpp"

namespace drape::bench {
namespace {

using results::Role;
using results::Standing;

/// Methods that everybody knows.
constexpr const char* neighbours[] = {"bdf2", "midpoint", "implicit-euler", "verlet"};

results::Table order(const std::string& method, Checkpoint& checkpoint) {
  constexpr double most_work = 2e6;
  const model::Scene scene = smooth_scene();
  const model::Cloth cloth = model::compile(scene);
  checkpoint.show("reference of " + scene.name);
  References references(1e-7, {}, 1e-12);
  const reference::Reference reference = references(scene, cloth);
  checkpoint.show(fmt::format("order of {}", method));
  const RunSpec cell = tight(scene, method);
  auto runs = checkpoint.once(method, [&] { return refine(cell, method, cloth, reference, most_work); });
  fit_curve(runs, cell.method->order);
  checkpoint.advance();
  return refinement_table("check-order", fmt::format("Order of {} on a soft sheet, {:g} s", method, scene.end), runs);
}

/// What linear theory says of steps up to the horizon.
std::string theory_of(const solver::Method& method, double h, double k, double d) {
  const double l = 0.8 / 9, nu = h * h * k / (l * l);
  const auto prediction = reference::predict(method, nu, h * k / d);
  if (!prediction) return "no theory known";
  return std::pow(prediction->radius, horizon / h) < 10 ? "stable" : "unstable";
}

/// Up to what steps a method is stable.
struct Usable {
  double damping;
  LargestSteps largest;
  std::string theory;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Usable, damping, largest, theory)

constexpr results::ColumnOf<Usable> damping_columns[] = {
    {"damping", "d", "N s/m", "damping, linear", Role::key, results::field<&Usable::damping>},
};
constexpr results::ColumnOf<Usable> usable_columns[] = {
    {"theory", "in theory", "", "linear theory of the largest of all steps", Role::note, results::field<&Usable::theory>},
    {"verdict", "verdict", "", "up to what steps it is stable", Role::verdict,
     [](const Usable& row) -> results::Cell {
       if (row.largest.stable == 0) return results::verdict(Standing::missed, "not stable");
       return row.largest.stable == horizon ? "no limit seen" : "limited";
     }},
};

results::Table stability_of(const std::string& method, Checkpoint& checkpoint) {
  constexpr double k = 1e4;
  RunSpec cell{smooth_scene(), "", nullptr, 0, {}};
  choose_method(cell, method);
  std::vector<Usable> rows;
  for (const double d : {50.0, 0.5}) {
    checkpoint.show(fmt::format("largest steps of {}, d = {:g}", method, d));
    rows.push_back(checkpoint.once(fmt::format("{:g}", d), [&] {
      const CompiledScene sheet = hung_by_corners(10, k, d);
      return Usable{d, largest_steps(sheet, CrossCheckedReference(sheet), *cell.method, cell.options),
                    theory_of(*cell.method, horizon, k, d)};
    }));
    checkpoint.advance();
  }
  results::Table table = results::make_table(
      "check-stability",
      fmt::format("Largest usable steps of {} on 10 x 10 particles hung by two corners, k = {:g}", method, k), damping_columns,
      rows);
  results::add_columns(table, largest_columns, rows, [](const Usable& row) { return &row.largest; });
  results::add_columns(table, usable_columns, rows);
  return table;
}

/// Energies along a run over the largest kinetic one, less that at the start.
std::vector<double> energy_changes(const results::RunRecord& run, const model::Cloth& cloth) {
  const double start = total_energy(cloth, 0, cloth.start);
  double scale = 0;
  for (const auto& step : run.steps) scale = std::max(scale, step.kinetic_energy);
  std::vector<double> changes;
  for (const auto& step : run.steps) changes.push_back((step.kinetic_energy + step.potential_energy - start) / scale);
  return changes;
}

/// What a run makes of the energy.
struct EnergyChange {
  double step;
  solver::Outcome outcome;
  std::optional<double> change, gain;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EnergyChange, step, outcome, change, gain)

std::string energy_verdict(const EnergyChange& row) {
  constexpr double small = 1e-2;  // part of the kinetic energy
  if (!row.change) return results::verdict(Standing::missed, "not finished");
  if (*row.gain > small) return "gains energy";
  return *row.change < -small ? "loses energy" : "keeps energy";
}

constexpr results::ColumnOf<EnergyChange> energy_columns[] = {
    {"step", "h", "s", "step", Role::key, results::field<&EnergyChange::step>},
    {"outcome", "outcome", "", "how the run ended", Role::outcome, results::field<&EnergyChange::outcome>},
    {"change", "change", "1", "of the energy up to the end, over the largest kinetic energy", Role::quantity,
     results::field<&EnergyChange::change>},
    {"gain", "gain", "1", "the most that it was above that of the start", Role::quantity, results::field<&EnergyChange::gain>},
    {"verdict", "verdict", "", "what becomes of the energy", Role::verdict,
     [](const EnergyChange& row) { return results::to_cell(energy_verdict(row)); }},
};

results::Table energy(const std::string& method, Checkpoint& checkpoint) {
  const model::Scene scene = model::load_scene(
      "hung-corners", std::vector<model::Override>{{"grid.n", "10"}, {"material.damping", "0"}, {"end.time", "1"}});
  const model::Cloth cloth = model::compile(scene);
  std::vector<EnergyChange> rows;
  for (const double h : {0.01, 0.0025}) {
    checkpoint.show(fmt::format("energy of {}, h = {:g}", method, h));
    rows.push_back(checkpoint.once(fmt::format("{:g}", h), [&] {
      RunSpec cell{scene, "", nullptr, h, {}};
      choose_method(cell, method);
      const results::RunRecord run = record(cell);
      EnergyChange row{h, run.outcome, {}, {}};
      if (!run.succeeded()) return row;
      const std::vector<double> changes = energy_changes(run, cloth);
      row.gain = std::ranges::max(changes);
      row.change = changes.back();
      return row;
    }));
    checkpoint.advance();
  }
  return results::make_table("check-energy", fmt::format("Energy of an undamped sheet by {}, {:g} s", method, scene.end),
                             energy_columns, rows);
}

/// A method and those that it is compared with: a ladder of steps each, timed near its front.
struct Compared {
  Problem problem;
  std::vector<std::string> methods;
  std::vector<Configuration> configurations;  ///< of each method
  std::vector<ComparedRun> runs;
};

void compare(Compared& all, const std::string& method, Checkpoint& checkpoint) {
  constexpr Effort effort{.repetitions = 5};
  all.methods = {method};
  for (const char* neighbour : neighbours)
    if (neighbour != method) all.methods.emplace_back(neighbour);
  for (const std::string& name : all.methods) all.configurations.push_back(ladder(all.problem.scene, name));
  all.runs = run_all(all.problem, all.configurations, effort, checkpoint);
  std::vector<Contender> who;
  for (const Configuration& configuration : all.configurations) who.push_back(only(configuration));
  checkpoint.show("timing");
  time_fronts(all.problem, who, all.runs, effort, checkpoint);
}

/// What an error costs at least.
struct Cost {
  std::string method;
  double wanted;
  const ComparedRun* best;  ///< null if the method does not reach the error

  double quartile(double results::Quartiles::*which) const { return results::quartiles(best->measured.times).*which; }
};

constexpr results::ColumnOf<Cost> cost_columns[] = {
    {"method", "method", "", "time integrator", Role::key, results::field<&Cost::method>},
    {"wanted", "error", "1", "at most, over the scene's size", Role::key, results::field<&Cost::wanted>},
};

/// Of those that reach it. Who is the quickest depends on times, and so does all that is said of him.
constexpr results::ColumnOf<Cost> best_columns[] = {
    {"control", "h", "s", "step, or fraction of the stability limit, that is the quickest", Role::time,
     [](const Cost& row) { return results::to_cell(row.best->variant().value); }},
    {"error", "", "1", "its error", Role::time, [](const Cost& row) { return results::to_cell(row.best->measured.error); }},
    {"time", "time", "ms", "median wall time", Role::time,
     [](const Cost& row) { return results::to_cell(row.quartile(&results::Quartiles::median)); }},
    {"lower", "", "ms", "lower quartile", Role::time,
     [](const Cost& row) { return results::to_cell(row.quartile(&results::Quartiles::lower)); }},
    {"upper", "", "ms", "upper quartile", Role::time,
     [](const Cost& row) { return results::to_cell(row.quartile(&results::Quartiles::upper)); }},
    {"forces", "forces", "1", "evaluations", Role::time, [](const Cost& row) { return results::to_cell(row.best->forces); }},
};

results::Table cost(const std::string& method, Checkpoint& checkpoint) {
  const model::Scene scene = model::load_scene(
      "hung-corners", std::vector<model::Override>{{"grid.n", "10"}, {"material.damping", "5"}, {"end.time", "0.3"}});
  checkpoint.show("reference of " + scene.name);
  Compared all{certified_problem(scene.name, scene, checkpoint), {}, {}, {}};
  all.problem.asked = {1e-2, 1e-3, 1e-4};
  all.problem.enough = 5e-5;
  compare(all, method, checkpoint);
  std::vector<Cost> rows;
  for (std::size_t k = 0; k < all.methods.size(); ++k)
    for (const double error : all.problem.asked)
      rows.push_back({all.methods[k], error, quickest(only(all.configurations[k]), all.runs, error)});
  results::Table table = results::make_table(
      "check-cost",
      fmt::format("Cost of {} beside others on 10 x 10 particles hung by two corners, d = 5, {:g} s", method, scene.end),
      cost_columns, rows);
  results::add_columns(table, best_columns, rows, [](const Cost& row) { return row.best == nullptr ? nullptr : &row; });
  return table;
}

}  // namespace

std::vector<TableJob> check_jobs(const std::string& method) {
  return {{1, [=](Checkpoint& checkpoint) { return order(method, checkpoint); }},
          {2, [=](Checkpoint& checkpoint) { return stability_of(method, checkpoint); }},
          {2, [=](Checkpoint& checkpoint) { return energy(method, checkpoint); }},
          {static_cast<int>(std::size(neighbours)) + 1, [=](Checkpoint& checkpoint) { return cost(method, checkpoint); }}};
}

}  // namespace drape::bench
