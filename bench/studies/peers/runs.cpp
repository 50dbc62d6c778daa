#include "bench/studies/peers/runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/run.hpp"
#include "bench/runs/samples.hpp"
#include "bench/studies/field/sheets.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/distance.hpp"
#include "solver/base/largest.hpp"

namespace drape::bench::peers {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Entrant, name, is_peer, value)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PeerRun, who, simulator, errors, seconds, reason)

namespace {

using solver::State;

/// A motion to measure by, with what it is uncertain by [m].
struct PeerTruth {
  std::vector<solver::Vectors> positions;
  double uncertainty = NAN;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PeerTruth, positions, uncertainty)

constexpr int large_sheet = 64;  ///< particles a side: certified references take hours from there on

/// The certified reference; of a large sheet without damping velocity Verlet at a tenth of its limit, extrapolated, which
/// ARKODE's explicit method confirms.
PeerTruth find_truth(const PeerSheet& sheet, Checkpoint& checkpoint) {
  const model::Cloth cloth = model::compile(sheet.scene);
  const int n = sheet.scene.sheet.grid.nu;
  if (n >= large_sheet) {
    const FieldTruth truth =
        field_truth({.scene = sheet.name, .damping = {}, .n = n, .end = sheet.scene.end}, sheet.scene, cloth, checkpoint);
    if (!truth.known()) throw reference::ReferenceError(truth.missing, "", 0);
    return {reference::positions_of(truth.compared.trajectory.states), base::largest(truth.compared.error)};
  }
  constexpr double agreement = 1e-6, rtol = 1e-10;
  const auto say = [&](const std::string& pace) { checkpoint.report("reference: " + pace); };
  const reference::Reference found = References(agreement, {.say = say}, rtol)(sheet.scene, cloth);
  return {reference::positions_of(found.trajectory.states), base::largest(found.error)};
}

/// Errors at told_times [m].
std::array<double, 3> told_errors(const std::vector<State>& states, const reference::Trajectory& truth) {
  std::array<double, 3> errors{};
  for (std::size_t k = 0; k < errors.size(); ++k)
    errors[k] = reference::rms_distance(states.at(told_times[k]).x, truth.states.at(told_times[k]).x);
  return errors;
}

std::vector<Entrant> with_steps(std::string_view name, bool is_peer, const std::vector<double>& values) {
  std::vector<Entrant> all;
  for (const double value : values) all.push_back({std::string(name), is_peer, value});
  return all;
}

/// Steps [s] for methods that stability bounds, and for all others, from coarse to fine.
struct Steps {
  std::vector<double> bounded, free;
};

std::vector<double> merged(std::vector<double> steps, const std::vector<double>& more) {
  steps.insert(steps.end(), more.begin(), more.end());
  std::ranges::sort(steps, std::greater());
  const auto [first, last] = std::ranges::unique(steps);
  steps.erase(first, last);
  return steps;
}

/// All peers that are there and can run the scene, in these steps and on the sheet of the driver also in its, and some of our
/// methods.
void add_entrants(PeerSheet& sheet, const Steps& steps, bool as_printed) {
  for (const Peer& peer : all_peers()) {
    const std::vector<double>& own = peer.is_explicit ? steps.bounded : steps.free;
    for (const Entrant& one : with_steps(peer.name, true, as_printed ? merged(own, printed_steps(peer.name)) : own))
      if (reason_against(peer, sheet.scene, one.value).empty()) sheet.entrants.push_back(one);
  }
  for (const char* name :
       {"verlet", "implicit-euler", "baraff-witkin", "bdf2", "midpoint", "imex-midpoint", "ros34pw2", "xpbd"}) {
    const auto own = with_steps(name, false, solver::method(name).sub_steps ? std::vector{0.9, 0.45} : steps.free);
    sheet.entrants.insert(sheet.entrants.end(), own.begin(), own.end());
  }
}

PeerSheet make_sheet(const std::string& name, const std::string& scene, std::vector<model::Override> overrides,
                     const Steps& steps, double limit, int repetitions) {
  PeerSheet sheet{name, model::load_scene(scene, overrides), {}, limit, repetitions};
  add_entrants(sheet, steps, name == "peer-edge 20");
  return sheet;
}

RunSpec spec_of(const Entrant& who, const model::Scene& scene) {
  constexpr double part = 0.02;  // of the end: a step that is divided
  RunSpec spec{scene, "", &solver::method(who.name), who.value, {}};
  if (spec.method->sub_steps) spec.step = part * scene.end, spec.options.verlet_fraction = who.value;
  return spec;
}

/// The end of a method of ours, and where it has one its motion.
void measure_ours(PeerRun& run, const model::Scene& scene, const reference::Trajectory& truth, double limit) {
  Samples samples(truth.times);
  Observer* const observers[] = {&samples};
  const model::Cloth cloth = model::compile(scene);
  const RunEnd end = bench::run(spec_of(run.who, scene), cloth, observers, {.seconds = limit});
  if (end.succeeded())
    run.errors = told_errors(samples.states(), truth);
  else
    run.reason = end.result.message.empty() ? std::string(to_string(end.result.outcome)) : end.result.message;
}

double time_ours(const Entrant& who, const model::Scene& scene) {
  const RunSpec spec = spec_of(who, scene);
  const model::Cloth cloth = model::compile(scene);
  const auto begin = std::chrono::steady_clock::now();
  bench::run(spec, cloth);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / scene.end;
}

/// In the first round an entrant gets its errors, and in each one a time. What had no motion in the first has none later.
void run_entrant(PeerRun& run, const PeerSheet& sheet, const reference::Trajectory& truth, bool first) {
  const Entrant& who = run.who;
  if (!who.is_peer) {
    run.simulator = "drape";
    if (first) measure_ours(run, sheet.scene, truth, sheet.limit);
    if (run.reason.empty()) run.seconds.push_back(time_ours(who, sheet.scene));
    return;
  }
  try {
    const PeerMotion motion = run_peer(peer(who.name), sheet.scene, who.value, sheet.limit);
    run.simulator = motion.simulator;
    run.seconds.push_back(motion.seconds / sheet.scene.end);
    if (first) run.errors = errors_of(who, motion, sheet.scene, truth, sheet.limit);
  } catch (const PeerError& error) {
    run.reason = error.what();
  }
}

}  // namespace

bool Entrant::divides_steps() const { return !is_peer && solver::method(name).sub_steps; }

std::string Entrant::setting() const {
  return divides_steps() ? fmt::format("{}, {:g} of its limit", name, value) : fmt::format("{}, h = {:g} s", name, value);
}

double PeerRun::error() const { return base::largest(std::vector(errors.begin(), errors.end())); }

double observed_order(const std::vector<PeerRun>& runs, std::size_t k) {
  if (k == 0 || runs[k - 1].who.name != runs[k].who.name) return NAN;
  const PeerRun &coarse = runs[k - 1], &fine = runs[k];
  return std::log(coarse.errors[0] / fine.errors[0]) / std::log(coarse.who.value / fine.who.value);
}

std::array<double, 3> errors_of(const Entrant& who, const PeerMotion& motion, const model::Scene& scene,
                                const reference::Trajectory& truth, double limit) {
  const Peer& one = peer(who.name);
  if (one.measured_by.empty()) return told_errors(motion.states, truth);
  const PeerMotion own = measuring_motion(one, scene, who.value, 2 * limit);  // at least twice as many steps
  return told_errors(motion.states, {own.times, own.states});
}

/// Uniform masses and springs, so that simulators of springs have our equation. The last is a scene as it is, for those
/// that have our forces.
std::vector<PeerSheet> peer_sheets(bool quick) {
  const std::vector<model::Override> springs{{"material.shear_form", "diagonals"}, {"grid.border_cells", "whole"}};
  const auto with = [&](std::vector<model::Override> more) {
    more.insert(more.end(), springs.begin(), springs.end());
    return more;
  };
  const std::vector<model::Override> undamped{{"material.damping", "0"}, {"end.time", "0.5"}};
  if (quick)
    return {make_sheet("peer-edge 6", "peer-edge", with({{"grid.n", "6"}, {"end.time", "0.2"}}), {{2e-3, 1e-3}, {5e-3, 2.5e-3}},
                       60, 1)};
  constexpr double small = 60, large = 180;  // [s]
  return {
      make_sheet("peer-edge 20", "peer-edge", with({{"grid.n", "20"}}), {{1e-3, 5e-4, 2.5e-4}, {1e-2, 5e-3, 2.5e-3}}, small, 3),
      make_sheet("hung-corners 20", "hung-corners", with(undamped), {{2.5e-4, 1.25e-4}, {1e-2, 5e-3, 2.5e-3}}, small, 3),
      make_sheet("peer-edge 100", "peer-edge", with({}), {{2e-4, 1e-4}, {1e-2, 5e-3}}, large, 1),
      make_sheet("hung-corners 20, damped", "hung-corners", {{"material.damping", "0.5"}, {"end.time", "0.5"}},
                 {{}, {1e-2, 5e-3, 2.5e-3, 1.25e-3}}, small, 3)};
}

PeerResult run_peers(const PeerSheet& sheet, Checkpoint& checkpoint) {
  checkpoint.begin(sheet.name);
  checkpoint.show("reference of " + sheet.name);
  const PeerTruth found = checkpoint.once("truth", [&] { return find_truth(sheet, checkpoint); });
  reference::Trajectory truth{compared_times(sheet.scene), {}};
  for (const solver::Vectors& x : found.positions) truth.states.push_back({x, {}});
  std::vector<PeerRun> runs;
  for (const Entrant& who : sheet.entrants) runs.push_back({.who = who});
  for (int round = 0; round < sheet.repetitions; ++round)
    runs = checkpoint.timed(fmt::format("round {}", round), [&] {
      std::vector<PeerRun> now = runs;
      for (PeerRun& run : now) {
        checkpoint.show(fmt::format("{}: {}", sheet.name, run.who.setting()));
        check_interruption();
        if (run.reason.empty()) run_entrant(run, sheet, truth, round == 0);
        checkpoint.advance();
      }
      return now;
    });
  return {sheet, found.uncertainty, std::move(runs)};
}

}  // namespace drape::bench::peers
