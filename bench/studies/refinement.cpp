#include "bench/studies/refinement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <utility>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/record.hpp"
#include "bench/runs/sweep_options.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/statistics.hpp"

namespace drape::bench {
namespace {

/// A run with what it took, and whether its error is lost in the reference's.
struct MeasuredStep {
  RefinedRun run;
  double work;
  bool unresolved;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MeasuredStep, run, work, unresolved)

/// Runs one method with ever smaller steps.
class Refinement {
 public:
  Refinement(const RunSpec& spec, const std::string& name, const model::Cloth& cloth, const reference::Reference& reference,
             Checkpoint& checkpoint)
      : spec_(spec), name_(name), cloth_(cloth), reference_(reference), checkpoint_(checkpoint) {}

  std::vector<RefinedRun> runs(double most_work) {
    constexpr std::int64_t coarsest = 5, most = std::int64_t(1) << 22;
    const auto first = static_cast<double>(spec_.method->sub_steps ? std::max(coarsest, substeps(coarsest)) : coarsest);
    std::vector<RefinedRun> all;
    for (int k = 0;; ++k) {
      const std::int64_t n = std::llround(first * std::pow(refinement(), k));
      if (n > most) break;
      const auto [run, work, unresolved] = checkpoint_.once(fmt::format("{} {}", name_, n), [&] { return refined(n); });
      add(all, run);
      if (unresolved || work > most_work) break;
    }
    return all;
  }

 private:
  /// Halved steps take errors of order 4 and 5 through all digits in a few refinements.
  double refinement() const { return spec_.method->order > 3 ? std::numbers::sqrt2 : 2; }

  results::RunRecord run_of(std::int64_t steps) const {
    RunSpec spec = spec_;
    spec.step = spec.scene.end / static_cast<double>(steps);
    return record(spec);
  }

  /// Some methods divide longer steps: their coarsest is the stability limit.
  std::int64_t substeps(std::int64_t n) const {
    return checkpoint_.once(fmt::format("{} substeps", name_), [&] { return results::work_count(run_of(n), "substeps"); });
  }

  /// Evaluations of forces, which every method needs, or steps, a particle each. Exact Jacobians and their products count in
  /// forces: a factored one takes longer than a hundred, but some steps must be left to measure an order with.
  static double work(const results::RunRecord& run) {
    constexpr std::int64_t forces_of_a_jacobian = 100, forces_of_a_product = 2;
    const auto count_of = [&](const char* name) { return results::work_count(run, name); };
    const std::int64_t count = std::max(count_of("forces") + count_of("explicit_forces"), count_of("steps")) +
                               forces_of_a_jacobian * count_of("jacobians") +
                               forces_of_a_product * count_of("jacobian_products");
    return static_cast<double>(count) * static_cast<double>(run.final_state.x.rows());
  }

  MeasuredStep refined(std::int64_t n) const {
    const results::RunRecord run = run_of(n);
    MeasuredStep measured{{spec_.scene.name, name_, run.step, run.outcome}, work(run), false};
    if (run.outcome == solver::Outcome::failed) measured.run.reason = run.message;
    if (!run.succeeded()) return measured;
    const results::ErrorRecord error = distance(run, reference_, spec_.scene, cloth_);
    measured.run.error = error.rms;
    measured.run.uncertainty = error.reference_error;
    measured.unresolved = !resolved(error);
    return measured;
  }

  /// With the order between this step and the last one that has an error.
  static void add(std::vector<RefinedRun>& runs, RefinedRun run) {
    const auto last = std::find_if(runs.rbegin(), runs.rend(), [](const RefinedRun& other) { return other.error.has_value(); });
    if (run.error && last != runs.rend()) run.order = std::log(*last->error / *run.error) / std::log(last->step / run.step);
    runs.push_back(std::move(run));
  }

  const RunSpec& spec_;
  const std::string& name_;
  const model::Cloth& cloth_;
  const reference::Reference& reference_;
  Checkpoint& checkpoint_;
};

constexpr results::ColumnOf<RefinedRun> refined_columns[] = {
    {"scene", "scene", "", "its name", results::Role::key, results::field<&RefinedRun::scene>},
    {"method", "method", "", "time integrator", results::Role::key, results::field<&RefinedRun::method>},
    {"step", "h", "s", "time step", results::Role::key, results::field<&RefinedRun::step>},
    {"error", "rms error", "1", "distance from the reference at the end, over the size of the scene", results::Role::error,
     results::field<&RefinedRun::error>},
    {"uncertainty", "", "1", "of the reference", results::Role::uncertainty, results::field<&RefinedRun::uncertainty>},
    {"order", "order", "1", "between this step and the one before", results::Role::note, results::field<&RefinedRun::order>},
    {"outcome", "outcome", "", "how the run failed", results::Role::note,
     [](const RefinedRun& run) {
       return run.outcome == solver::Outcome::success ? results::Datum() : results::to_datum(run.outcome);
     }},
    {"reason", "reason", "", "what was thrown", results::Role::note, results::field<&RefinedRun::reason>},
};

/// The curves of all methods on a scene.
struct OrdersOnScene {
  std::string families;  ///< behind the reference
  std::vector<RefinedRun> runs;
};

bool has_kinks(const model::Cloth& cloth) {
  std::vector<int> branches;
  if (cloth.ode.memory) cloth.ode.memory->branches(cloth.start, branches);
  return !branches.empty();
}

OrdersOnScene compute_orders(const model::Scene& scene, double most_work, const std::vector<const solver::Method*>& methods,
                             Checkpoint& checkpoint) {
  const model::Cloth cloth = model::compile(scene);
  checkpoint.show("reference of " + scene.name);
  const auto say = [&](const std::string& pace) { checkpoint.report("reference of " + scene.name + ": " + pace); };
  References references(SweepOptions().agreement, {.say = say}, 1e-12);  // the more of a curve is resolved
  const reference::Reference reference = references(scene, cloth);
  checkpoint.advance();
  const bool kinks = has_kinks(cloth);
  std::vector<RefinedRun> runs;
  checkpoint.each(methods, [&](const solver::Method* method) {
    if (method->needs_energies && !cloth.plan.without_energy.empty()) return;
    checkpoint.show(fmt::format("{} on {}", method->name, scene.name));
    const std::string name(method->name);
    const bool ends_at_kinks = kinks && method->order > 2;  // a few kinks cost a lower order nothing
    for (const bool events : {false, true}) {
      if (events && !ends_at_kinks) continue;
      constexpr double more_work = 16;  // a sheet has kinks by the hundred, and a step ends at each
      RunSpec spec = tight(scene, *method);
      spec.options.ends_at_kinks = events;
      auto curve =
          refine(spec, events ? name + ", events" : name, cloth, reference, (events ? more_work : 1) * most_work, checkpoint);
      fit_curve(curve, method->order);
      std::ranges::move(curve, std::back_inserter(runs));
    }
    checkpoint.advance();
  });
  return {fmt::format("{} + {}", reference.name, reference.witness), std::move(runs)};
}

}  // namespace

model::Scene smooth_scene() {
  return model::load_scene("hung-corners", std::vector<model::Override>{{"name", "soft"},
                                                                        {"grid.n", "5"},
                                                                        {"material.tension", "20"},
                                                                        {"material.damping", "2"},
                                                                        {"material.shear", "0.2"},
                                                                        {"end.time", "0.6"}});
}

RunSpec tight(const model::Scene& scene, const solver::Method& method) {
  RunSpec spec{scene, "", &method, scene.end, solver::thesis_options()};
  spec.options.loop_tolerance = 1e-11;
  spec.options.cg_tolerance = 1e-12;
  spec.options.stage_accuracy = 1e-4;
  spec.options.linear_solver = &solver::linear_solver("cholesky");
  return spec;
}

RunSpec tight(const model::Scene& scene, const std::string& name) {
  RunSpec spec = tight(scene, solver::methods().front());
  choose_method(spec, name);
  return spec;
}

std::vector<RefinedRun> refine(const RunSpec& spec, const std::string& name, const model::Cloth& cloth,
                               const reference::Reference& reference, double most_work, Checkpoint& checkpoint) {
  return Refinement(spec, name, cloth, reference, checkpoint).runs(most_work);
}

void fit_curve(std::vector<RefinedRun>& runs, int declared_order) {
  std::vector<double> steps, errors;
  double uncertainty = 0;
  for (const RefinedRun& run : runs)
    if (run.error) {
      steps.push_back(run.step);
      errors.push_back(*run.error);
      uncertainty = *run.uncertainty;
    }
  const auto fit = results::fit_order(steps, errors, uncertainty);
  runs.front().curve = {fit, results::order_verdict(fit, declared_order)};
}

results::Table refinement_table(std::string name, std::string description, const std::vector<RefinedRun>& runs) {
  results::Table table = results::make_table(std::move(name), std::move(description), refined_columns, runs);
  results::add_columns(table, results::fit_columns, runs, std::mem_fn(&RefinedRun::curve));
  using results::Part;
  draw(table, results::Figure::convergence,
       {{Part::figure, "scene"}, {Part::curve, "method"}, {Part::x, "step"}, {Part::y, "error"}, {Part::detail, "order"}});
  return table;
}

Job orders_on(const model::Scene& scene, double most_work, const std::vector<const solver::Method*>& methods) {
  const std::string name = "orders-" + scene.name;
  const auto compute = [=](Checkpoint& checkpoint) { return compute_orders(scene, most_work, methods, checkpoint); };
  const auto present = [=](const OrdersOnScene& orders) {
    return refinement_table(
        name, fmt::format("Order in time on {}, {:g} s; reference {}", scene.name, scene.end, orders.families), orders.runs);
  };
  return job(name, 1 + static_cast<int>(methods.size()), compute, present);
}

}  // namespace drape::bench
