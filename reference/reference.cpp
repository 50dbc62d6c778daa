#include "reference/reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <future>
#include <utility>

#include "reference/growth.hpp"
#include "reference/stepped.hpp"
#include "reference/sundials/peer_solvers.hpp"
#include "solver/base/largest.hpp"

namespace drape::reference {
namespace {

using solver::SplitOde;
using solver::State;

constexpr double looser = 10;          ///< times the tolerance: the witness's
constexpr double contact_step = 5e-4;  ///< [s]

std::vector<double> distances(const Trajectory& a, const Trajectory& b) {
  std::vector<double> result;
  for (std::size_t k = 0; k < a.states.size(); ++k) result.push_back(rms_distance(a.states[k].x, b.states[k].x));
  return result;
}

/// Solves from a start.
using Solve = std::function<Trajectory(const State& start)>;

/// Starts to solve the second equation, or defers it until it is needed.
std::future<Trajectory> start_second(const Equations& equations, const Solve& solve, const State& y0) {
  return std::async(equations.at_once() ? std::launch::async : std::launch::deferred, [&] { return solve(y0); });
}

/// All of a reference but its names and tolerance: `first` computes it, `second` is the witness.
Reference compare(const Equations& equations, const State& y0, double t0, double size, const Solve& first,
                  const Solve& second) {
  Reference result;
  auto witnessed = start_second(equations, second, y0);
  result.trajectory = first(y0);
  Growth growth = measure_growth(equations.first, y0, t0, result.trajectory, size, first);
  result.growth = std::move(growth.factors);
  result.perturbed = std::move(growth.perturbed);
  result.witnessed = witnessed.get();
  result.error = distances(result.trajectory, result.witnessed);
  return result;
}

Reference reference_by(const PeerSolver& first, const PeerSolver& second, const Equations& equations, const State& y0,
                       double t0, std::span<const double> times, const SolveOptions& options) {
  SolveOptions witness_options = options;
  if (&second == &peer_solver("arkode-esdirk")) witness_options.rtol *= looser;
  Reference result = compare(
      equations, y0, t0, options.size,
      [&](const State& start) { return solve_by_either(first, equations.first, start, t0, times, options); },
      [&](const State& start) { return solve_by_either(second, equations.second, start, t0, times, witness_options); });
  result.name = first.name;
  result.witness = second.name;
  result.tolerance = options.rtol;
  return result;
}

}  // namespace

Reference reference(const Equations& equations, const State& y0, double t0, std::span<const double> times,
                    const SolveOptions& options) {
  const PeerSolver &bdf = peer_solver("cvode-bdf"), &runge_kutta = peer_solver("arkode-esdirk"),
                   &residual = peer_solver("ida-bdf");
  try {
    return reference_by(bdf, runge_kutta, equations, y0, t0, times, options);
  } catch (const ReferenceError&) {
    for (const PeerSolver* left : {&bdf, &runge_kutta}) try {
        return reference_by(*left, residual, equations, y0, t0, times, options);
      } catch (const std::runtime_error&) {  // IDA's start may fail outside its own code; the first reason is the one to report
      }
    throw;
  }
}

Reference contact_reference(const Equations& equations, const State& y0, double t0, std::span<const double> times,
                            const SolveOptions& options) {
  check(times, t0, options);
  const auto solve_with = [&](const char* method, const SplitOde& ode, double step) -> Solve {
    return [&, method, step](const State& start) { return stepped(ode, solver::method(method), start, t0, times, step); };
  };
  Reference result = compare(equations, y0, t0, options.size, solve_with("verlet", equations.first, contact_step),
                             solve_with("midpoint", equations.second, contact_step));
  const Solve coarse_midpoint = solve_with("midpoint", equations.second, 2 * contact_step);
  auto coarse_witness = start_second(equations, coarse_midpoint, y0);
  const auto effect = distances(result.trajectory, solve_with("verlet", equations.first, 2 * contact_step)(y0));
  const auto witness_effect = distances(result.witnessed, coarse_witness.get());
  result.name = "verlet";
  result.witness = "midpoint";
  result.tolerance = contact_step;
  for (std::size_t k = 0; k < times.size(); ++k)
    result.error[k] = base::larger(result.error[k], base::larger(effect[k], witness_effect[k]));
  return result;
}

void certify(const Reference& reference, double agreement, double largest_growth, double size) {
  for (std::size_t k = 0; k < reference.error.size(); ++k)
    if (!(reference.growth[k] > largest_growth) && !(reference.error[k] <= agreement * size))
      throw NotCertified(fmt::format(
          "{} and {} disagree by {:.2g} of the size at t = {:g} s, where at most {:g} is allowed (rtol = {})", reference.name,
          reference.witness, reference.error[k] / size, reference.trajectory.times[k], agreement, reference.tolerance));
}

}  // namespace drape::reference
