#include <fmt/format.h>

#include <cmath>

#include "bench/errors.hpp"
#include "bench/studies.hpp"
#include "bench/sweep.hpp"
#include "model/scene_file.hpp"
#include "results/order_fit.hpp"

namespace drape::bench {
namespace {

using model::Override;
using solver::Method;

/// A scene for a short time, with what is set in it.
struct Setting {
  std::string scene;
  std::vector<Override> overrides;
};

std::vector<Setting> settings(bool quick) {
  if (quick) return {{"hung-corners", {{"grid.n", "6"}, {"material.damping", "5"}, {"end.time", "0.05"}}}};
  return {{"hung-edge", {{"end.time", "0.2"}}},
          {"hung-corners", {{"material.damping", "5"}, {"end.time", "0.2"}}},
          {"pulled", {{"end.time", "0.1"}}}};
}

/// So tight that what is left of the error is the method's own.
solver::Options tight() {
  solver::Options options = solver::thesis_options();
  options.loop_tolerance = 1e-11;
  options.cg_tolerance = 1e-12;
  options.linear_solver = &solver::linear_solver("cholesky");
  return options;
}

/// Runs one method with ever smaller steps, until its error is as small as the reference's, or a run takes too much work:
/// counted, so that the curve ends at the same step on every machine.
class Refinement {
 public:
  Refinement(const model::Scene& scene, const model::Cloth& cloth, const reference::Reference& reference, const Method& method)
      : scene_(scene), cloth_(cloth), reference_(reference), method_(method) {}

  void add_rows(results::TableBuilder& table, double most_work) {
    constexpr std::int64_t coarsest = 5, most = std::int64_t(1) << 22;
    for (std::int64_t n = method_.implicit() ? coarsest : substeps(coarsest); n <= most; n *= 2) {
      const results::RunRecord run = record({scene_, "", &method_, scene_.end / double(n), tight()});
      if (!add_row(table, run) || work(run) > most_work) break;
    }
    const auto fit = results::fit_order(steps_, errors_, uncertainty_);
    results::add_fit(table, fit, results::verdict(fit, method_.order));
  }

 private:
  /// Explicit methods divide longer steps: their coarsest is the stability limit.
  std::int64_t substeps(std::int64_t n) const {
    return results::work_count(record({scene_, "", &method_, scene_.end / double(n), tight()}), "substeps");
  }

  /// Systems solved or sub-steps taken, a particle each.
  static double work(const results::RunRecord& run) {
    const std::int64_t count = results::work_count(run, "updates") + results::work_count(run, "substeps");
    return static_cast<double>(count) * static_cast<double>(run.final_state.x.rows());
  }

  /// False where it makes no sense to go on.
  bool add_row(results::TableBuilder& table, const results::RunRecord& run) {
    table.row();
    table.text("scene", "scene", "its name", scene_.name);
    table.text("method", "method", "time integrator", std::string(method_.name));
    table.number("step", "h", "s", "step", run.step);
    if (run.outcome != to_string(solver::Outcome::success)) {
      table.text("outcome", "outcome", "how the run failed", run.outcome);
      return true;
    }
    const results::ErrorRecord error = distance(run, reference_, scene_, cloth_);
    uncertainty_ = error.reference_error;
    table.number("error", "rms error", "1", "distance from the reference at the end, over the size of the scene", error.rms);
    table.number("uncertainty", "", "1", "of the reference", error.reference_error);
    if (!errors_.empty())
      table.number("order", "order", "1", "between this step and the one before",
                   std::log(errors_.back() / error.rms) / std::log(steps_.back() / run.step));
    steps_.push_back(run.step);
    errors_.push_back(error.rms);
    return resolved(error);
  }

  const model::Scene& scene_;
  const model::Cloth& cloth_;
  const reference::Reference& reference_;
  const Method& method_;
  std::vector<double> steps_, errors_;
  double uncertainty_ = 0;
};

results::Table orders_on(const Setting& setting, bool quick, Units& units) {
  const model::Scene scene = model::load_scene(setting.scene, setting.overrides);
  const model::Cloth cloth = model::compile(scene);
  units.show("reference of " + scene.name);
  const auto say = [&](const std::string& pace) { units.report("reference of " + scene.name + ": " + pace); };
  References references(SweepOptions().agreement, {.say = say}, 1e-12);  // the more of a curve is resolved
  const reference::Reference reference = references(scene, cloth);
  units.advance();
  results::TableBuilder table("orders-" + scene.name, fmt::format("Order in time on {}, {:g} s; reference {} + {}", scene.name,
                                                                  scene.end, reference.name, reference.witness));
  for (const Method& method : solver::methods()) {
    units.show(fmt::format("{} on {}", method.name, scene.name));
    units.rows(table, std::string(method.name), [&](results::TableBuilder& rows) {
      Refinement(scene, cloth, reference, method).add_rows(rows, quick ? 1e6 : 4e7);
    });
    units.advance();
  }
  return table.finish();
}

}  // namespace

std::vector<TableJob> orders(bool quick) {
  std::vector<TableJob> jobs;
  for (const Setting& setting : settings(quick))
    jobs.push_back(
        {1 + static_cast<int>(solver::methods().size()), [=](Units& units) { return orders_on(setting, quick, units); }});
  return jobs;
}

}  // namespace drape::bench
