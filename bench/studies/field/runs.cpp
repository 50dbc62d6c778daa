#include "bench/studies/field/runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>

#include "bench/runs/energy_guard.hpp"
#include "bench/runs/lag.hpp"
#include "bench/runs/motion_error.hpp"
#include "bench/runs/run.hpp"
#include "bench/runs/samples.hpp"
#include "bench/runs/timing.hpp"

namespace drape::bench {
namespace {

using solver::Method;
using solver::State;

/// The setting recommended to all: a hundred steps a second, as in the thesis; where stability gives the sub-steps, the
/// program's fraction.
constexpr double recommended_step = 0.01;  ///< [s]

/// What a run may take: a limit that is the same on every machine, evaluations times particles, and CPU seconds, which grow
/// with the particles from the small sheets to the large.
constexpr double most_evaluated = 1e8;
constexpr double seconds_small = 1, seconds_large = 3, seconds_quick = 0.15;
constexpr int large_sheet = 64;  ///< particles a side

/// A first run that was slower than another of its method by less than this factor may have been so by chance.
constexpr double unlucky = 1.4;

constexpr int repetitions_of_all = 3;  ///< the fewest times that show a spread

Limits limits_of(const FieldSheet& sheet) {
  const double particles = static_cast<double>(sheet.n) * sheet.n;
  const double seconds = sheet.n >= large_sheet ? seconds_large : seconds_small;
  return {.seconds = sheet.quick ? seconds_quick : seconds,
          .evaluations = static_cast<std::int64_t>(most_evaluated / particles)};
}

/// From coarse to fine. Explicit methods that keep their steps need far finer ones.
std::vector<double> values_of(const Method& method, bool quick) {
  if (method.sub_steps) return quick ? std::vector{0.9} : std::vector{0.9, 0.45, 0.225};
  if (method.explicit_springs()) return quick ? std::vector{0.01, 1e-4} : std::vector{0.01, 2.5e-3, 5e-4, 1e-4, 2.5e-5};
  return quick ? std::vector{0.01, 2.5e-3} : std::vector{0.02, 0.01, 5e-3, 2.5e-3, 1.25e-3};
}

bool is_recommended(const Method& method, double value) {
  return value == (method.sub_steps ? solver::Options().verlet_fraction : recommended_step);
}

RunSpec spec_of_field(const model::Scene& scene, const FieldRun& run) {
  RunSpec spec{scene, "", &solver::method(run.method), run.value, {}};
  if (spec.method->sub_steps) spec.step = recommended_step, spec.options.verlet_fraction = run.value;
  return spec;
}

void measure_motion(FieldRun& run, const std::vector<State>& states, const FieldTruth& truth, const model::Scene& scene,
                    const model::Cloth& cloth) {
  const results::MotionErrorRecord errors = motion_error(states, truth.compared, scene, cloth);
  run.error = errors.position, run.energy = errors.energy;
  run.momentum = errors.momentum, run.angular_momentum = errors.angular_momentum;
  const reference::Trajectory& exact = truth.compared.trajectory;
  const double t = exact.times.back(), scale = motion_scale(cloth, exact, model::size(scene)).energy;
  run.energy_at_end = (total_energy(cloth, t, states.back()) - total_energy(cloth, t, exact.states.back())) / scale;
  const Delay late = delay(exact.times, states, truth.motion);
  run.lag = late.seconds;
  run.lag_uncertainty = std::hypot(truth.interpolation, truth.uncertainty * model::size(scene)) / late.speed;
}

void run_once(FieldRun& run, const FieldSheet& sheet, const model::Scene& scene, const FieldTruth& truth) {
  const model::Cloth cloth = model::compile(scene);
  EnergyGuardObserver guard;
  Samples samples(truth.known() ? truth.compared.trajectory.times : std::vector{scene.end});
  Observer* const observers[] = {&guard, &samples};
  const RunEnd end = bench::run(spec_of_field(scene, run), cloth, observers, limits_of(sheet));
  run.outcome = end.result.outcome;
  run.reason = end.succeeded() ? "" : end.result.message;
  run.steps = end.result.steps;
  run.evaluations = end.evaluations;
  for (const solver::Counters::Kind& kind : cloth.ode.work->kinds())
    if (kind.name == "updates") run.systems = kind.count;
  if (!end.succeeded()) return;
  run.times = {end.cpu_ms};
  if (truth.known()) measure_motion(run, samples.states(), truth, scene, cloth);
}

bool exceeded(const FieldRun& run) {
  return run.outcome == solver::Outcome::out_of_time || run.outcome == solver::Outcome::out_of_evaluations;
}

std::vector<FieldRun> runs_of_method(const Method& method, const FieldSheet& sheet, const model::Scene& scene,
                                     const FieldTruth& truth) {
  std::vector<FieldRun> runs;
  for (const double value : values_of(method, sheet.quick)) {
    FieldRun& run = runs.emplace_back(FieldRun{.method = std::string(method.name), .value = value});
    run.recommended = is_recommended(method, value);
    run_once(run, sheet, scene, truth);
    if (exceeded(run) && (run.recommended || value < recommended_step)) break;  // finer ones take longer
  }
  return runs;
}

/// The recommended ones, and those that are the quickest of their method at some error, or nearly.
std::vector<std::size_t> worth_timing(const SheetResult& sheet) {
  std::set<std::size_t> chosen;
  for (std::size_t begin = 0, end = 0; begin < sheet.runs.size(); begin = end) {
    std::vector<results::Measured> measured;
    for (; end < sheet.runs.size() && sheet.runs[end].method == sheet.runs[begin].method; ++end)
      measured.push_back(sheet.runs[end].measured());
    for (const std::size_t k : results::near_quickest(measured, field_levels(sheet), unlucky)) chosen.insert(begin + k);
  }
  for (std::size_t k = 0; k < sheet.runs.size(); ++k)
    if (sheet.runs[k].recommended && sheet.runs[k].counts()) chosen.insert(k);
  return {chosen.begin(), chosen.end()};
}

void time_field(SheetResult& sheet, const model::Scene& scene, Checkpoint& checkpoint) {
  const std::vector<std::size_t> chosen = worth_timing(sheet);
  std::vector<Repeated> repeated;
  for (const std::size_t k : chosen) {
    const auto prepare = [&scene, spec = spec_of_field(scene, sheet.runs[k])] {
      return [&spec, cloth = std::make_shared<model::Cloth>(model::compile(scene))] { run(spec, *cloth); };
    };
    repeated.push_back({prepare, repetitions_of_all});
  }
  const auto times = checkpoint.timed("times", [&] {
    return time_runs(
        repeated, [] {}, TimeOf::process);
  });
  for (std::size_t k = 0; k < chosen.size(); ++k) sheet.runs[chosen[k]].times = times[k];
}

}  // namespace

std::string FieldRun::setting() const {
  return solver::method(method).sub_steps ? fmt::format("{}, {:g} of its limit", method, value)
                                          : fmt::format("{}, h = {:g} s", method, value);
}

std::vector<double> field_levels(const SheetResult& sheet) {
  constexpr double part = 0.3;  // of an error that the reference may be uncertain by
  std::vector<double> levels(std::begin(field_errors), std::end(field_errors));
  std::erase_if(levels, [&](double error) { return !(sheet.uncertainty <= part * error); });
  return levels;
}

SheetResult run_sheet(const FieldSheet& sheet, const Methods& methods, Checkpoint& checkpoint) {
  checkpoint.begin(sheet.name());
  const model::Scene scene = sheet.load();
  const model::Cloth cloth = model::compile(scene);
  const FieldTruth truth = field_truth(sheet, scene, cloth, checkpoint);
  SheetResult result{sheet, scene.sheet.material.damping.weft, model::stiffness_to_damping(scene, recommended_step),
                     truth.known() ? truth.uncertainty : NAN, truth.missing};
  checkpoint.each(all_or(methods), [&](const Method* method) {
    checkpoint.show(fmt::format("{}: {}", sheet.name(), method->name));
    if (reason_against(*method, scene).empty())
      std::ranges::move(
          checkpoint.timed(std::string(method->name), [&] { return runs_of_method(*method, sheet, scene, truth); }),
          std::back_inserter(result.runs));
    checkpoint.advance();
  });
  checkpoint.show("timing " + sheet.name());
  time_field(result, scene, checkpoint);
  return result;
}

}  // namespace drape::bench
