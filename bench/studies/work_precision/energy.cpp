#include "bench/studies/work_precision/energy.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "bench/runs/energy_guard.hpp"

namespace drape::bench {

std::string energy_fault(const RunSpec& spec) {
  EnergyGuardObserver guard;
  Observer* const observers[] = {&guard};
  const solver::RunResult result = run(spec, model::compile(spec.scene), observers).result;
  return result.outcome == solver::Outcome::unstable ? result.message : "";
}

std::string energy_fault(const model::Scene& scene, const States& solve, int parts) {
  const model::Cloth cloth = model::compile(scene);
  EnergyGuard guard(scene, cloth);
  std::vector<double> times;
  for (int k = 1; k <= parts; ++k) times.push_back(scene.end * k / parts);
  std::vector<solver::State> states;
  try {
    states = solve(cloth, times);
  } catch (const std::exception& error) {
    return error.what();
  }
  for (std::size_t k = 0; k < states.size(); ++k)
    if (guard.exceeded({times[k], scene.end / parts, 0, 0, states[k], {}})) return guard.message(times[k]);
  return "";
}

}  // namespace drape::bench
