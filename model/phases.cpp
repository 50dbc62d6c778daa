#include "model/phases.hpp"

#include <algorithm>
#include <set>

namespace drape::model {
namespace {

/// Where a path is at a time: at rest before its first point and after its last.
Eigen::Vector3d place_at(const std::vector<PathPoint>& path, double t) {
  const auto next = std::ranges::upper_bound(path, t, {}, &PathPoint::t);
  if (next == path.begin()) return next->position;
  if (next == path.end()) return path.back().position;
  const PathPoint& last = *(next - 1);
  return last.position + (t - last.t) / (next->t - last.t) * (next->position - last.position);
}

/// What moves along paths moves uniformly between two times.
std::vector<PinRule> uniform(std::vector<PinRule> pins, double begin, double end) {
  for (PinRule& pin : pins) {
    if (pin.path.empty()) continue;
    pin.velocity = (place_at(pin.path, end) - place_at(pin.path, begin)) / (end - begin);
    pin.path.clear();
  }
  return pins;
}

void add_times(const std::vector<PinRule>& pins, double begin, double end, std::set<double>& times) {
  for (const PinRule& pin : pins)
    for (const PathPoint& point : pin.path)
      if (point.t > begin && point.t < end) times.insert(point.t);
}

/// Adds a phase for each interval between the times at which paths turn.
void add(const Scene& whole, double begin, double end, std::vector<Scene>& all) {
  std::set<double> times{begin, end};
  add_times(whole.pins, begin, end, times);
  for (auto last = times.begin(), next = std::next(last); next != times.end(); ++last, ++next) {
    Scene& part = all.emplace_back(whole);
    part.begin = *last, part.end = *next;
    part.pins = uniform(whole.pins, *last, *next);
  }
}

}  // namespace

std::vector<Scene> phases(const Scene& scene) {
  std::vector<Scene> all;
  Scene rest = scene;
  rest.phases.clear();
  double begin = scene.begin;
  for (const PhaseRule& rule : scene.phases) {
    if (!(begin < scene.end)) break;
    Scene phase = rest;
    phase.sheet.gravity = rule.gravity.value_or(scene.sheet.gravity);
    phase.pins = rule.pins.value_or(scene.pins);
    phase.seam_state = rule.seams;
    phase.seams_meet = rule.until;
    const double end = std::min(rule.until, scene.end);
    add(phase, begin, end, all);
    begin = end;
  }
  if (begin < scene.end) add(rest, begin, scene.end, all);
  return all;
}

NextPhase compile_next(const Scene& phase, const Cloth& before, const solver::State& y) {
  auto garment = std::make_shared<const Garment>(phase);
  const solver::State of_particles{before.garment->spread(y.x), before.garment->spread(y.v)};
  solver::State start = garment->gathered(of_particles);
  start.z = y.z;
  const Vectors merged = start.v;  // before pins prescribe theirs
  Cloth cloth = compile(phase, std::move(garment), std::move(start), before.ode.work);
  const double lost = solver::kinetic_energy(before.ode, y.v) - solver::kinetic_energy(cloth.ode, merged);
  return {std::move(cloth), lost};
}

}  // namespace drape::model
