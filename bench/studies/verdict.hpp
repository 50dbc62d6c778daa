#pragma once

#include <array>
#include <limits>
#include <string_view>

#include "solver/outcome.hpp"

namespace drape::bench {

/// What became of a run.
enum class Verdict {
  accurate,       ///< its error is below a bound
  wrong,          ///< bounded energy, but an error above it
  bounded,        ///< bounded energy; there is no reference to tell the error
  unstable,       ///< its energy rose beyond what the scene can have, or it ended in a NaN
  not_converged,  ///< a step's equations were not solved
  not_finished,   ///< it exceeded its budget
};
inline constexpr int verdicts = 6;

/// The verdict as it is written in tables and files, for example "stable but wrong".
constexpr std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::accurate: return "accurate";
    case Verdict::wrong: return "stable but wrong";
    case Verdict::bounded: return "stable, error unknown";
    case Verdict::unstable: return "unstable";
    case Verdict::not_converged: return "not converged";
    case Verdict::not_finished: return "not finished";
  }
  return "unknown";
}

/// In the order of Verdict: the best first.
inline constexpr auto verdict_names = [] {
  std::array<std::string_view, verdicts> names;
  for (int k = 0; k < verdicts; ++k) names[k] = to_string(static_cast<Verdict>(k));
  return names;
}();

/// An error known up to an uncertainty; NaN: not known.
struct UncertainError {
  double error = std::numeric_limits<double>::quiet_NaN();
  double uncertainty = std::numeric_limits<double>::quiet_NaN();
};

/// The verdict on a run. Its error counts as below or above the bound only if it is so however the reference errs.
constexpr Verdict judge(solver::Outcome outcome, const UncertainError& measured, double bound) {
  switch (outcome) {
    case solver::Outcome::success: break;
    case solver::Outcome::unstable:
    case solver::Outcome::not_finite: return Verdict::unstable;
    case solver::Outcome::not_converged:
    case solver::Outcome::breakdown:
    case solver::Outcome::failed:
    case solver::Outcome::inaccurate: return Verdict::not_converged;
    case solver::Outcome::out_of_time:
    case solver::Outcome::out_of_memory:
    case solver::Outcome::out_of_evaluations: return Verdict::not_finished;
  }
  if (measured.error + measured.uncertainty <= bound) return Verdict::accurate;
  if (measured.error - measured.uncertainty > bound) return Verdict::wrong;
  return Verdict::bounded;
}

}  // namespace drape::bench
