#include "bench/studies/contact/contact_runs.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "bench/runs/record.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/methods.hpp"

namespace drape::bench {
namespace {

using results::RunRecord;
using results::StepRecord;

constexpr double resting = 1e-2;             // kinetic energy over the largest one
constexpr double garment_thickness = 0.004;  // where the scene has none [m]

/// Three sheets that fall onto each other and the floor. They begin stretched and swing while they fall: systems of sheets that
/// only fall need no iterations.
constexpr std::string_view stack = R"(
name = "stack"
grid = { n = 8, size = 0.2 }
material = { density = 0.3, tension = 200, damping = 0.2, shear = 10, bend = 1e-5 }
forces = { gravity = [0, 0, -9.81] }
obstacles = [{ shape = "plane" }]
contact = { distance = 0.005, thickness = 0.005 }
start = { stretch = 1.02 }
end = { time = 0.8 }
panels = [
  { name = "lower", start.position = [0, 0, 0.08] },
  { name = "middle", start.position = [0.0071, 0.0043, 0.095] },
  { name = "upper", start.position = [0.0031, 0.0133, 0.11] },
]
)";

}  // namespace

bool is_garment(const std::string& name) { return std::ranges::count(self_contact_garments, name) > 0; }

model::Scene contact_scene(const std::string& name, bool quick, std::string_view response) {
  std::vector<model::Override> changes{{"contact.response", std::string(response)}};
  if (quick) changes.push_back({"grid.n", name == "stack" ? "4" : "8"});
  if (name == "stack") return model::parse_scene(stack, name, changes);
  model::Scene scene = model::load_scene(name, changes);
  if (is_garment(name) && scene.contact.thickness == 0) scene.contact.thickness = garment_thickness;
  return scene;
}

int intersections(const ContactFindings& found) { return found.intersecting + found.in_bodies + found.through_bodies; }

bool WatchedRun::usable() const { return run.succeeded() && intersections(found) == 0; }

RunSpec contact_spec(const model::Scene& scene, std::string_view method, double step) {
  return {scene, "", &solver::method(method), step, solver::thesis_options()};
}

WatchedRun watched(const RunSpec& spec) {
  ContactWatch watch;
  Observer* const observers[] = {&watch};
  RunRecord run = record(spec, observers);
  return {std::move(run), watch.findings()};
}

double motion_at_end(Steps steps) {
  return steps.empty() ? 0
                       : steps.back().kinetic_energy / std::ranges::max(steps, {}, &StepRecord::kinetic_energy).kinetic_energy;
}

ContactParts parts_of(const WatchedRun& one) {
  constexpr std::size_t most_at_rest = 20;
  const Steps all = one.run.steps;
  std::size_t first = 0;
  while (first < all.size() && all[first].contacts == 0 && one.found.pairs[first] == 0) ++first;
  const std::size_t touching = all.size() - first;
  const bool rests = one.run.succeeded() && motion_at_end(all) <= resting;
  const std::size_t at_rest = rests ? std::min(most_at_rest, touching) : 0;
  return {all.first(first), all.subspan(first, touching - at_rest), all.last(at_rest)};
}

std::optional<double> iterations_of(Steps steps) {
  if (steps.empty()) return {};
  return iterations(steps);
}

}  // namespace drape::bench
