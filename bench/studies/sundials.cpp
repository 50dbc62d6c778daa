#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/timing.hpp"
#include "bench/studies/studies.hpp"
#include "bench/studies/work_precision/peers.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/reference.hpp"
#include "reference/sundials/sundials_build.hpp"
#include "results/analysis/work_precision.hpp"
#include "results/columns.hpp"

namespace drape::bench {
namespace {

/// A setup of SUNDIALS with one value, and what an independent driver measured of it on the same forces with SUNDIALS built
/// with our flags: the largest error at 0.7, 0.9 and 1 of the end, and the CPU time [ms].
struct PeerRow {
  const char* damping;
  PeerSetup setup;
  double value, their_error, their_ms;
};

PeerSetup midpoint(double stage_tolerance, bool deduced = false) {
  return {.package = Code::arkode_steps,
          .newton = &reference::newton_solve("constant"),
          .velocity_weight = 100,
          .kept_factor = 0.3,
          .tableau = &reference::tableau("midpoint"),
          .stage_tolerance = stage_tolerance,
          .deduced = deduced};
}
PeerSetup with_gmres(double velocity_weight) {
  return {Code::cvode_bdf, &reference::newton_solve("constant-gmres"), 5, velocity_weight, 0.3};
}

std::vector<PeerRow> rows(bool quick) {
  std::vector<PeerRow> all{
      {"50", midpoint(1e-3, true), 0.1, 9.1e-3, 1.01}, {"50", midpoint(1e-3), 0.05, 5.5e-4, 1.52},
      {"50", midpoint(1e-2), 0.025, 8.5e-5, 2.16},     {"50", midpoint(1e-2), 1. / 60, 2.8e-6, 2.87},
      {"50", midpoint(1e-2), 0.01, 9.5e-7, 4.44},      {"50", midpoint(1e-3), 0.003125, 8.9e-8, 13.0},
      {"5", with_gmres(1000), 1e-5, 9.6e-5, 15.2},     {"5", with_gmres(1000), 1e-6, 8.1e-6, 18.4},
      {"0.5", with_gmres(100), 1e-4, 5.0e-3, 22.6},    {"0.5", with_gmres(1000), std::pow(10, -5.5), 8.2e-5, 45.7}};
  if (quick) all.resize(2);
  return all;
}

/// A scene with the truth at compared_times().
struct Case {
  model::Scene scene;
  double size;
  std::vector<double> times;
  std::vector<solver::Vectors> truth;

  /// The largest error at all times, over the size of the scene.
  double error(const std::vector<solver::Vectors>& positions) const {
    return reference::largest_rms_distance(positions, truth) / size;
  }

  /// The same at 0.7, 0.9 and 1 of the end.
  double late_error(const std::vector<solver::Vectors>& positions) const {
    const auto late = [](const std::vector<solver::Vectors>& all) { return std::vector{all.at(6), all.at(8), all.at(9)}; };
    return reference::largest_rms_distance(late(positions), late(truth)) / size;
  }
};

Case make_case(const std::string& damping, bool quick) {
  std::vector<model::Override> overrides{{"material.damping", damping}};
  if (quick) overrides.insert(overrides.end(), {{"grid.n", "6"}, {"end.time", "0.2"}});
  Case result{model::load_scene("hung-corners", overrides), 0, {}, {}};
  result.size = model::size(result.scene);
  result.times = compared_times(result.scene);
  References references(1e-6, {}, 1e-10);
  result.truth = reference::positions_of(references(result.scene, model::compile(result.scene)).trajectory.states);
  return result;
}

std::vector<solver::Vectors> solve(const PeerRow& row, const Case& on) {
  const model::Cloth cloth = model::compile(on.scene);
  return reference::positions_of(solve_by_peer(row.setup, row.value, on.size, cloth.ode, cloth.start, on.times));
}

std::vector<double> times_of(const PeerRow& row, const Case& on) {
  constexpr int repetitions = 15;
  const auto prepare = [&] {
    return [&, cloth = std::make_shared<model::Cloth>(model::compile(on.scene))] {
      solve_by_peer(row.setup, row.value, on.size, cloth->ode, cloth->start, on.times);
    };
  };
  return time_runs(
      {{prepare, repetitions}}, [] {}, TimeOf::process)[0];
}

/// What we measure of a setup.
struct PeerMeasured {
  double error, over_motion;
  std::vector<double> times;  ///< [ms]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PeerMeasured, error, over_motion, times)

PeerMeasured measure(const PeerRow& row, const Case& on) {
  const auto positions = solve(row, on);
  return {.error = on.late_error(positions), .over_motion = on.error(positions), .times = times_of(row, on)};
}

/// What the driver measured, and what we do.
struct Reproduced {
  PeerRow row;
  PeerMeasured ours;

  results::Quartiles times() const { return results::quartiles(ours.times); }
};

using results::Datum;
using results::Role;

constexpr results::ColumnOf<Reproduced> reproduced_columns[] = {
    {"damping", "d", "", "linear damping [N s/m] of hung-corners", Role::key,
     [](const Reproduced& r) -> Datum { return r.row.damping; }},
    {"setup", "setup", "", "of SUNDIALS", Role::key, [](const Reproduced& r) -> Datum { return r.row.setup.name(); }},
    {"value", "value", "1", "step [s] or tolerance", Role::key, [](const Reproduced& r) -> Datum { return r.row.value; }},
    {"error", "error", "1", "largest at 0.7, 0.9 and 1 of the end, over the scene's size", Role::error,
     [](const Reproduced& r) -> Datum { return r.ours.error; }},
    {"theirs", "driver's", "1", "the same by an independent driver", Role::quantity,
     [](const Reproduced& r) -> Datum { return r.row.their_error; }},
    {"over_motion", "over motion", "1", "largest error at all tenths", Role::error,
     [](const Reproduced& r) -> Datum { return r.ours.over_motion; }},
    {"time", "CPU", "ms", "median CPU time", Role::time, [](const Reproduced& r) -> Datum { return r.times().median; }},
    {"lower", "", "ms", "lower quartile", Role::time, [](const Reproduced& r) -> Datum { return r.times().lower; }},
    {"upper", "", "ms", "upper quartile", Role::time, [](const Reproduced& r) -> Datum { return r.times().upper; }},
    {"their_time", "driver's", "ms", "the driver's, the minimum of three, with SUNDIALS built with our flags", Role::time,
     [](const Reproduced& r) -> Datum { return r.row.their_ms; }},
};

std::vector<Reproduced> reproduce(bool quick, Checkpoint& checkpoint) {
  std::vector<Reproduced> all;
  std::string damping;
  std::optional<Case> on;
  checkpoint.each(rows(quick), [&](const PeerRow& row) {
    checkpoint.show(fmt::format("d = {}, {}: {:g}", row.damping, row.setup.name(), row.value));
    all.push_back({row, checkpoint.timed(fmt::format("{} {} {}", row.damping, row.setup.name(), row.value), [&] {
                     if (row.damping != damping) on = make_case(damping = row.damping, quick);
                     return measure(row, *on);
                   })});
    checkpoint.advance();
  });
  return all;
}

results::Table reproduced_table(const std::vector<Reproduced>& rows) {
  return results::make_table("sundials",
                             fmt::format("SUNDIALS as an independent driver has set it up; {}", reference::sundials_build()),
                             reproduced_columns, rows);
}

}  // namespace

std::vector<Job> sundials_setups(const Question& question) {
  const bool quick = question.quick;
  const auto compute = [quick](Checkpoint& checkpoint) { return reproduce(quick, checkpoint); };
  return {job("sundials", static_cast<int>(rows(quick).size()), compute, reproduced_table)};
}

}  // namespace drape::bench
