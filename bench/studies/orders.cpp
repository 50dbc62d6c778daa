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

results::Table orders_on(const model::Scene& scene, bool quick, const Methods& methods, Checkpoint& checkpoint) {
  const model::Cloth cloth = model::compile(scene);
  checkpoint.show("reference of " + scene.name);
  const auto say = [&](const std::string& pace) { checkpoint.report("reference of " + scene.name + ": " + pace); };
  References references(SweepOptions().agreement, {.say = say}, 1e-12);  // the more of a curve is resolved
  const reference::Reference reference = references(scene, cloth);
  checkpoint.advance();
  std::vector<RefinedRun> runs;
  for (const solver::Method* method : methods) {
    checkpoint.show(fmt::format("{} on {}", method->name, scene.name));
    const std::string name(method->name);
    auto curve = checkpoint.once(name, [&] { return refine(tight(scene, name), name, cloth, reference, quick ? 1e6 : 4e7); });
    fit_curve(curve, method->order);
    std::ranges::move(curve, std::back_inserter(runs));
    checkpoint.advance();
  }
  return refinement_table(
      "orders-" + scene.name,
      fmt::format("Order in time on {}, {:g} s; reference {} + {}", scene.name, scene.end, reference.name, reference.witness),
      runs);
}

}  // namespace

std::vector<TableJob> orders(bool quick, const Methods& methods) {
  const Methods chosen = all_or(methods);
  std::vector<TableJob> jobs;
  for (const model::Scene& scene : scenes(quick))
    jobs.push_back({1 + static_cast<int>(chosen.size()),
                    [=](Checkpoint& checkpoint) { return orders_on(scene, quick, chosen, checkpoint); }});
  return jobs;
}

}  // namespace drape::bench
