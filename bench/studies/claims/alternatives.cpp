#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bench/runs/record.hpp"
#include "bench/studies/claims/claim.hpp"
#include "bench/studies/claims/sheet_runs.hpp"
#include "model/cloth.hpp"
#include "reference/distance.hpp"
#include "solver/integrator.hpp"

/// Claims about methods and stage solvers other than those of the thesis.
namespace drape::bench {
namespace {

using results::RunRecord;

/// A sheet that falls without being stretched, so that nothing but gravity moves it.
std::vector<ClaimCase> kang_is_far_from_the_solution() {
  std::vector<ClaimCase> cases;
  for (const char* damping : {"50", "5"}) {
    model::Scene scene = with("hung-edge", {{"material.damping", damping}, {"end.time", "0.1"}});
    scene.pins.clear();
    const auto fallen = [&](const char* method) { return run_by(scene, method).final_state.v.colwise().mean().norm(); };
    cases.push_back({fmt::format("d = {}", damping), fallen("kang/1") / fallen("imex-euler"), 0, 0, 0.5});
  }
  return cases;
}

/// What a step makes of a sheet that is stretched by a half, with strain limits that go over the springs in a random order.
solver::Vectors limited_in_order(const model::Cloth& cloth, unsigned order, int sweeps) {
  std::vector<solver::CompliantConstraint> springs = cloth.ode.compliant_constraints();
  std::shuffle(springs.begin(), springs.end(), std::mt19937(order));
  solver::SplitOde ode = cloth.ode;
  ode.compliant_constraints = [&springs] { return springs; };
  solver::Options options;
  options.sweeps = sweeps;
  solver::State start = cloth.start;
  start.x *= 1.5;
  solver::Integrator integrator(ode, solver::method("strain-limited"), options, start);
  if (integrator.step(1e-3).outcome != solver::Outcome::success) return solver::Vectors::Constant(start.x.rows(), 3, NAN);
  return integrator.state().x;
}

std::vector<ClaimCase> strain_limits_depend_on_the_order() {
  constexpr int orders = 10;
  constexpr double visible = 1e-3;  // part of the size
  const model::Scene scene = hung(50);
  const model::Cloth cloth = model::compile(scene);
  std::vector<ClaimCase> cases;
  for (const int sweeps : {1, 10, 100}) {
    std::vector<solver::Vectors> all;
    solver::Vectors mean = solver::Vectors::Zero(cloth.start.x.rows(), 3);
    for (unsigned order = 0; order < orders; ++order) mean += all.emplace_back(limited_in_order(cloth, order, sweeps)) / orders;
    double sum = 0;
    for (const solver::Vectors& x : all) sum += (x - mean).squaredNorm() / (orders - 1);
    const double spread = std::sqrt(sum / static_cast<double>(mean.rows())) / model::size(scene);
    const double uncertainty = spread / std::sqrt(2.0 * (orders - 1));  // of the standard deviation of a sample
    cases.push_back({fmt::format("sweeps: {}", sweeps), spread, uncertainty, visible, unbounded});
  }
  return cases;
}

/// Steps of the exponential method of fourth order over the sub-steps that velocity Verlet needs.
std::vector<ClaimCase> exponential_steps_are_long() {
  constexpr double visible = 1e-2;  // part of the size
  std::vector<ClaimCase> cases;
  for (const double d : {50.0, 5.0, 0.5, 0.0}) {
    const model::Scene scene = hung(d);
    const double substep = scene.end / work_of(run_by(scene, "verlet"), "substeps");
    const double step = largest_accurate_step(scene, "epirk4s3a", fine_motion(scene).motion.states.back().x, visible);
    cases.push_back({fmt::format("d = {:g}", d), step / substep, 0, 1000, unbounded});
  }
  return cases;
}

/// A small sheet hung by its edge, and steps with which XPBD of few iterations does not gain energy.
model::Scene sheet_of_xpbd() { return with("peer-edge", {{"grid.n", "10"}, {"end.time", "0.1"}}); }
constexpr double step_of_xpbd = 2.5e-3;  ///< [s]

std::vector<ClaimCase> small_steps_beat_iterations() {
  const model::Scene scene = sheet_of_xpbd();
  const FineMotion fine = fine_motion(scene);
  std::vector<ClaimCase> cases;
  for (const int n : {4, 20, 100}) {
    const auto error = [&](const std::string& method) {
      return distance_at_end(scene, run_by(scene, method, step_of_xpbd), fine.motion.states.back().x);
    };
    const double small = error(fmt::format("xpbd/{}x1", n)), many = error(fmt::format("xpbd/1x{}", n));
    const double doubt = fine.uncertainty / model::size(scene) * (1 / small + 1 / many);
    cases.push_back({fmt::format("n = {}", n), small / many, small / many * doubt, 0, 0.999});
  }
  return cases;
}

std::vector<ClaimCase> xpbd_does_not_know_iterations() {
  constexpr double visible = 1e-2;  // part of the size
  model::Scene scene = sheet_of_xpbd();
  scene.end = 0.4;
  std::vector<ClaimCase> cases;
  for (const int n : {1, 2, 5, 10, 20}) {
    const auto end = [&](int iterations) { return run_by(scene, fmt::format("xpbd/1x{}", iterations), step_of_xpbd); };
    cases.push_back({fmt::format("{} and {} iterations", n, 2 * n), distance_at_end(scene, end(n), end(2 * n).final_state.x), 0,
                     0, visible});
  }
  return cases;
}

/// Updates of implicit Euler by a stage solver; NaN if it fails.
double updates_by(const char* stage, const model::Scene& scene, solver::Options options) {
  options.stage = &solver::stage_kind(stage);
  return work_of(record({scene, "", &solver::method("implicit-euler"), thesis_step, options}), "updates");
}

std::vector<ClaimCase> chebyshev_saves_an_order_of_magnitude() {
  std::vector<ClaimCase> cases;
  for (const double d : {50.0, 5.0, 0.5}) {
    const model::Scene scene = hung(d, 0.1);
    double best = unbounded;
    solver::Options options = solver::thesis_options();
    for (const double radius : {0.8, 0.9, 0.97, 0.99, 0.997}) {
      options.chebyshev_radius = radius;
      best = std::min(best, updates_by("chebyshev", scene, options));  // which is no NaN
    }
    cases.push_back({fmt::format("d = {:g}", d), best / updates_by("fixed-point", scene, options), 0, 0, 0.1});
  }
  return cases;
}

/// Exponent of the error over the length of the sub-step.
std::vector<ClaimCase> small_steps_are_of_order_one() {
  const model::Scene scene = sheet_of_xpbd();
  const FineMotion fine = fine_motion(scene);
  const auto error = [&](int n) {
    return distance_at_end(scene, run_by(scene, fmt::format("xpbd/{}x1", n), step_of_xpbd), fine.motion.states.back().x);
  };
  std::vector<ClaimCase> cases;
  for (const int n : {5, 10}) {  // beyond, the reference is not much better
    const double coarse = error(n), half = error(2 * n);
    const double doubt = fine.uncertainty / model::size(scene) * (1 / coarse + 1 / half) / std::log(2);
    cases.push_back({fmt::format("{} and {} sub-steps", n, 2 * n), std::log2(coarse / half), doubt, 0.9, 1.1});
  }
  return cases;
}

/// Sweeps of vertex block descent over passes of the loop, whose global steps are those of projective dynamics.
std::vector<ClaimCase> vertices_converge_faster() {
  solver::Options options = solver::thesis_options();
  options.max_updates = 20'000;
  std::vector<ClaimCase> cases;
  for (const double d : {50.0, 5.0, 0.5})
    for (const double tolerance : {1e-1, 1e-2}) {
      const model::Scene scene = hung(d, 0.2);
      options.loop_tolerance = tolerance;
      cases.push_back({fmt::format("d = {:g}, to {:g} of |b|", d, tolerance),
                       updates_by("vbd", scene, options) / updates_by("fixed-point", scene, options), 0, 0, 0.999});
    }
  return cases;
}

/// A free sheet without weight and damping that turns about a slanted axis.
std::vector<ClaimCase> desbrun_keeps_angular_momentum() {
  constexpr double round_off = 1e-10;
  model::Scene scene = with("hung-edge", {{"material.damping", "0"}, {"forces.gravity", "[0, 0, 0]"}});
  scene.pins.clear();
  const model::Cloth cloth = model::compile(scene);
  solver::State start = cloth.start;
  const Eigen::RowVector3d omega(1, 2, 5);
  for (int i = 0; i < cloth.ode.particles(); ++i) start.v.row(i) = omega.cross(start.x.row(i));
  const auto momentum = [&](const solver::State& y) {
    return reference::angular_momentum(cloth.ode.mass, Eigen::RowVector3d::Zero(), y);
  };
  const Eigen::Vector3d before = momentum(start);
  std::vector<ClaimCase> cases;
  for (const double h : {0.01, 0.001}) {
    solver::Integrator integrator(cloth.ode, solver::method("desbrun"), {}, start);
    solver::Outcome outcome = solver::Outcome::success;
    for (int k = 0; k < 10 && outcome == solver::Outcome::success; ++k) outcome = integrator.step(h).outcome;
    const double lost = (momentum(integrator.state()) - before).norm() / before.norm();
    cases.push_back({fmt::format("h = {:g} s", h), outcome == solver::Outcome::success ? lost : NAN, 0, 0, round_off});
  }
  return cases;
}

/// Largest strain of a spring.
double largest_strain(const model::Cloth& cloth, const solver::Vectors& x) {
  double strain = 0;
  for (const solver::CompliantConstraint& spring : cloth.ode.compliant_constraints())
    if (spring.kind == solver::CompliantConstraint::Kind::distance) {
      const auto [i, j, unused] = spring.particles;
      strain = std::max(strain, (x.row(j) - x.row(i)).norm() / spring.rest - 1);
    }
  return strain;
}

/// Cloth is so soft that without a limit its springs get longer by more than a tenth, which the first case makes sure of.
std::vector<ClaimCase> strain_stays_limited() {
  constexpr double limit = 0.1, slack = 1e-3, step = 1e-3;
  const model::Scene scene = with("hung-corners", {{"material.tension", "100"}, {"end.time", "0.5"}});
  const model::Cloth cloth = model::compile(scene);
  const auto strain_by = [&](const std::string& method) {
    const RunRecord run = run_by(scene, method, step);
    return run.succeeded() ? largest_strain(cloth, run.final_state.x) : NAN;
  };
  std::vector<ClaimCase> cases{{"no limit", strain_by("implicit-euler"), 0, 1.5 * limit, unbounded}};
  for (const int sweeps : {1, 10, 100})
    cases.push_back(
        {fmt::format("sweeps: {}", sweeps), strain_by(fmt::format("strain-limited/{}", sweeps)), 0, 0, limit + slack});
  return cases;
}

std::vector<ClaimCase> one_newton_step_does_not_gain_energy() {
  constexpr double small = 1e-2;  // [J], of some 3 J that gravity gives
  std::vector<ClaimCase> cases;
  for (const double d : {50.0, 5.0, 0.5, 0.0})
    cases.push_back({fmt::format("d = {:g}", d), energy_gain(hung(d), "one-newton-bdf2", thesis_step), 0, -unbounded, small});
  return cases;
}

std::vector<ClaimCase> energy_momentum_keeps_the_energy() {
  constexpr double small = 1e-8;  // [J], of some 3 J that gravity gives
  std::vector<ClaimCase> cases;
  for (const double h : {0.01, 0.005}) {
    const model::Scene scene = with("hung-edge", {{"material.damping", "0"}, {"end.time", "0.4"}});
    cases.push_back({fmt::format("h = {:g} s", h), energy_gain(scene, "energy-momentum", h), 0, -small, small});
  }
  return cases;
}

constexpr Claim of_alternatives[] = {
    {"C-15", "Etzmuß 2002", "3.2", "the approximate solve of Kang and others is not near the solution",
     "speed of a falling sheet over that of IMEX Euler, which solves the same system", "1", kang_is_far_from_the_solution},
    {"C-17", "Etzmuß 2002", "3.2", "what strain limiting gives depends on the order of the springs",
     "standard deviation over ten orders, over the size", "1", strain_limits_depend_on_the_order},
    {"F-10", "Macklin and others 2019", "", "n sub-steps of XPBD are more accurate than n iterations",
     "error over that with as many iterations", "1", small_steps_beat_iterations},
    {"F-11", "Macklin, Müller, Chentanez 2016", "", "the stiffness of XPBD does not depend on the number of iterations",
     "distance of the ends over the size", "1", xpbd_does_not_know_iterations},
    {"F-12", "Wang 2015", "", "Chebyshev's acceleration saves an order of magnitude of iterations",
     "updates over those of the loop, with the best of five radii", "1", chebyshev_saves_an_order_of_magnitude},
    {"F-13", "Simo, Tarnow 1992", "", "the energy-momentum method does not gain energy", "rise of the energy, no damping", "J",
     energy_momentum_keeps_the_energy},
    {"F-14", "Macklin and others 2019", "", "the error of small steps falls like 1/n", "order in the length of the sub-step",
     "1", small_steps_are_of_order_one},
    {"F-15", "Chen and others 2024", "", "vertex block descent has a superior rate of convergence",
     "sweeps over the passes of projective dynamics", "1", vertices_converge_faster, "bench/run study stages"},
    {"F-16", "Michels, Sobottka, Weber 2014", "", "exponential steps are longer by up to three orders of magnitude",
     "steps of epirk4s3a that end within 1e-2 of the size, over sub-steps of Verlet", "1", exponential_steps_are_long},
    {"F-18", "Desbrun, Schröder, Barr 1999", "", "the correction keeps the angular momentum", "part of it that is lost", "1",
     desbrun_keeps_angular_momentum},
    {"F-19", "Provot 1995", "", "no spring stays longer than by a tenth", "largest strain", "1", strain_stays_limited},
    {"F-20", "Choi, Ko 2002", "", "BDF(2) with one Newton step is stable", "rise of the energy, h = 0.01 s", "J",
     one_newton_step_does_not_gain_energy, "bench/run study stability --method one-newton-bdf2"},
};

}  // namespace

std::span<const Claim> alternative_claims() { return of_alternatives; }

}  // namespace drape::bench
