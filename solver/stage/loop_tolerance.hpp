#pragma once

#include <algorithm>

#include "solver/options.hpp"
#include "solver/stage.hpp"

namespace drape::solver {

/// η of a stage that is solved to |r| ≤ η |b|: that of the options, or less where energies are kept only as far as stages are
/// solved.
inline double loop_tolerance(const Options& options, const Stage& stage) {
  constexpr double exact = 1e-13;
  return stage.start != nullptr ? std::min(options.loop_tolerance, exact) : options.loop_tolerance;
}

}  // namespace drape::solver
