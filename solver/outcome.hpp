#pragma once

#include <optional>
#include <string_view>

namespace drape::solver {

/// How a solve, a step or a run ended. With any outcome except `success` its result must not be used.
enum class Outcome {
  success,
  not_converged,       ///< an iteration reached its limit before its tolerance
  breakdown,           ///< a matrix that must be positive definite is not
  not_finite,          ///< a NaN or an infinity appeared
  inaccurate,          ///< the estimated error is above its tolerance
  unstable,            ///< the energy is far above all that the scene can have
  failed,              ///< the method threw an exception
  out_of_time,         ///< a limit of wall time was reached,
  out_of_memory,       ///< of memory,
  out_of_evaluations,  ///< of evaluations of forces and Newton matrices
};

/// The text in tables and files, for example "not converged".
constexpr std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::success: return "success";
    case Outcome::not_converged: return "not converged";
    case Outcome::breakdown: return "breakdown";
    case Outcome::not_finite: return "not finite";
    case Outcome::inaccurate: return "inaccurate";
    case Outcome::unstable: return "unstable";
    case Outcome::failed: return "failed";
    case Outcome::out_of_time: return "out of time";
    case Outcome::out_of_memory: return "out of memory";
    case Outcome::out_of_evaluations: return "out of evaluations";
  }
  return "unknown";
}

/// The outcome with this text; absent if there is none.
constexpr std::optional<Outcome> outcome_named(std::string_view text) {
  for (int k = 0; k <= static_cast<int>(Outcome::out_of_evaluations); ++k)
    if (to_string(static_cast<Outcome>(k)) == text) return static_cast<Outcome>(k);
  return std::nullopt;
}

}  // namespace drape::solver
