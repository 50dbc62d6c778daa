#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "bench/runs/lag.hpp"
#include "bench/runs/record.hpp"
#include "bench/studies/claims/claim.hpp"
#include "bench/studies/claims/sheet_runs.hpp"
#include "bench/studies/draping.hpp"
#include "bench/studies/step_means.hpp"
#include "reference/distance.hpp"

/// Claims about sheets in motion: work, lag, error and energy of runs.
namespace drape::bench {
namespace {

using results::RunRecord;

/// The tablecloth with k and d of table 3.2.
model::Scene thesis_tablecloth() { return with("tablecloth", {{"material.tension", "1e4"}, {"material.damping", "50"}}); }

/// By the loop of the thesis with IC(0) and its usual tolerances.
RunRecord run_as_in_thesis(const model::Scene& scene, std::string_view method, double loop_tolerance = 1e-5) {
  RunSpec spec{scene, "", &solver::method(method), thesis_step, solver::thesis_options()};
  spec.options.loop_tolerance = loop_tolerance;
  return record(spec);
}

double work_ratio(const model::Scene& scene, const char* method, const char* other, const char* kind) {
  return work_of(run_as_in_thesis(scene, method), kind) / work_of(run_as_in_thesis(scene, other), kind);
}

// --- Work --------------------------------------------------------------------------------------------------------------------

std::vector<ClaimCase> work_grows_with_stiffness() {
  const auto per_step = [](const model::Scene& scene, double h) {
    RunSpec spec{scene, "", &solver::method("bdf2"), h, solver::thesis_options()};
    const RunRecord run = record(spec);
    return work_of(run, "cg_iterations") / static_cast<double>(run.steps.size());
  };
  const double usual = per_step(hung(50), thesis_step);
  std::vector<ClaimCase> cases;
  const auto add = [&](const char* where, std::vector<model::Override> overrides, double h) {
    overrides.push_back({"end.time", "0.4"});
    cases.push_back({where, per_step(with("hung-corners", std::move(overrides)), h) / usual, 0, 1.001, unbounded});
  };
  add("twice h", {}, 2 * thesis_step);
  add("half l", {{"grid.size", "0.4"}}, thesis_step);
  add("half ρ", {{"material.density", "0.5"}}, thesis_step);
  add("twice k", {{"material.tension", "2e4"}}, thesis_step);
  return cases;
}

std::vector<ClaimCase> loop_always_converges() {
  std::vector<ClaimCase> cases;
  for (const auto& [k, d] : {std::pair{1e4, 50.0}, std::pair{1e4, 0.5}, std::pair{1e6, 0.5}, std::pair{1e6, 0.005}}) {
    const model::Scene scene = with("hung-corners", {{"grid.n", "10"},
                                                     {"material.tension", fmt::format("{}", k)},
                                                     {"material.damping", fmt::format("{}", d)},
                                                     {"end.time", "0.1"}});
    const RunRecord run = run_as_in_thesis(scene, "implicit-euler");
    cases.push_back({fmt::format("h k/d = {:g}", thesis_step * k / d), run.last_good_time / scene.end, 0, 0.999, 1.001});
  }
  return cases;
}

std::vector<ClaimCase> bdf2_takes_less_than_euler() {
  const model::Scene wind = with("wind", {{"end.time", "0.5"}});
  std::vector<ClaimCase> cases;
  for (const char* kind : {"updates", "cg_iterations"})
    cases.push_back({kind, work_ratio(wind, "bdf2", "implicit-euler", kind), 0, 0, 0.999});
  return cases;
}

std::vector<ClaimCase> midpoint_converges_more_slowly() {
  std::vector<ClaimCase> cases;
  const auto add = [&](const char* where, const model::Scene& scene) {
    cases.push_back({where, work_ratio(scene, "midpoint", "bdf2", "updates"), 0, 1.001, unbounded});
  };
  add("hung by corners, d = 50", hung(50));
  add("hung by corners, d = 0.5", hung(0.5));
  add("tablecloth, d = 50", thesis_tablecloth());
  return cases;
}

/// A run beside what the thesis prints of its work.
struct PrintedRun {
  PublishedWork printed;
  RunRecord run;
};

/// Part of the pairs whose work is in the printed order less that of the others: Kendall's τ.
ClaimCase order_case(const char* where, const std::vector<PrintedRun>& runs, const char* kind,
                     std::int64_t PublishedWork::*printed) {
  double sum = 0, pairs = 0;
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (std::size_t j = 0; j < i; ++j, ++pairs) {
      const auto as_printed = static_cast<double>(runs[i].printed.*printed - runs[j].printed.*printed);
      sum += as_printed * (work_of(runs[i].run, kind) - work_of(runs[j].run, kind)) > 0 ? 1 : -1;
    }
  return {where, sum / pairs, 0, 0.999, 1.001};
}

std::vector<ClaimCase> orders_of_table_3_2() {
  std::vector<PrintedRun> all, nonlinear;  // the others take one update a step
  for (const auto& [method, printed] : published_table_3_2) {
    all.push_back({printed.work, run_as_in_thesis(thesis_tablecloth(), method)});
    if (solver::method(method).nonlinear()) nonlinear.push_back(all.back());
  }
  return {order_case("updates of the implicit methods", nonlinear, "updates", &PublishedWork::updates),
          order_case("CG iterations of all", all, "cg_iterations", &PublishedWork::cg_iterations)};
}

/// BDF(2); the larger k is taken for 10⁵.
std::vector<ClaimCase> order_of_table_3_1() {
  constexpr std::array k{"1e3", "1e5"}, d{"160", "1600"};
  std::vector<PrintedRun> runs;
  for (const std::size_t i : {0, 1})
    for (const std::size_t j : {0, 1})
      runs.push_back({*published_table_3_1[i][j],
                      run_as_in_thesis(with("tablecloth", {{"material.tension", k[i]}, {"material.damping", d[j]}}), "bdf2")});
  return {order_case("updates", runs, "updates", &PublishedWork::updates),
          order_case("CG iterations", runs, "cg_iterations", &PublishedWork::cg_iterations)};
}

/// A sheet swings against a box and comes to rest on it.
std::vector<ClaimCase> resting_costs_little() {
  std::vector<ClaimCase> cases;
  for (const char* method : {"sbdf2", "bdf2", "midpoint"})
    cases.push_back(
        {method, iterations_at_rest(run_as_in_thesis(with("box_swing", {}), method)), 0, 0, most_iterations_at_rest});
  return cases;
}

/// A sheet that swings until shortly after it has met a box, or would have.
std::vector<ClaimCase> contact_limits_the_step() {
  constexpr double visible = 1e-2;  // part of the size
  const model::Scene meets = with("box_swing", {{"end.time", "1"}});
  model::Scene swings = meets;
  swings.obstacles.clear();
  const FineMotion met = fine_motion(meets), swung = fine_motion(swings);
  std::vector<ClaimCase> cases;
  for (const char* method : {"implicit-euler", "bdf2", "midpoint"}) {
    const double with_box = largest_accurate_step(meets, method, met.motion.states.back().x, visible);
    const double without = largest_accurate_step(swings, method, swung.motion.states.back().x, visible);
    cases.push_back({method, with_box / without, 0, 0, 0.999});
  }
  return cases;
}

/// Passes of BDF(2)'s loop with 2 to 4 of them a step, over those with constant steps of the first length.
std::vector<ClaimCase> control_keeps_the_loop_effective() {
  std::vector<ClaimCase> cases;
  for (const double d : {50.0, 5.0, 0.5}) {
    RunSpec spec{hung(d), "", &solver::method("bdf2"), thesis_step, solver::thesis_options()};
    spec.options.max_updates = 20'000;
    const double constant = work_of(record(spec), "updates");
    spec.options.control = {.min_updates = 2, .max_updates = 4, .factor = 1.5};
    cases.push_back({fmt::format("d = {:g}", d), work_of(record(spec), "updates") / constant, 0, 0, 0.999});
  }
  return cases;
}

std::vector<ClaimCase> second_order_takes_less_work() {
  return {{"SBDF(2) over IMEX Euler", work_ratio(thesis_tablecloth(), "sbdf2", "imex-euler", "cg_iterations"), 0, 0, 0.999},
          {"BDF(2) over Euler", work_ratio(thesis_tablecloth(), "bdf2", "implicit-euler", "cg_iterations"), 0, 0, 0.999}};
}

std::vector<ClaimCase> ten_local_global_iterations() {
  constexpr double loose = 1e-2;
  std::vector<ClaimCase> cases;
  for (const double d : {50.0, 5.0, 0.5}) {
    const RunRecord run = run_as_in_thesis(hung(d), "implicit-euler", loose);
    cases.push_back({fmt::format("d = {:g}", d), work_of(run, "updates") / static_cast<double>(run.steps.size()), 0, 0, 10});
  }
  return cases;
}

std::vector<ClaimCase> implicit_damping_saves_substeps() {
  std::vector<ClaimCase> cases;
  for (const double d : {50.0, 5.0, 0.5}) {
    const model::Scene scene = hung(d, 0.05);
    cases.push_back({fmt::format("d = {:g}", d),
                     work_of(run_by(scene, "bridson"), "substeps") / work_of(run_by(scene, "verlet"), "substeps"), 0, 0, 0.9});
  }
  return cases;
}

// --- Motion ------------------------------------------------------------------------------------------------------------------

ClaimCase lag_case(const std::string& where, const model::Scene& scene, const FineMotion& fine, const std::string& method,
                   double lower, double upper) {
  std::vector<double> times;
  for (int k = 1; k <= 10; ++k) times.push_back(scene.end * k / 10);
  const auto states = states_by(scene, method, thesis_step, times);
  if (states.size() < times.size()) return {where, NAN, NAN, lower, upper};
  const Delay late = delay(times, states, fine.motion);
  const bool at_end_of_scan = std::abs(late.seconds) >= 0.999 * longest_lag * scene.end;
  return {where + (at_end_of_scan ? " (at least)" : ""), late.seconds, fine.uncertainty / late.speed, lower, upper};
}

constexpr double visible_lag = 1e-3;  ///< [s]

std::vector<ClaimCase> lags_of(std::initializer_list<const char*> methods, double lower, double upper) {
  const model::Scene scene = hung(0.5);
  const FineMotion fine = fine_motion(scene);
  std::vector<ClaimCase> cases;
  for (const char* method : methods) cases.push_back(lag_case(method, scene, fine, method, lower, upper));
  return cases;
}

std::vector<ClaimCase> first_order_is_slow() {
  return lags_of({"imex-euler", "implicit-euler", "baraff-witkin"}, visible_lag, unbounded);
}

std::vector<ClaimCase> second_order_is_not() {
  return lags_of({"bdf2", "midpoint", "ros2", "sbdf2"}, -visible_lag, visible_lag);
}

std::vector<ClaimCase> one_newton_step_is_enough() {
  std::vector<ClaimCase> cases;
  for (const double d : {50.0, 5.0, 0.5}) {
    const model::Scene scene = hung(d);
    const FineMotion fine = fine_motion(scene);
    const solver::Vectors& truth = fine.motion.states.back().x;
    const double one = distance_at_end(scene, run_by(scene, "baraff-witkin"), truth);
    const double converged = distance_at_end(scene, run_by(scene, "implicit-euler"), truth);
    const double doubt = fine.uncertainty / model::size(scene) * (1 / one + 1 / converged);
    cases.push_back({fmt::format("d = {:g}", d), one / converged, one / converged * doubt, 0, 1.2});
  }
  return cases;
}

std::vector<ClaimCase> imex_looks_like_implicit() {
  constexpr double visible = 1e-2;  // part of the size
  std::vector<ClaimCase> cases;
  for (const double d : {500.0, 50.0, 5.0, 0.5}) {
    const model::Scene scene = hung(d);
    const RunRecord implicit = run_by(scene, "implicit-euler"), imex = run_by(scene, "imex-euler");
    cases.push_back({fmt::format("h k/d = {:g}", model::stiffness_to_damping(scene, thesis_step)),
                     distance_at_end(scene, imex, implicit.final_state.x), 0, 0, visible});
  }
  return cases;
}

/// IMEX methods on a sheet whose h k/d is large: the part of the run that the energy guard lets pass.
std::vector<ClaimCase> imex_is_stable_on_cloth() {
  std::vector<ClaimCase> cases;
  for (const char* method : {"imex-euler", "sbdf2", "imex-midpoint"}) {
    const model::Scene scene = hung(0.5);
    cases.push_back({method, run_by(scene, method).last_good_time / scene.end, 0, 0.999, 1.001});
  }
  return cases;
}

std::vector<ClaimCase> midpoint_does_not_gain_energy() {
  constexpr double small = 1e-2;  // [J], of some 3 J that gravity gives
  const model::Scene scene = with("hung-edge", {{"material.damping", "0"}, {"end.time", "0.4"}});
  std::vector<ClaimCase> cases;
  for (const double h : {0.01, 0.005, 0.001})
    cases.push_back({fmt::format("h = {:g} s", h), energy_gain(scene, "midpoint", h), 0, -small, small});
  return cases;
}

/// Rests of a sheet that hangs by an edge, d and 10 and 100 times that.
std::vector<ClaimCase> rest_does_not_know_damping() {
  const auto rest = [](const char* damping) {
    const model::Scene scene = with("tension", {{"material.damping", damping}, {"end.time", "100"}});
    return run_by(scene, "implicit-euler", 1).final_state.x;
  };
  const solver::Vectors usual = rest("20");
  std::vector<ClaimCase> cases;
  for (const char* damping : {"200", "2000"})
    cases.push_back(
        {fmt::format("d = {} against 20", damping), reference::rms_distance(rest(damping), usual), 1e-9, -unbounded, 1e-6});
  return cases;
}

constexpr const char* of_2002 = "Etzmuß 2002";

constexpr Claim of_sheets[] = {
    {"C-04", of_2002, "3.4.4", "work grows with h, 1/l, 1/ρ and k", "CG iterations a step over the usual, BDF(2), d = 50", "1",
     work_grows_with_stiffness},
    {"C-07b", of_2002, "3.3.3", "IMEX methods are stable on cloth: hung by corners, d = 0.5, h = 0.01 s",
     "part of the run that is stable", "1", imex_is_stable_on_cloth, "bench/run study stability"},
    {"C-08", of_2002, "3.4.3", "the fixed-point loop can always be used", "part of the run until it fails", "1",
     loop_always_converges, "bench/run study stability"},
    {"C-10", of_2002, "figure 3.2", "in the wind BDF(2) takes less work than Euler", "work over that of Euler", "1",
     bdf2_takes_less_than_euler, "bench/run study figure-3.2"},
    {"C-11c", of_2002, "3.4.1", "the equations of the midpoint rule converge more slowly", "updates over those of BDF(2)", "1",
     midpoint_converges_more_slowly},
    {"C-16", "Baraff, Witkin 1998", "", "one Newton step is enough", "error over that of converged Euler", "1",
     one_newton_step_is_enough},
    {"C-23", of_2002, "4.5", "resting contact needs hardly any additional work",
     "CG iterations a step at rest over those before contact", "1", resting_costs_little, "bench/run study figure-4.3"},
    {"C-24", of_2002, "2.8", "the rest does not depend on d", "distance of rests", "m", rest_does_not_know_damping},
    {"C-27", of_2002, "3.4.3", "control of the step by passes keeps the loop effective", "passes over those with h = 0.01 s",
     "1", control_keeps_the_loop_effective, "bench/run study step-control"},
    {"C-30", of_2002, "table 3.2", "the order of the methods' work on the tablecloth", "Kendall's τ of the order", "1",
     orders_of_table_3_2, "bench/run study table-3.2"},
    {"C-30b", of_2002, "table 3.1", "the order of the work on the tablecloth over k and d", "Kendall's τ of the order", "1",
     order_of_table_3_1, "bench/run study table-3.1"},
    {"C-31", of_2002, "3.4.4", "IMEX and implicit solutions can hardly be told apart", "distance of both Euler methods", "1",
     imex_looks_like_implicit},
    {"C-32", of_2002, "6.3", "the step is limited by contact, not by the method",
     "step that ends within 1e-2 of the size, over that without the box", "1", contact_limits_the_step},
    {"C-33", of_2002, "3.2", "methods of first order move too slowly", "lag, d = 0.5", "s", first_order_is_slow},
    {"C-33b", of_2002, "3.2", "methods of second order do not", "lag, d = 0.5", "s", second_order_is_not},
    {"E-28", of_2002, "3.4.4", "SBDF(2) and BDF(2) reduce the work", "CG iterations over those of the Euler method", "1",
     second_order_takes_less_work, "bench/run study table-3.2"},
    {"F-05", "Simo, Tarnow 1992", "", "the midpoint rule does not gain energy", "rise of the energy, no damping", "J",
     midpoint_does_not_gain_energy},
    {"F-07", "Bouaziz and others 2014", "", "ten local/global iterations are enough", "updates a step to 1e-2 of |b|", "1",
     ten_local_global_iterations},
    {"F-09", "Bridson, Marino, Fedkiw 2003", "", "implicit damping saves sub-steps", "sub-steps over those of Verlet", "1",
     implicit_damping_saves_substeps},
};

}  // namespace

std::span<const Claim> sheet_claims() { return of_sheets; }

}  // namespace drape::bench
