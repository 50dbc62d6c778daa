#include <cmath>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/record.hpp"
#include "bench/studies/claims/claim.hpp"
#include "bench/studies/refinement.hpp"
#include "solver/base/statistics.hpp"

/// Claims about orders in time, on the smooth sheet of the study `orders`.
namespace drape::bench {
namespace {

/// An order of convergence, and by what it varies between the refinements.
struct MeasuredOrder {
  double order, spread;
};

MeasuredOrder measured_order(const char* method, const model::Scene& scene = smooth_scene(), int passes = 0) {
  const model::Cloth cloth = model::compile(scene);
  References references(1e-7, {}, 1e-12);
  const reference::Reference reference = references(scene, cloth);
  std::vector<double> steps, errors;
  for (const int n : {96, 192, 384, 768}) {
    RunSpec spec = tight(scene, method);
    spec.step = scene.end / n;
    if (passes > 0) {
      spec.options.stage = &solver::stage_kind("fixed-point");
      spec.options.passes = passes;
    }
    const results::RunRecord run = record(spec);
    if (!run.succeeded()) return {NAN, NAN};
    steps.push_back(spec.step);
    errors.push_back(distance(run, reference, scene, cloth).rms);
  }
  MeasuredOrder found{base::exponent(steps, errors), 0};
  for (std::size_t k = 1; k < steps.size(); ++k)
    found.spread =
        std::max(found.spread, std::abs(base::exponent(steps[k - 1], errors[k - 1], steps[k], errors[k]) - found.order));
  return found;
}

/// log h_Euler grows with log h_2 by the ratio of the orders, where both make the same error.
std::vector<ClaimCase> euler_needs_squared_steps() {
  const MeasuredOrder euler = measured_order("implicit-euler");
  std::vector<ClaimCase> cases;
  for (const char* method : {"bdf2", "midpoint"}) {
    const MeasuredOrder second = measured_order(method);
    const double ratio = second.order / euler.order;
    cases.push_back({method, ratio, ratio * (second.spread / second.order + euler.spread / euler.order), 1.9, 2.1});
  }
  return cases;
}

std::vector<ClaimCase> order_two(const char* method) {
  const MeasuredOrder found = measured_order(method);
  return {{"h k/d < 0.1 on a soft sheet", found.order, found.spread, 1.9, 2.1}};
}

/// f_expl depends on velocities only in the air, whose drag is nonlinear.
std::vector<ClaimCase> one_pass_is_of_order_one() {
  model::Scene in_air = smooth_scene();
  in_air.sheet.air = 10;
  const MeasuredOrder without = measured_order("bdf2", smooth_scene(), 1), with = measured_order("bdf2", in_air, 1);
  return {{"explicit forces of positions only", without.order, without.spread, 0.9, 1.1},
          {"also explicit forces of velocities", with.order, with.spread, 0.9, 1.1}};
}

std::vector<ClaimCase> any_matrix_will_do() { return order_two("ros2-w"); }
std::vector<ClaimCase> one_newton_step_suffices() { return order_two("one-newton-bdf2"); }

constexpr Claim of_orders[] = {
    {"C-09", "Etzmuß 2002", "3.4.1", "implicit Euler needs steps of h² where a method of order 2 takes h",
     "exponent of Euler's step over the other's at equal errors", "1", euler_needs_squared_steps, "bench/run study orders"},
    {"C-05", "Etzmuß 2002", "3.4.3", "one pass of the loop is only of order one", "order of BDF(2)", "1",
     one_pass_is_of_order_one},
    {"F-02", "Choi, Ko 2002", "", "one Newton step a time step keeps the order of BDF(2)", "order", "1",
     one_newton_step_suffices, "bench/run study orders --method one-newton-bdf2"},
    {"F-03", "Verwer, Spee, Blom, Hundsdorfer 1999", "", "a W-method keeps order 2 with any matrix", "order", "1",
     any_matrix_will_do, "bench/run study orders --method ros2-w"},
};

}  // namespace

std::span<const Claim> order_claims() { return of_orders; }

}  // namespace drape::bench
