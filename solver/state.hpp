#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>

namespace drape::solver {

/// One vector in R³ per particle: N × 3, row by row, so that a particle's coordinates are neighbours in memory.
using Vectors = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Compressed rows. Scalar matrices are N × N and act on all three coordinates alike; Jacobians are 3N × 3N.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// Positions x [m] and velocities v [m/s] of all particles, and the internal variables of forces that remember the motion.
struct State {
  Vectors x;
  Vectors v;
  Eigen::VectorXd z = {};  ///< as many as Memory::variables(); empty without memory
};

/// Repeats each particle's value for its three coordinates, as they lie in memory: N in, 3N out.
inline Eigen::VectorXd thrice(const Eigen::VectorXd& values) { return values.replicate(1, 3).reshaped<Eigen::RowMajor>(); }

}  // namespace drape::solver
