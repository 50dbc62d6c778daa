#include "bench/studies/work_precision/configurations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/runs/automatic.hpp"
#include "bench/runs/energy_guard.hpp"
#include "bench/runs/run.hpp"
#include "bench/runs/samples.hpp"
#include "bench/studies/work_precision/peers.hpp"

namespace drape::bench {
namespace {

/// The methods of the thesis with a loop.
constexpr const char* looped[] = {"implicit-euler", "bdf2", "midpoint"};

/// What is tried of the implicit methods where not all are.
constexpr const char* few[] = {"bdf2", "midpoint", "sbdf2", "imex-midpoint"};

/// Stage and linear solvers other than the program's choice that are tried where much is.
constexpr const char* other_solvers[] = {"bdf2/anderson", "midpoint/anderson", "bdf3/anderson",   "bdf4/anderson",
                                         "bdf5/anderson", "bdf2/newton",       "midpoint/newton", "bdf2/mic0"};

bool tries_few(Search search) { return search == Search::quick || search == Search::large; }

/// This is timed: where only the end is asked for, nothing looks at the run.
Solved solve_ours(const RunSpec& spec, const model::Cloth& cloth, std::span<const double> times, const Limits& limits) {
  Samples samples({times.begin(), times.end()});
  std::vector<Observer*> observers;
  if (times.size() > 1) observers.push_back(&samples);
  Solved solved{run(spec, cloth, observers, limits)};
  if (!solved.end.succeeded()) return solved;
  if (times.size() > 1)
    solved.states = std::move(samples).states();
  else
    solved.states.push_back(std::move(solved.end.state));
  return solved;
}

Variant ours(const RunSpec& spec, double value) {
  return {value,
          [spec](const model::Cloth& cloth, std::span<const double> times, const Limits& limits) {
            return solve_ours(spec, cloth, times, limits);
          },
          [spec](const Limits& limits) { return run_guarded(spec, model::compile(spec.scene), limits); }};
}

RunSpec spec_of(const model::Scene& scene, const std::string& name, const solver::Options& options = {}) {
  RunSpec result{scene, "", nullptr, scene.end / 10, options};
  choose_method(result, name);
  return result;
}

bool by_default(const RunSpec& spec) {
  const solver::Options usual, &options = spec.options;
  return options.stage == usual.stage && options.linear_solver == usual.linear_solver &&
         options.stage_accuracy == usual.stage_accuracy;
}

Configuration by_steps(RunSpec spec, Code code, int parts) {
  Configuration all{spec.method_name() + " by steps", code, Control::step, by_default(spec) ? spec.method : nullptr};
  for (const double h : divided_steps(spec.scene.end, parts)) {
    spec.step = h;
    all.variants.push_back(ours(spec, h));
  }
  return all;
}

Configuration by_tolerance(RunSpec spec) {
  Configuration all{spec.method_name() + " by tolerance", Code::drape, Control::tolerance, spec.method};
  for (const double tolerance : tolerances(9)) {
    spec.options.error_control = {tolerance, model::size(spec.scene), spec.scene.end};
    all.variants.push_back(ours(spec, tolerance));
  }
  return all;
}

/// Explicit sub-steps follow the stability limit, however long the step.
Configuration by_fraction(RunSpec spec, int halvings) {
  Configuration all{spec.method_name() + " by fraction", Code::explicit_steps, Control::fraction, spec.method};
  for (int k = 0; k <= 2 * halvings; ++k) {
    spec.options.verlet_fraction = 0.9 * std::pow(2.0, -0.5 * k);
    all.variants.push_back(ours(spec, spec.options.verlet_fraction));
  }
  return all;
}

/// The loop of the thesis with another linear solver, to a number of digits; and stages that end as far off as the time step.
void add_loose(std::vector<Configuration>& all, const model::Scene& scene, const std::string& method, int parts) {
  solver::Options options;
  for (const double tolerance : {0.1, 0.01}) {
    options.loop_tolerance = tolerance;
    all.push_back(by_steps(spec_of(scene, method + "/fixed-point/cholesky", options), Code::drape, parts));
    all.back().name += fmt::format(" to {:.0e}", tolerance);
  }
  options = {};
  options.stage_accuracy = 1;
  all.push_back(by_steps(spec_of(scene, method, options), Code::drape, parts));
  all.back().name += fmt::format(" to {:g}", options.stage_accuracy);
}

/// Methods that the study tries unasked, so that both sides have as many configurations.
constexpr std::string_view searched[] = {"imex-euler",    "implicit-euler", "sbdf2",   "bdf2",    "midpoint",
                                         "imex-midpoint", "verlet",         "tr-bdf2", "esdirk3", "esdirk4",
                                         "bdf3",          "bdf4",           "bdf5"};

/// Why a method is not tried; empty if it is. `named`: it was asked for by its name.
std::string reason_to_leave_out(const solver::Method& method, const model::Scene& scene, Search search, bool named) {
  if (std::string reason = reason_against(method, scene); !reason.empty()) return reason;
  if (!named && std::ranges::find(searched, method.name) == std::end(searched))
    return "both sides are searched alike; name it by --method";
  if (named || method.sub_steps || !tries_few(search) || std::ranges::find(few, method.name) != std::end(few)) return "";
  return search == Search::quick ? "--quick: few methods; name it by --method"
                                 : "large sheet: few methods; name it by --method";
}

void add_ours(std::vector<Configuration>& all, const model::Scene& scene, Search search, const Methods& methods) {
  const int parts = finest_parts(search);
  for (const solver::Method* chosen : all_or(methods)) {
    const solver::Method& method = *chosen;
    const std::string name(method.name);
    if (!reason_to_leave_out(method, scene, search, !methods.empty()).empty()) continue;
    if (method.sub_steps) {
      all.push_back(by_fraction(spec_of(scene, name), tries_few(search) ? 3 : 10));
      continue;
    }
    all.push_back(by_steps(spec_of(scene, name), Code::drape, parts));
    all.push_back(by_tolerance(spec_of(scene, name)));
    if (search == Search::full && std::ranges::find(looped, name) != std::end(looped)) add_loose(all, scene, name, parts);
  }
  if (search != Search::full || !methods.empty()) return;
  for (const char* name : other_solvers) all.push_back(by_steps(spec_of(scene, name), Code::drape, parts));
}

std::vector<int> loop_digits(Search search) {
  if (tries_few(search)) return {3};
  return {2, 4};
}

/// The fixed-point loop with IC(0)   [Etzmuß 2002, 3.4].
void add_thesis(std::vector<Configuration>& all, const model::Scene& scene, Search search, const Methods& methods) {
  for (const char* method : looped) {
    if (!methods.empty() && std::ranges::find(methods, method, &solver::Method::name) == methods.end()) continue;
    for (const int digits : loop_digits(search)) {
      solver::Options options = solver::thesis_options();
      options.loop_tolerance = std::pow(10.0, -digits);
      Configuration configuration =
          by_steps(spec_of(scene, fmt::format("{}/fixed-point/ic0", method), options), Code::thesis, finest_parts(search));
      configuration.name += fmt::format(" to {:.0e}", options.loop_tolerance);
      all.push_back(std::move(configuration));
    }
  }
}

}  // namespace

std::vector<double> tolerances(int finest) {
  std::vector<double> all;
  for (int k = 2; k <= 2 * finest; ++k) all.push_back(std::pow(10.0, -0.5 * k));
  return all;
}

int finest_parts(Search search) { return tries_few(search) ? 16 : 512; }

std::vector<double> divided_steps(double end, int parts) {
  std::vector<double> steps{end / 5};
  for (int k = 0, last = 0;; ++k) {
    const int m = static_cast<int>(std::lround(std::pow(2.0, 0.5 * k)));
    if (m > parts) return steps;
    if (m != last) steps.push_back(end / 10 / m);
    last = m;
  }
}

Configuration ladder(const model::Scene& scene, const std::string& method) {
  const RunSpec chosen = spec_of(scene, method);
  return chosen.method->sub_steps ? by_fraction(chosen, 10) : by_steps(chosen, Code::drape, finest_parts(Search::usual));
}

Configuration automatic(const model::Scene& scene, double accuracy) {
  const auto chosen = [scene, accuracy] {
    RunSpec spec{scene, "", nullptr, 0, {}};
    choose_automatically(spec, accuracy);
    return spec;
  };
  const RunSpec spec = chosen();
  Configuration one{fmt::format("{} for {:g}", spec.method_name(), accuracy), Code::drape, Control::step, nullptr};
  one.variants = {ours(spec, spec.step)};
  one.variants.front().solve = [chosen](const model::Cloth& cloth, std::span<const double> times, const Limits& limits) {
    return solve_ours(chosen(), cloth, times, limits);
  };
  return one;
}

std::vector<LeftOut> left_out(const model::Scene& scene, Search search, const Methods& methods) {
  std::vector<LeftOut> all;
  for (const solver::Method* method : all_or(methods))
    if (std::string reason = reason_to_leave_out(*method, scene, search, !methods.empty()); !reason.empty())
      all.push_back({method, std::move(reason)});
  return all;
}

std::vector<Configuration> configurations(const model::Scene& scene, Search search, const Methods& methods) {
  std::vector<Configuration> all;
  add_ours(all, scene, search, methods);
  add_thesis(all, scene, search, methods);
  if (!model::has_contacts(scene) && search != Search::large) add_peers(all, scene, search);  // they have no contacts
  for (Configuration& one : all) one.advised = one.name == advised_ours || one.name == advised_peer();
  return all;
}

}  // namespace drape::bench
