#include "bench/studies/method_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/record.hpp"
#include "bench/studies/refinement.hpp"
#include "bench/studies/stability/stability.hpp"
#include "bench/studies/work_precision/work_precision.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/theory/linear_prediction.hpp"

namespace drape::bench {
namespace {

using results::TableBuilder;

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
  TableBuilder table("check-order", fmt::format("Order of {} on a soft sheet, {:g} s", method, scene.end));
  checkpoint.rows(table, method, [&](TableBuilder& rows) {
    const RunSpec cell = tight(scene, method);
    add_refinement(rows, cell, method, cloth, reference, most_work);
    rows.count("declared", "declared", "order of the method's row", cell.method->order);
  });
  checkpoint.advance();
  return table.finish();
}

/// What linear theory says of steps up to the horizon.
std::string theory_of(const solver::Method& method, double h, double k, double d) {
  const double l = 0.8 / 9, nu = h * h * k / (l * l);
  const auto prediction = reference::predict(method, nu, h * k / d);
  if (!prediction) return "no theory known";
  return std::pow(prediction->radius, horizon / h) < 10 ? "stable" : "unstable";
}

results::Table stability_of(const std::string& method, Checkpoint& checkpoint) {
  constexpr double k = 1e4;
  RunSpec cell{smooth_scene(), "", nullptr, 0, {}};
  choose_method(cell, method);
  TableBuilder table("check-stability",
                     fmt::format("Largest usable steps of {} on 10 x 10 particles hung by two corners, k = {:g}", method, k));
  for (const double d : {50.0, 0.5}) {
    checkpoint.show(fmt::format("largest steps of {}, d = {:g}", method, d));
    checkpoint.rows(table, fmt::format("{:g}", d), [&](TableBuilder& rows) {
      const Specimen specimen = hung_by_corners(10, k, d);
      rows.row();
      rows.number("damping", "d", "N s/m", "damping, linear", d);
      const LargestSteps largest =
          largest_steps(specimen, CrossCheckedReference(specimen, horizon), *cell.method, cell.options);
      add_largest(rows, largest);
      rows.text("theory", "in theory", "linear theory of the largest of all steps", theory_of(*cell.method, horizon, k, d));
      rows.text("verdict", "verdict", "up to what steps it is stable",
                largest.stable == horizon ? "no limit seen"
                : largest.stable > 0      ? "limited"
                                          : "NOT stable");
    });
    checkpoint.advance();
  }
  return table.finish();
}

/// Energies along a run over the largest kinetic one, less that at the start.
std::vector<double> energy_changes(const results::RunRecord& run, const model::Cloth& cloth) {
  const double start = solver::kinetic_energy(cloth.ode, cloth.start.v) + cloth.ode.potential_energy(0, cloth.start.x);
  double scale = 0;
  for (const auto& step : run.steps) scale = std::max(scale, step.kinetic_energy);
  std::vector<double> changes;
  for (const auto& step : run.steps) changes.push_back((step.kinetic_energy + step.potential_energy - start) / scale);
  return changes;
}

results::Table energy(const std::string& method, Checkpoint& checkpoint) {
  constexpr double small = 1e-2;  // part of the kinetic energy
  const model::Scene scene = model::load_scene(
      "hung-corners", std::vector<model::Override>{{"grid.n", "10"}, {"material.damping", "0"}, {"end.time", "1"}});
  const model::Cloth cloth = model::compile(scene);
  TableBuilder table("check-energy", fmt::format("Energy of an undamped sheet by {}, {:g} s", method, scene.end));
  for (const double h : {0.01, 0.0025}) {
    checkpoint.show(fmt::format("energy of {}, h = {:g}", method, h));
    checkpoint.rows(table, fmt::format("{:g}", h), [&](TableBuilder& rows) {
      RunSpec cell{scene, "", nullptr, h, {}};
      choose_method(cell, method);
      const results::RunRecord run = record(cell);
      rows.row();
      rows.number("step", "h", "s", "step", h);
      rows.text("outcome", "outcome", "how the run ended", std::string(to_string(run.outcome)));
      if (run.outcome != solver::Outcome::success) return rows.text("verdict", "verdict", "what", "NOT finished");
      const std::vector<double> changes = energy_changes(run, cloth);
      const double gain = std::ranges::max(changes), end = changes.back();
      rows.number("change", "change", "1", "of the energy up to the end, over the largest kinetic energy", end);
      rows.number("gain", "gain", "1", "the most that it was above that of the start", gain);
      rows.text("verdict", "verdict", "what becomes of the energy",
                gain > small   ? "gains energy"
                : end < -small ? "loses energy"
                               : "keeps energy");
    });
    checkpoint.advance();
  }
  return table.finish();
}

/// Trials of all that are compared, timed near their fronts.
struct Compared {
  Problem problem;
  std::vector<Family> families;
  std::vector<Contender> contenders;
  std::vector<Trial> trials;
};

void compare(Compared& all, const std::string& method, Checkpoint& checkpoint) {
  constexpr Effort effort{.cap = 1, .repetitions = 5};
  std::vector<std::string> names{method};
  for (const char* neighbour : neighbours)
    if (neighbour != method) names.emplace_back(neighbour);
  for (const std::string& name : names) {
    all.families.push_back(ladder(all.problem.scene, name));
    all.contenders.push_back({name, {}});
  }
  all.trials = try_all(all.problem, all.families, effort, checkpoint);
  for (std::size_t k = 0; k < all.trials.size(); ++k)
    all.contenders[static_cast<std::size_t>(all.trials[k].family - all.families.data())].members.push_back(k);
  checkpoint.show("timing");
  time_fronts(all.problem, all.contenders, all.trials, effort, checkpoint);
}

/// The quickest of a contender at an error; null if none reaches it.
const Trial* quickest_of(const Contender& contender, const std::vector<Trial>& trials, double error) {
  const auto best = results::quickest(timed(contender, trials), error);
  return best ? &trials[contender.members[*best]] : nullptr;
}

results::Table cost(const std::string& method, Checkpoint& checkpoint) {
  const model::Scene scene = model::load_scene(
      "hung-corners", std::vector<model::Override>{{"grid.n", "10"}, {"material.damping", "5"}, {"end.time", "0.3"}});
  checkpoint.show("reference of " + scene.name);
  Compared all{certified_problem(scene.name, scene, checkpoint), {}, {}, {}};
  all.problem.asked = {1e-2, 1e-3, 1e-4};
  all.problem.enough = 5e-5;
  compare(all, method, checkpoint);
  TableBuilder table(
      "check-cost",
      fmt::format("Cost of {} beside others on 10 x 10 particles hung by two corners, d = 5, {:g} s", method, scene.end));
  for (const Contender& contender : all.contenders)
    for (const double error : all.problem.asked) {
      table.row();
      table.text("method", "method", "time integrator", contender.name);
      table.number("wanted", "error", "1", "at most, over the scene's size", error);
      const Trial* best = quickest_of(contender, all.trials, error);
      if (best == nullptr) continue;
      const auto q = results::quartiles(best->measured.times);
      table.number("control", "h", "s", "step, or fraction of the stability limit, that is the quickest",
                   best->configuration().value);
      table.number("error", "", "1", "its error", best->measured.error);
      table.number("time", "time", "ms", "median wall time", q.median);
      table.number("lower", "", "ms", "lower quartile", q.lower);
      table.number("upper", "", "ms", "upper quartile", q.upper);
      table.count("forces", "forces", "evaluations", best->forces);
    }
  return table.finish();
}

}  // namespace

std::vector<TableJob> check_jobs(const std::string& method) {
  return {{1, [=](Checkpoint& checkpoint) { return order(method, checkpoint); }},
          {2, [=](Checkpoint& checkpoint) { return stability_of(method, checkpoint); }},
          {2, [=](Checkpoint& checkpoint) { return energy(method, checkpoint); }},
          {static_cast<int>(std::size(neighbours)) + 1, [=](Checkpoint& checkpoint) { return cost(method, checkpoint); }}};
}

}  // namespace drape::bench
