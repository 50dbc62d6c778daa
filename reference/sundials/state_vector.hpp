#pragma once

#include <sundials/sundials_nvector.h>

#include <cstdint>

#include "solver/state.hpp"

namespace drape::reference::sundials_tools {

/// What a vector of SUNDIALS holds here: N × 3 positions and velocities and the internal variables (or what corresponds to
/// them: derivatives, residuals, weights), so that forces read and write it in place, and for IDA one reaction for each pinned
/// coordinate.
struct StateVector {
  solver::State state;
  Eigen::VectorXd reactions = {};

  /// The unknowns among these numbers: the vector's length for SUNDIALS. Root mean squares are over them, so that pinned
  /// coordinates, whose entries are 0, do not dilute an error norm.
  std::int64_t unknowns = 0;
};

/// A vector of SUNDIALS with this content. Its operations are compiled with our flags and make one pass over memory each; the
/// result may be one of the arguments. It has those that CVODE, ARKODE, IDA and GMRES call, and no pointer to contiguous
/// memory. Null if there is no memory.
N_Vector make_state_vector(StateVector content, SUNContext context);

/// The content of a vector that make_state_vector() or a clone of it made.
inline StateVector& content(N_Vector vector) { return *static_cast<StateVector*>(vector->content); }

}  // namespace drape::reference::sundials_tools
