#include "bench/studies/work_precision/work_precision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/run.hpp"
#include "bench/runs/samples.hpp"
#include "bench/studies/studies.hpp"
#include "bench/studies/work_precision/tables.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/reference.hpp"
#include "reference/sundials/arkode.hpp"
#include "results/analysis/ranking.hpp"
#include "results/columns.hpp"
#include "solver/base/largest.hpp"

namespace drape::bench {
namespace {

/// Errors are measured at all tenths of the end: at some they are small by chance, and where the motion contracts those of its
/// beginning fade.
constexpr int tenths = 10;

struct Entry {
  std::string name;
  model::Scene scene;
  Search search = Search::usual;
  Effort effort = {};
  std::string training = {};  ///< the name of an entry before it, on which families are chosen for this one
};

Entry entry(const std::string& name, const std::string& scene, const std::vector<model::Override>& overrides,
            Search search = Search::usual, const Effort& effort = {}) {
  return {name, model::load_scene(scene, overrides), search, effort};
}

constexpr Effort quick_effort{.cap = 0.3, .repetitions = 3}, large_effort{.cap = 10, .repetitions = 3};

std::vector<Entry> quick_entries() {
  return {entry("hung-corners d=5", "hung-corners", {{"material.damping", "5"}, {"grid.n", "6"}, {"end.time", "0.2"}},
                Search::quick, quick_effort),
          entry("peer-edge n=8", "peer-edge", {{"grid.n", "8"}, {"end.time", "0.1"}}, Search::quick, quick_effort)};
}

/// The sheet hung by its corners, for which families are chosen on the one hung by its edge.
void add_hung_sheets(std::vector<Entry>& all, const std::string& damping) {
  for (const char* scene : {"hung-edge", "hung-corners"})
    all.push_back(entry(fmt::format("{} d={}", scene, damping), scene, {{"material.damping", damping}}, Search::full));
  all.back().training = all[all.size() - 2].name;
}

std::vector<Entry> entries() {
  std::vector<Entry> all;
  for (const char* d : {"50", "5", "0.5"}) add_hung_sheets(all, d);
  all.push_back(entry("projected", "hung-corners",
                      {{"material.damping_form", "projected"}, {"material.bend", "0.01"}, {"end.time", "0.3"}}));
  all.push_back(entry("pulled", "pulled", {{"material.damping_form", "projected"}}));
  all.push_back(entry("wind", "wind", {{"end.time", "0.5"}}));
  all.push_back(entry("tablecloth", "tablecloth", {{"end.time", "0.3"}}));
  for (const char* n : {"20", "100"}) all.push_back(entry(fmt::format("peer-edge n={}", n), "peer-edge", {{"grid.n", n}}));
  all.push_back(entry("peer-edge n=316", "peer-edge", {{"grid.n", "316"}}, Search::large, large_effort));
  return all;
}

/// And all other built-in scenes as they are, so that no ranking rests on a choice of scenes.
std::vector<Entry> with_all_scenes(std::vector<Entry> all) {
  for (const model::BuiltinScene& scene : model::builtin_scenes()) {
    const std::string name(scene.name);
    if (std::ranges::find(all, name, [](const Entry& e) { return e.scene.name; }) == all.end())
      all.push_back(entry(name, name, {}));
  }
  return all;
}

Problem problem(const Entry& entry) {
  Problem result{entry.name, entry.scene, model::size(entry.scene)};
  for (int tenth = 1; tenth < tenths; ++tenth) result.times.push_back(entry.scene.end * tenth / tenths);
  result.times.push_back(entry.scene.end);
  return result;
}

/// From the two families that certify a reference.
void find_truth(Problem& problem, Checkpoint& checkpoint) {
  const auto say = [&](const std::string& pace) { checkpoint.report("reference of " + problem.name + ": " + pace); };
  References references(1e-6, {.say = say}, 1e-10);  // errors down to 1e-7 are compared
  const model::Cloth cloth = model::compile(problem.scene);
  const auto reference = references(problem.scene, cloth);
  for (std::size_t k = 0; k < tenths; ++k) {
    problem.truth.push_back(reference.trajectory.states[k].x);
    problem.motion = base::larger(problem.motion, reference::rms_distance(problem.truth[k], cloth.start.x) / problem.length);
    problem.uncertainty = base::larger(problem.uncertainty, reference.error[k] / problem.length);
    problem.growth = base::larger(problem.growth, reference.growth[k]);
  }
}

/// Velocity Verlet, at a fraction of its stability limit, and extrapolated from twice that.
std::vector<solver::Vectors> leapfrog(const Problem& problem, double fraction) {
  const auto positions = [&](double part) {
    RunSpec spec{problem.scene, "", &solver::method("verlet"), problem.times.front(), {}};
    spec.options.verlet_fraction = part;
    Samples samples(problem.times);
    Observer* const observers[] = {&samples};
    const solver::RunResult result = run(spec, model::compile(problem.scene), observers).result;
    if (result.outcome != solver::Outcome::success) throw std::runtime_error("verlet: " + result.message);
    return reference::positions_of(std::move(samples).states());
  };
  auto fine = positions(fraction);
  const auto coarse = positions(2 * fraction);
  for (std::size_t k = 0; k < fine.size(); ++k) fine[k] += (fine[k] - coarse[k]) / 3;
  return fine;
}

/// Large undamped sheets are beyond the families' factorisations, but not stiff: two explicit families.
struct ExplicitTruth {
  std::vector<solver::Vectors> positions;
  double uncertainty = 0;  ///< [m]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ExplicitTruth, positions, uncertainty)

ExplicitTruth find_explicit_truth(const Problem& problem) {
  constexpr double fraction = 0.1, rtol = 1e-5;
  ExplicitTruth truth{leapfrog(problem, fraction)};
  const model::Cloth cloth = model::compile(problem.scene);
  const reference::SolveOptions options{.rtol = rtol, .size = model::size(problem.scene), .max_order = 4};
  const auto witness = reference::arkode_erk(cloth.ode, cloth.start, 0, problem.times, options).states;
  for (std::size_t k = 0; k < witness.size(); ++k)
    truth.uncertainty = base::larger(truth.uncertainty, reference::rms_distance(truth.positions[k], witness[k].x));
  return truth;
}

void set_explicit_truth(Problem& problem, const ExplicitTruth& truth) {
  problem.truth = truth.positions;
  problem.uncertainty = truth.uncertainty;
  problem.length = 1;  // errors in metres, as those of the other codes
  problem.asked = peer_errors();
}

/// What the tables of all scenes are made from.
using All = std::vector<SceneTrials>;

results::Table ranking_table(const All& all) {
  std::vector<results::Table> trials;
  for (const SceneTrials& scene : all) trials.push_back(trials_table(scene));
  return results::ranking(trials);
}

const SceneTrials* find(const All& all, const std::string& name) {
  const auto found = std::ranges::find(all, name, [](const SceneTrials& scene) { return scene.problem.name; });
  return found == all.end() ? nullptr : &*found;
}

void try_scene(const Entry& entry, const Methods& methods, All& all, Checkpoint& checkpoint) {
  checkpoint.begin(entry.name);
  checkpoint.show("reference of " + entry.name);
  SceneTrials& scene = all.emplace_back(SceneTrials{problem(entry), {}, {}, find(all, entry.training)});
  Problem& problem = scene.problem;
  if (entry.scene.name == "peer-edge")
    set_explicit_truth(problem, checkpoint.once("truth", [&] { return find_explicit_truth(problem); }));
  else
    find_truth(problem, checkpoint);
  scene.families = families(problem.scene, entry.search, methods);
  scene.trials = try_all(problem, scene.families, entry.effort, checkpoint);
  checkpoint.show("timing " + entry.name);
  time_fronts(problem, scene.trials, entry.effort, named_families(scene), checkpoint);
}

All try_scenes(const std::vector<Entry>& list, const Methods& methods, Checkpoint& checkpoint) {
  All all;
  all.reserve(list.size());  // trials point into what is in it
  for (const Entry& entry : list) try_scene(entry, methods, all, checkpoint);
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
results::Table left_out_table(const std::vector<Entry>& list, const Methods& methods) {
  std::vector<Absent> rows;
  for (const Entry& entry : list)
    for (const LeftOut& left : left_out(entry.scene, entry.search, methods))
      rows.push_back({entry.name, std::string(left.method->name), left.reason});
  return results::make_table("left-out", "Methods that were not tried", absent_columns, rows);
}

std::vector<results::Table> all_tables(const All& all) {
  std::vector<results::Table> tables;
  for (const SceneTrials& scene : all) tables.push_back(trials_table(scene));
  for (auto* table :
       {held_out_table, recommended_table, winners_table, quickest_table, peers_summary_table, defaults_table, peers_table})
    tables.push_back(table(all));
  if (all.size() > 1) tables.push_back(ranking_table(all));
  return tables;
}

std::vector<Job> jobs(const std::vector<Entry>& list, const Methods& methods, bool with_bars = false) {
  int parts = 0;
  for (const Entry& entry : list) parts += static_cast<int>(families(entry.scene, entry.search, methods).size());
  const auto compute = [=](Checkpoint& checkpoint) { return try_scenes(list, methods, checkpoint); };
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
  find_truth(result, checkpoint);
  return result;
}

std::vector<Job> work_precision(const Question& question) {
  const auto& [quick, methods, scene] = question;
  if (!scene) return jobs(quick ? quick_entries() : with_all_scenes(entries()), methods);
  if (quick) return jobs({{scene->name, *scene, Search::quick, quick_effort}}, methods);
  constexpr int large = 50'000;  // particles
  if (scene->sheet.grid.particles() >= large) return jobs({{scene->name, *scene, Search::large, large_effort}}, methods);
  return jobs({{scene->name, *scene, Search::full}}, methods);
}

std::vector<Job> bars(const Question& question) { return jobs(question.quick ? quick_entries() : entries(), {}, true); }

}  // namespace drape::bench
