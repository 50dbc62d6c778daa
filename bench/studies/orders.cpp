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

}  // namespace

std::vector<Job> orders(const Question& question) {
  std::vector<Job> jobs;
  for (const model::Scene& scene : scenes(question.quick))
    jobs.push_back(orders_on(scene, question.quick ? 1e6 : 4e7, converging_or(question.methods)));
  return jobs;
}

}  // namespace drape::bench
