#include "bench/studies/work_precision/work_precision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/run.hpp"
#include "bench/runs/samples.hpp"
#include "bench/studies/studies.hpp"
#include "bench/studies/work_precision/ranking.hpp"
#include "bench/studies/work_precision/winners.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/reference.hpp"
#include "reference/sundials/arkode.hpp"
#include "results/columns.hpp"
#include "solver/base/largest.hpp"

namespace drape::bench {
namespace {

/// A scene of the study, and how much is tried on it.
struct StudiedScene {
  std::string name;
  model::Scene scene;
  Search search = Search::usual;
  Effort effort = {};
  std::string training = {};  ///< the name of one before it, on which configurations are chosen for this one
  bool in_metres = false;     ///< as Problem has it, as the following
  bool against_sundials = false;
};

StudiedScene studied(const std::string& name, const std::string& scene, const std::vector<model::Override>& overrides,
                     Search search = Search::usual, const Effort& effort = {}) {
  return {name, model::load_scene(scene, overrides), search, effort};
}

constexpr Effort quick_effort{.limits = {.seconds = 0.3}, .repetitions = 3},
    large_effort{.limits = {.seconds = 10}, .repetitions = 3};

std::vector<StudiedScene> quick_scenes() {
  std::vector<StudiedScene> all{
      studied("hung-corners d=5", "hung-corners", {{"material.damping", "5"}, {"grid.n", "6"}, {"end.time", "0.2"}},
              Search::quick, quick_effort),
      studied("peer-edge n=8", "peer-edge", {{"grid.n", "8"}, {"end.time", "0.1"}}, Search::quick, quick_effort)};
  all.front().against_sundials = true;
  all.back().in_metres = true;
  return all;
}

/// The sheet hung by its corners, for which configurations are chosen on the one hung by its edge.
void add_hung_sheets(std::vector<StudiedScene>& all, const std::string& damping) {
  for (const char* scene : {"hung-edge", "hung-corners"})
    all.push_back(studied(fmt::format("{} d={}", scene, damping), scene, {{"material.damping", damping}}, Search::full));
  all.back().training = all[all.size() - 2].name;
  all.back().against_sundials = true;
}

std::vector<StudiedScene> chosen_scenes() {
  std::vector<StudiedScene> all;
  for (const char* d : {"50", "5", "0.5"}) add_hung_sheets(all, d);
  all.push_back(studied("projected", "hung-corners",
                        {{"material.damping_form", "projected"}, {"material.bend", "0.01"}, {"end.time", "0.3"}}));
  all.push_back(studied("pulled", "pulled", {{"material.damping_form", "projected"}}));
  all.push_back(studied("wind", "wind", {{"end.time", "0.5"}}));
  all.push_back(studied("tablecloth", "tablecloth", {{"end.time", "0.3"}}));
  const std::size_t before = all.size();
  for (const char* n : {"20", "100"}) all.push_back(studied(fmt::format("peer-edge n={}", n), "peer-edge", {{"grid.n", n}}));
  all.push_back(studied("peer-edge n=316", "peer-edge", {{"grid.n", "316"}}, Search::large, large_effort));
  for (std::size_t k = before; k < all.size(); ++k) all[k].in_metres = true;
  return all;
}

/// And all other built-in scenes of one sheet as they are, so that no ranking rests on a choice of scenes.
std::vector<StudiedScene> with_all_scenes(std::vector<StudiedScene> all) {
  for (const model::BuiltinScene& scene : model::builtin_scenes()) {
    const std::string name(scene.name);
    if (!model::load_scene(name).panels.empty()) continue;
    if (std::ranges::find(all, name, [](const StudiedScene& one) { return one.scene.name; }) == all.end())
      all.push_back(studied(name, name, {}));
  }
  return all;
}

/// Errors are measured at compared_times(): at some they are small by chance, and where the motion contracts those of its
/// beginning fade.
Problem problem(const StudiedScene& studied) {
  return {.name = studied.name,
          .scene = studied.scene,
          .length = model::size(studied.scene),
          .times = compared_times(studied.scene),
          .in_metres = studied.in_metres,
          .against_sundials = studied.against_sundials};
}

/// That of the two solvers that certify a reference.
void set_truth(Problem& problem, Checkpoint& checkpoint) {
  const auto say = [&](const std::string& pace) { checkpoint.report("reference of " + problem.name + ": " + pace); };
  References references(1e-6, {.say = say}, 1e-10);  // errors down to 1e-7 are compared
  const model::Cloth cloth = model::compile(problem.scene);
  const auto reference = references(problem.scene, cloth);
  for (std::size_t k = 0; k < problem.times.size(); ++k) {
    problem.truth.push_back(reference.trajectory.states[k].x);
    problem.motion = base::larger(problem.motion, reference::rms_distance(problem.truth[k], cloth.start.x) / problem.length);
    problem.uncertainty = base::larger(problem.uncertainty, reference.error[k] / problem.length);
    problem.growth = base::larger(problem.growth, reference.growth[k]);
  }
}

using Positions = std::vector<solver::Vectors>;

/// What a run comes to at the times of a problem.
Positions positions_of(const Problem& problem, const RunSpec& spec) {
  Samples samples(problem.times);
  Observer* const observers[] = {&samples};
  const solver::RunResult result = run(spec, model::compile(problem.scene), observers).result;
  if (result.outcome != solver::Outcome::success) throw std::runtime_error(spec.method_name() + ": " + result.message);
  return reference::positions_of(std::move(samples).states());
}

/// Velocity Verlet, at a fraction of its stability limit, and extrapolated from twice that.
Positions leapfrog(const Problem& problem, double fraction) {
  const auto positions = [&](double part) {
    RunSpec spec{problem.scene, "", &solver::method("verlet"), problem.times.front(), {}};
    spec.options.verlet_fraction = part;
    return positions_of(problem, spec);
  };
  Positions fine = positions(fraction);
  const Positions coarse = positions(2 * fraction);
  for (std::size_t k = 0; k < fine.size(); ++k) fine[k] += (fine[k] - coarse[k]) / 3;
  return fine;
}

/// Positions by one method, and how far they are from those of another family.
struct WitnessedTruth {
  Positions positions;
  double uncertainty = 0;  ///< that distance [m]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(WitnessedTruth, positions, uncertainty)

WitnessedTruth truth_beside(Positions positions, const Positions& witness) {
  WitnessedTruth truth{std::move(positions)};
  for (std::size_t k = 0; k < witness.size(); ++k)
    truth.uncertainty = base::larger(truth.uncertainty, reference::rms_distance(truth.positions[k], witness[k]));
  return truth;
}

/// Large undamped sheets are beyond those solvers' factorisations, but not stiff: two explicit ones.
WitnessedTruth compute_explicit_truth(const Problem& problem, double rtol) {
  constexpr double fraction = 0.1;
  const model::Cloth cloth = model::compile(problem.scene);
  const reference::SolveOptions options{.rtol = rtol, .size = model::size(problem.scene), .max_order = 4};
  const auto witness = reference::arkode_erk(cloth.ode, cloth.start, 0, problem.times, options).states;
  return truth_beside(leapfrog(problem, fraction), reference::positions_of(witness));
}

WitnessedTruth compute_stepped_truth(const Problem& problem, Checkpoint& checkpoint) {
  constexpr double agreement = 1e-8, stages = 0.01;
  const auto by = [&](const char* method, int parts) {
    RunSpec spec{problem.scene, "", &solver::method(method), problem.times.back() / parts, {}};
    spec.options.stage_accuracy = stages;
    checkpoint.report(fmt::format("reference of {}: {} with {} steps", problem.name, method, parts));
    return positions_of(problem, spec);
  };
  constexpr int fewest = 400, most = 6400;
  for (int parts = fewest;; parts *= 4) {
    WitnessedTruth truth = truth_beside(by("bdf5", parts), by("esdirk4", parts));
    if (truth.uncertainty <= agreement * model::size(problem.scene) || parts >= most) return truth;
  }
}

/// A problem with a truth that compute() gives, or a checkpoint.
template <class Compute>
Problem problem_by(const std::string& name, const model::Scene& scene, Checkpoint& checkpoint, const Compute& compute) {
  Problem result = problem({name, scene});
  const WitnessedTruth truth = checkpoint.once("truth", [&] { return compute(result); });
  result.truth = truth.positions;
  result.uncertainty = truth.uncertainty / result.length;
  return result;
}

void set_explicit_truth(Problem& problem, const WitnessedTruth& truth) {
  problem.truth = truth.positions;
  problem.uncertainty = truth.uncertainty;
  problem.length = 1;  // errors in metres, as those of the bars
  for (const PeerBar& bar : peer_bars) problem.asked.push_back(bar.error);
}

/// What the tables of all scenes are made from.
using All = std::vector<SceneRuns>;

const SceneRuns* find(const All& all, const std::string& name) {
  const auto found = std::ranges::find(all, name, [](const SceneRuns& scene) { return scene.problem.name; });
  return found == all.end() ? nullptr : &*found;
}

void run_scene(const StudiedScene& studied, const Methods& methods, All& all, Checkpoint& checkpoint) {
  checkpoint.begin(studied.name);
  checkpoint.show("reference of " + studied.name);
  SceneRuns& scene = all.emplace_back(SceneRuns{problem(studied), {}, {}, find(all, studied.training)});
  Problem& problem = scene.problem;
  if (problem.in_metres)
    set_explicit_truth(problem, checkpoint.once("truth", [&] { return compute_explicit_truth(problem, 1e-5); }));
  else
    set_truth(problem, checkpoint);
  scene.configurations = configurations(problem.scene, studied.search, methods);
  scene.runs = run_all(problem, scene.configurations, studied.effort, checkpoint);
  checkpoint.show("timing " + studied.name);
  time_fronts(problem, scene.runs, studied.effort, named_configurations(scene), checkpoint);
}

All run_scenes(const std::vector<StudiedScene>& list, const Methods& methods, Checkpoint& checkpoint) {
  All all;
  all.reserve(list.size());    // runs point into what is in it
  std::set<std::string> done;  // a scene needs the whole of what it is trained on
  checkpoint.each(list, [&](const StudiedScene& studied) {
    if (find(all, studied.training) != nullptr && !done.contains(studied.training)) throw ComputedElsewhere();
    run_scene(studied, methods, all, checkpoint);
    done.insert(studied.name);
  });
  return all;
}

/// A method that is not tried on a scene.
struct Absent {
  std::string scene, method, reason;
};

constexpr results::ColumnOf<Absent> absent_columns[] = {
    {"scene", "scene", "", "its name", results::Role::key, results::field<&Absent::scene>},
    {"method", "method", "", "time integrator", results::Role::key, results::field<&Absent::method>},
    {"reason", "reason", "", "why it was not tried", results::Role::note, results::field<&Absent::reason>},
};

/// Our methods that are not tried, so that their absence is not taken for a defeat.
results::Table left_out_table(const std::vector<StudiedScene>& list, const Methods& methods) {
  std::vector<Absent> rows;
  for (const StudiedScene& studied : list)
    for (const LeftOut& left : left_out(studied.scene, studied.search, methods))
      rows.push_back({studied.name, std::string(left.method->name), left.reason});
  return results::make_table("left-out", "Methods that were not tried", absent_columns, rows);
}

std::vector<results::Table> all_tables(const All& all) {
  std::vector<results::Table> tables;
  for (const SceneRuns& scene : all) tables.push_back(runs_table(scene));
  for (auto* table : {held_out_table, recommended_table, winners_table, quickest_table, peers_summary_table, defaults_table})
    tables.push_back(table(all));
  if (all.size() > 1) tables.push_back(ranking_table(all));
  return tables;
}

std::vector<Job> jobs(const std::vector<StudiedScene>& list, const Methods& methods, bool with_bars = false) {
  int parts = 0;
  for (const StudiedScene& studied : list)
    parts += static_cast<int>(configurations(studied.scene, studied.search, methods).size());
  const auto compute = [=](Checkpoint& checkpoint) { return run_scenes(list, methods, checkpoint); };
  const auto present = [=](const All& all) {
    std::vector<results::Table> tables = all_tables(all);
    if (with_bars) tables.push_back(bars_table(all));
    if (results::Table table = left_out_table(list, methods); results::rows(table) > 0) tables.push_back(std::move(table));
    return tables;
  };
  return {job("work-precision", parts, compute, present)};
}

}  // namespace

Problem certified_problem(const std::string& name, const model::Scene& scene, Checkpoint& checkpoint) {
  Problem result = problem({name, scene});
  set_truth(result, checkpoint);
  return result;
}

Problem explicit_problem(const std::string& name, const model::Scene& scene, Checkpoint& checkpoint) {
  return problem_by(name, scene, checkpoint, [](const Problem& one) { return compute_explicit_truth(one, 1e-7); });
}

Problem stepped_problem(const std::string& name, const model::Scene& scene, Checkpoint& checkpoint) {
  return problem_by(name, scene, checkpoint, [&](const Problem& one) { return compute_stepped_truth(one, checkpoint); });
}

std::vector<Job> work_precision(const Question& question) {
  const auto& [quick, methods, scene] = question;
  if (!scene) return jobs(quick ? quick_scenes() : with_all_scenes(chosen_scenes()), methods);
  constexpr int large = 50'000;  // particles
  StudiedScene studied{scene->name, *scene, Search::full};
  if (quick)
    studied.search = Search::quick, studied.effort = quick_effort;
  else if (scene->sheet.grid.particles() >= large)
    studied.search = Search::large, studied.effort = large_effort;
  studied.in_metres = std::ranges::any_of(
      chosen_scenes(), [&](const StudiedScene& one) { return one.in_metres && one.scene.name == scene->name; });
  return jobs({studied}, methods);
}

std::vector<Job> bars(const Question& question) { return jobs(question.quick ? quick_scenes() : chosen_scenes(), {}, true); }

}  // namespace drape::bench
