#include "bench/studies/studies.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::bench {

/// The methods of table 3.2 and IMEX midpoint as the thesis solves them, and all methods as we do, on the 20 × 20 sheet: l =
/// 0.8/19 m, k = 10⁴ N/m, ρ = 1 kg/m², h = 0.01 s, 1 s.
std::vector<Group> hung_sheets(const Question& question) {
  std::vector<Group> groups;
  for (const char* name : {"hung-edge", "hung-corners"})
    for (const char* damping : {"50", "0.5"}) {
      const model::Override change{"material.damping", damping};
      model::Scene scene = model::load_scene(name, {&change, 1});
      if (question.quick) {
        scene.end = 0.1;
        scene.sheet.grid.nu = scene.sheet.grid.nv = 8;
      }
      Group group;
      const std::string overrides = "material.damping=" + change.value;
      for (const solver::Method& method : solver::thesis_methods())
        if (method.implicit()) group.push_back({scene, overrides, &method, 0.01, solver::thesis_options()});
      for (const solver::Method& method : solver::methods()) group.push_back({scene, overrides, &method, 0.01, {}});
      groups.push_back(std::move(group));
    }
  return groups;
}

}  // namespace drape::bench
