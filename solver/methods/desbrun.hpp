#pragma once

#include "solver/step.hpp"

namespace drape::solver {

/// The method `desbrun` before it restores the angular momentum, which is `imex-euler` by other means.
void desbrun_without_correction(Step& s);

}  // namespace drape::solver
