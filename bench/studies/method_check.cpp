#include "bench/studies/method_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/motion_error.hpp"
#include "bench/runs/record.hpp"
#include "bench/studies/work_precision/work_precision.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/theory/linear_prediction.hpp"

namespace drape::bench {
namespace {

using results::Role;
using results::Standing;

/// Well-known methods that it is compared with.
constexpr const char* neighbours[] = {"bdf2", "midpoint", "implicit-euler", "verlet"};

std::vector<RefinedRun> order(const RunSpec& spec, const std::string& method, Checkpoint& checkpoint) {
  constexpr double most_work = 2e6;
  checkpoint.begin("order");
  const model::Cloth cloth = model::compile(spec.scene);
  checkpoint.show("reference of " + spec.scene.name);
  References references(1e-7, {}, 1e-12);
  const reference::Reference reference = references(spec.scene, cloth);
  checkpoint.show(fmt::format("order of {}", method));
  auto runs = refine(spec, method, cloth, reference, most_work, checkpoint);
  fit_curve(runs, spec.method->order);
  checkpoint.advance();
  return runs;
}

/// What linear theory says of steps up to the horizon.
std::string theory_of(const solver::Method& method, double h, double k, double d) {
  const double l = 0.8 / 9, nu = h * h * k / (l * l);
  const auto prediction = reference::predict(method, nu, h * k / d);
  if (!prediction) return "no theory known";
  return std::pow(prediction->radius, horizon / h) < 10 ? "stable" : "unstable";
}

constexpr results::ColumnOf<Usable> damping_columns[] = {
    {"damping", "d", "N s/m", "damping, linear", Role::key, results::field<&Usable::damping>},
};
constexpr results::ColumnOf<Usable> usable_columns[] = {
    {"theory", "in theory", "", "linear theory of the largest of all steps", Role::note, results::field<&Usable::theory>},
    {"verdict", "verdict", "", "up to what steps it is stable", Role::verdict,
     [](const Usable& row) -> results::Datum { return row.verdict(); }},
};

constexpr double stiffness = 1e4;  ///< [N/m]

std::vector<Usable> stability_of(const RunSpec& spec, const std::string& method, Checkpoint& checkpoint) {
  checkpoint.begin("stability");
  std::vector<Usable> rows;
  for (const double d : {50.0, 0.5}) {
    checkpoint.show(fmt::format("largest steps of {}, d = {:g}", method, d));
    rows.push_back(checkpoint.once(fmt::format("{:g}", d), [&] {
      const CompiledScene sheet = hung_by_corners(10, stiffness, d);
      return Usable{d, largest_steps(sheet, CrossCheckedReference(sheet), *spec.method, spec.options),
                    theory_of(*spec.method, horizon, stiffness, d)};
    }));
    checkpoint.advance();
  }
  return rows;
}

results::Table stability_table(const MethodCheck& check) {
  results::Table table = results::make_table(
      "check-stability",
      fmt::format("Largest usable steps of {} on 10 x 10 particles hung by two corners, k = {:g}", check.name, stiffness),
      damping_columns, check.stability);
  results::add_columns(table, largest_columns, check.stability, [](const Usable& row) { return &row.largest; });
  results::add_columns(table, usable_columns, check.stability);
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

constexpr results::ColumnOf<EnergyChange> energy_columns[] = {
    {"step", "h", "s", "step", Role::key, results::field<&EnergyChange::step>},
    {"outcome", "outcome", "", "how the run ended", Role::outcome, results::field<&EnergyChange::outcome>},
    {"change", "change", "1", "of the energy up to the end, over the largest kinetic energy", Role::quantity,
     results::field<&EnergyChange::change>},
    {"gain", "gain", "1", "the most that it was above that of the start", Role::quantity, results::field<&EnergyChange::gain>},
    {"verdict", "verdict", "", "what becomes of the energy", Role::verdict,
     [](const EnergyChange& row) { return results::to_datum(row.verdict()); }},
};

constexpr double energy_end = 1;  ///< [s]

std::vector<EnergyChange> energy(const std::string& method, Checkpoint& checkpoint) {
  checkpoint.begin("energy");
  const model::Scene scene = model::load_scene(
      "hung-corners",
      std::vector<model::Override>{{"grid.n", "10"}, {"material.damping", "0"}, {"end.time", fmt::format("{}", energy_end)}});
  const model::Cloth cloth = model::compile(scene);
  std::vector<EnergyChange> rows;
  for (const double h : {0.01, 0.0025}) {
    checkpoint.show(fmt::format("energy of {}, h = {:g}", method, h));
    rows.push_back(checkpoint.once(fmt::format("{:g}", h), [&] {
      RunSpec spec{scene, "", nullptr, h, {}};
      choose_method(spec, method);
      const results::RunRecord run = record(spec);
      EnergyChange row{h, run.outcome, {}, {}};
      if (!run.succeeded()) return row;
      const std::vector<double> changes = energy_changes(run, cloth);
      row.gain = std::ranges::max(changes);
      row.change = changes.back();
      return row;
    }));
    checkpoint.advance();
  }
  return rows;
}

results::Table energy_table(const MethodCheck& check) {
  return results::make_table("check-energy", fmt::format("Energy of an undamped sheet by {}, {:g} s", check.name, energy_end),
                             energy_columns, check.energy);
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

/// The quickest variant of a configuration at an error; nothing if none reaches it.
std::optional<Quickest> quickest_of(const Configuration& configuration, const std::vector<ComparedRun>& runs, double error) {
  const ComparedRun* best = quickest(only(configuration), runs, error);
  if (best == nullptr) return std::nullopt;
  return Quickest{best->variant().value, best->measured.error, results::quartiles(best->measured.times), best->forces};
}

constexpr results::ColumnOf<Cost> cost_columns[] = {
    {"method", "method", "", "time integrator", Role::key, results::field<&Cost::method>},
    {"wanted", "error", "1", "at most, over the scene's size", Role::key, results::field<&Cost::wanted>},
};

/// The quickest variant that reaches the error. Which one that is depends on times, and so do all its numbers.
constexpr results::ColumnOf<Quickest> best_columns[] = {
    {"control", "h", "s", "step, or fraction of the stability limit, that is the quickest", Role::time,
     results::field<&Quickest::value>},
    {"error", "", "1", "its error", Role::time, results::field<&Quickest::error>},
    {"time", "time", "ms", "median wall time", Role::time,
     [](const Quickest& best) -> results::Datum { return best.times.median; }},
    {"lower", "", "ms", "lower quartile", Role::time, [](const Quickest& best) -> results::Datum { return best.times.lower; }},
    {"upper", "", "ms", "upper quartile", Role::time, [](const Quickest& best) -> results::Datum { return best.times.upper; }},
    {"forces", "forces", "1", "evaluations", Role::time, results::field<&Quickest::forces>},
};

constexpr double cost_end = 0.3;  ///< [s]

std::vector<Cost> cost(const std::string& method, Checkpoint& checkpoint) {
  checkpoint.begin("cost");
  const model::Scene scene = model::load_scene(
      "hung-corners",
      std::vector<model::Override>{{"grid.n", "10"}, {"material.damping", "5"}, {"end.time", fmt::format("{}", cost_end)}});
  checkpoint.show("reference of " + scene.name);
  Compared all{certified_problem(scene.name, scene, checkpoint), {}, {}, {}};
  all.problem.asked = {1e-2, 1e-3, 1e-4};
  all.problem.enough = 5e-5;
  compare(all, method, checkpoint);
  std::vector<Cost> rows;
  for (std::size_t k = 0; k < all.methods.size(); ++k)
    for (const double error : all.problem.asked)
      rows.push_back({all.methods[k], error, quickest_of(all.configurations[k], all.runs, error)});
  return rows;
}

results::Table cost_table(const MethodCheck& check) {
  results::Table table = results::make_table(
      "check-cost",
      fmt::format("Cost of {} beside others on 10 x 10 particles hung by two corners, d = 5, {:g} s", check.name, cost_end),
      cost_columns, check.cost);
  results::add_columns(table, best_columns, check.cost, [](const Cost& row) { return row.best; });
  return table;
}

}  // namespace

results::Verdict Usable::verdict() const {
  if (largest.stable == 0) return {Standing::missed, "not stable"};
  return {Standing::open, largest.stable == horizon ? "no limit seen" : "limited"};
}

results::Verdict EnergyChange::verdict() const {
  constexpr double small = 1e-2;  // part of the kinetic energy
  if (!change) return {Standing::missed, "not finished"};
  if (*gain > small) return {Standing::open, "gains energy"};
  return {Standing::open, *change < -small ? "loses energy" : "keeps energy"};
}

std::string order_title(const MethodCheck& check) {
  return fmt::format("Order of {} on a soft sheet, {:g} s", check.name, smooth_scene().end);
}

Job method_check(const std::string& method) {
  const RunSpec spec = tight(smooth_scene(), method);
  RunSpec usual{smooth_scene(), "", nullptr, 0, {}};
  choose_method(usual, method);
  const auto compute = [=](Checkpoint& checkpoint) {
    return MethodCheck{method,
                       spec.method,
                       order(spec, method, checkpoint),
                       stability_of(usual, method, checkpoint),
                       energy(method, checkpoint),
                       cost(method, checkpoint)};
  };
  const auto present = [](const MethodCheck& check) {
    return Results{.tables = {refinement_table("check-order", order_title(check), check.order), stability_table(check),
                              energy_table(check), cost_table(check)},
                   .summary = summary(check)};
  };
  return job("check", 6 + static_cast<int>(std::size(neighbours)), compute, present);
}

}  // namespace drape::bench
