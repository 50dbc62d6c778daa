#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/sweep.hpp"
#include "bench/studies/refinement.hpp"
#include "bench/studies/studies.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::bench {
namespace {

std::vector<model::Scene> scenes(bool quick) {
  std::vector<model::Scene> all{smooth_scene()};
  if (quick) return all;
  const auto add = [&](const char* scene, const std::vector<model::Override>& overrides) {
    all.push_back(model::load_scene(scene, overrides));
  };
  add("hung-edge", {{"end.time", "0.2"}});
  add("hung-corners", {{"material.damping", "5"}, {"end.time", "0.2"}});
  add("pulled", {{"end.time", "0.1"}});
  return all;
}

/// The curves of all methods on a scene.
struct OrdersOnScene {
  std::string families;  ///< behind the reference
  std::vector<RefinedRun> runs;
};

OrdersOnScene orders_on(const model::Scene& scene, bool quick, const Methods& methods, Checkpoint& checkpoint) {
  const model::Cloth cloth = model::compile(scene);
  checkpoint.show("reference of " + scene.name);
  const auto say = [&](const std::string& pace) { checkpoint.report("reference of " + scene.name + ": " + pace); };
  References references(SweepOptions().agreement, {.say = say}, 1e-12);  // the more of a curve is resolved
  const reference::Reference reference = references(scene, cloth);
  checkpoint.advance();
  std::vector<RefinedRun> runs;
  for (const solver::Method* method : methods) {
    if (method->needs_energies && !cloth.plan.without_energy.empty()) continue;
    checkpoint.show(fmt::format("{} on {}", method->name, scene.name));
    const std::string name(method->name);
    auto curve = refine(tight(scene, name), name, cloth, reference, quick ? 1e6 : 4e7, checkpoint);
    fit_curve(curve, method->order);
    std::ranges::move(curve, std::back_inserter(runs));
    checkpoint.advance();
  }
  return {fmt::format("{} + {}", reference.name, reference.witness), std::move(runs)};
}

}  // namespace

std::vector<Job> orders(const Question& question) {
  const Methods methods = converging_or(question.methods);
  std::vector<Job> jobs;
  for (const model::Scene& scene : scenes(question.quick)) {
    const std::string name = "orders-" + scene.name;
    const auto compute = [=, quick = question.quick](Checkpoint& checkpoint) {
      return orders_on(scene, quick, methods, checkpoint);
    };
    const auto present = [=](const OrdersOnScene& orders) {
      return refinement_table(
          name, fmt::format("Order in time on {}, {:g} s; reference {}", scene.name, scene.end, orders.families), orders.runs);
    };
    jobs.push_back(job(name, 1 + static_cast<int>(methods.size()), compute, present));
  }
  return jobs;
}

}  // namespace drape::bench
