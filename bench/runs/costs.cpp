#include "bench/runs/costs.hpp"

#include <functional>
#include <utility>

#include "solver/base/stopwatch.hpp"

namespace drape::bench {
namespace {

/// The same function, whose time is added to a sum. It sets its last arguments and may be called within another.
template <class... Arguments>
void measure(std::function<void(Arguments...)>& function, double& sum) {
  if (!function) return;
  function = [function = std::move(function), &sum](Arguments... arguments) {
    const base::Stopwatch stopwatch(&sum);
    function(std::forward<Arguments>(arguments)...);
  };
}

}  // namespace

Costs costs(const RunSpec& spec, std::size_t most_steps) {
  const model::Cloth cloth = model::compile(spec.scene);
  Costs found;
  const EquationHook measure_parts = [&](solver::SplitOde& ode) {
    for (auto* force : {&ode.force, &ode.explicit_force, &ode.unconstrained_force}) measure(*force, found.forces);
    measure(ode.mean_excess, found.forces);
    measure(ode.jacobian, found.forces);
    measure(ode.newton_matrix, found.forces);
    measure(ode.contacts, found.detection);
    ode.response_ms = &found.response;
  };
  Limits limits;
  limits.steps = most_steps;
  double whole = 0;
  {
    const base::Stopwatch stopwatch(&whole);
    run(spec, cloth, {}, limits, measure_parts);
  }
  found.rest = whole - found.forces - found.detection - found.response;
  return found;
}

}  // namespace drape::bench
