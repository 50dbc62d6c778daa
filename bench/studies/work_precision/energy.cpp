#include "bench/studies/work_precision/energy.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "bench/runs/energy_guard.hpp"

namespace drape::bench {

std::string energy_fault(const Cell& cell) {
  const model::Cloth cloth = model::compile(cell.scene);
  solver::Integrator integrator(cloth.ode, *cell.method, cell.options, cloth.start);
  EnergyGuard guard(cell.scene, cloth);
  const solver::RunResult run = integrate(integrator, guard, cell.scene.end, cell.step);
  return run.outcome == solver::Outcome::unstable ? run.message : "";
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
