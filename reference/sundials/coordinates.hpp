#pragma once

#include <vector>

#include "solver/split_ode.hpp"

namespace drape::reference {

/// Compressed rows with the 64 bit indices of SUNDIALS.
using WideSparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, std::int64_t>;

/// Which of the 3N coordinates 3i + c are free, and which are pinned and move with a prescribed constant velocity. Those of
/// oblique pins are free: their derivatives are filtered.
struct Coordinates {
  std::vector<int> free, pinned;  ///< in increasing order
  std::vector<int> unknown;       ///< 3N: place among the free ones, -1 if pinned
  std::vector<int> place;         ///< 3N: place among the pinned ones, -1 if free

  /// Throws std::invalid_argument if all coordinates are pinned.
  explicit Coordinates(const solver::SplitOde& ode);
};

/// A start that fits the ODE, with the prescribed velocities. Throws std::invalid_argument if the sizes differ.
solver::State prescribed_start(const solver::SplitOde& ode, const solver::State& start);

}  // namespace drape::reference
