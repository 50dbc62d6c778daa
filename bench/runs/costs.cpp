#include "bench/runs/costs.hpp"

#include <chrono>
#include <utility>

namespace drape::bench {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) { return std::chrono::duration<double, std::milli>(Clock::now() - begin).count(); }

/// The same function, whose time is added to a sum. It sets its last arguments and may be called within another.
template <class... Arguments>
void measure(std::function<void(Arguments...)>& function, double& sum) {
  if (!function) return;
  function = [function = std::move(function), &sum](Arguments... arguments) {
    const Clock::time_point begin = Clock::now();
    function(std::forward<Arguments>(arguments)...);
    sum += since(begin);
  };
}

}  // namespace

Costs costs(const RunSpec& spec, std::size_t most_steps) {
  model::Cloth cloth = model::compile(spec.scene);
  Costs found;
  solver::SplitOde& ode = cloth.ode;
  for (auto* force : {&ode.force, &ode.explicit_force, &ode.unconstrained_force}) measure(*force, found.forces);
  measure(ode.mean_excess, found.forces);
  measure(ode.jacobian, found.forces);
  measure(ode.newton_matrix, found.forces);
  measure(ode.contacts, found.detection);
  Limits limits;
  limits.steps = most_steps;
  const Clock::time_point begin = Clock::now();
  run(spec, cloth, {}, limits);
  found.rest = since(begin) - found.forces - found.detection;
  return found;
}

}  // namespace drape::bench
