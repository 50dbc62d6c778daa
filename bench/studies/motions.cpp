#include "bench/studies/studies.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::bench {

/// Where the choice of a method is seen with the naked eye: a sheet hung by two corners with little damping, in steps of half a
/// frame. The semi-implicit methods are stable and fall too slowly; of the implicit ones the first order damps what swings.
std::vector<Group> motions(const Question& question) {
  const model::Override damping{"material.damping", "0.5"};
  model::Scene scene = model::load_scene("hung-corners", {&damping, 1});
  if (question.quick) {
    scene.end = 0.1;
    scene.sheet.grid.nu = scene.sheet.grid.nv = 8;
  }
  Group group;
  for (const char* name : {"imex-euler", "sbdf2", "implicit-euler", "bdf2"})
    group.push_back({scene, "material.damping=" + damping.value, &solver::method(name), 0.02, {}});
  return {group};
}

}  // namespace drape::bench
