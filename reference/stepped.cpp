#include "reference/stepped.hpp"

#include <fmt/format.h>

#include <cmath>

#include "solver/integrator.hpp"

namespace drape::reference {
namespace {

solver::Options tight() {
  solver::Options options = solver::thesis_options();
  options.loop_tolerance = 1e-9;
  options.cg_tolerance = 5e-10;
  options.linear_solver = &solver::linear_solver("cholesky");
  options.verlet_fraction = 0.3;
  return options;
}

}  // namespace

Trajectory stepped(const solver::SplitOde& ode, const solver::Method& method, const solver::State& y0, double t0,
                   std::span<const double> times, double step) {
  solver::Integrator integrator(ode, method, tight(), y0, t0);
  Trajectory trajectory;
  for (const double t : times) {
    const double left = t - integrator.time();
    if (left > 0) {
      const auto result = integrate(integrator, t, left / std::ceil(left / step * (1 - 1e-9)));
      if (result.outcome != solver::Outcome::success)
        throw ReferenceError(fmt::format("{}: {}", method.name, result.message), std::string(to_string(result.outcome)),
                             result.last_good_time);
    }
    trajectory.times.push_back(t);
    trajectory.states.push_back(integrator.state());
  }
  return trajectory;
}

}  // namespace drape::reference
