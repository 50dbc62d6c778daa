#include "reference/reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "reference/families.hpp"
#include "reference/growth.hpp"
#include "reference/stepped.hpp"
#include "solver/largest.hpp"

namespace drape::reference {
namespace {

using solver::SplitOde;
using solver::State;

constexpr double looser = 100;         ///< times the tolerance
constexpr double contact_step = 5e-4;  ///< [s]

std::vector<double> distances(const Trajectory& a, const Trajectory& b) {
  std::vector<double> result;
  for (std::size_t k = 0; k < a.states.size(); ++k) result.push_back(rms_distance(a.states[k].x, b.states[k].x));
  return result;
}

/// Solves from a start, as well as it can or loosely.
using Solve = std::function<Trajectory(const State& start, bool loose)>;

/// All of a reference but its names: `a` computes it, `b` is the witness.
Reference compare(const SplitOde& ode, const State& y0, double t0, double size, const Solve& a, const Solve& b) {
  Reference result;
  result.trajectory = a(y0, false);
  result.witnessed = b(y0, false);
  result.error = distances(result.trajectory, result.witnessed);
  const auto effect_a = distances(result.trajectory, a(y0, true)), effect_b = distances(result.witnessed, b(y0, true));
  std::ranges::transform(effect_a, effect_b, std::back_inserter(result.tolerance_effect), solver::larger);

  Growth growth = measure_growth(ode, y0, t0, result.trajectory, size, [&](const State& start) { return a(start, false); });
  result.growth = std::move(growth.factors);
  result.perturbed = std::move(growth.perturbed);
  return result;
}

}  // namespace

double rms_distance(const solver::Vectors& a, const solver::Vectors& b) {
  return std::sqrt((a - b).squaredNorm() / static_cast<double>(a.rows()));
}

Reference reference(const SplitOde& ode, const State& y0, double t0, std::span<const double> times,
                    const SolveOptions& options) {
  const Family &family_a = family("cvode-bdf"), &family_b = family("arkode-esdirk");
  const auto solve_with = [&](const Family& by) -> Solve {
    return [&](const State& start, bool loose) {
      SolveOptions changed = options;
      if (loose) changed.rtol *= looser;
      return by.solve(ode, start, t0, times, changed);
    };
  };
  Reference result = compare(ode, y0, t0, options.size, solve_with(family_a), solve_with(family_b));
  result.name = family_a.name;
  result.witness = family_b.name;
  result.tolerance = options.rtol;
  return result;
}

Reference contact_reference(const SplitOde& ode, const State& y0, double t0, std::span<const double> times,
                            const SolveOptions& options) {
  check(times, t0, options);
  const auto solve_with = [&](const char* method) -> Solve {
    return [&, method](const State& start, bool loose) {
      return stepped(ode, solver::method(method), start, t0, times, loose ? 2 * contact_step : contact_step);
    };
  };
  Reference result = compare(ode, y0, t0, options.size, solve_with("verlet"), solve_with("midpoint"));
  result.name = "verlet";
  result.witness = "midpoint";
  result.tolerance = contact_step;
  for (std::size_t k = 0; k < times.size(); ++k) result.error[k] = solver::larger(result.error[k], result.tolerance_effect[k]);
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
