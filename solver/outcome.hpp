#pragma once

#include <string_view>

namespace drape::solver {

/// How a solve, a step or a run ended. Anything but `success` means that its result must not be used.
enum class Outcome {
  success,
  not_converged,  ///< an iteration reached its limit before its tolerance
  breakdown,      ///< a matrix that must be positive definite is not
  not_finite,     ///< a NaN or an infinity appeared
  inaccurate,     ///< the estimated error is above its tolerance
  unstable,       ///< the energy is far above all that the scene can have
  failed,         ///< the method threw an exception
};

/// The outcome as it is written in tables and files, for example "not converged".
constexpr std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::success: return "success";
    case Outcome::not_converged: return "not converged";
    case Outcome::breakdown: return "breakdown";
    case Outcome::not_finite: return "not finite";
    case Outcome::inaccurate: return "inaccurate";
    case Outcome::unstable: return "unstable";
    case Outcome::failed: return "failed";
  }
  return "unknown";
}

}  // namespace drape::solver
