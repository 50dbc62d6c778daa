#pragma once

#include <vector>

#include "solver/stage/chebyshev.hpp"
#include "solver/stage/stage_iteration.hpp"

namespace drape::solver {

/// Vertex block descent [Chen et al. 2024]: a sweep solves for one particle after the other, with the others as they are, by
/// one Newton step on its 3 × 3 block of the Hessian; Chebyshev's weights combine the sweeps. Its fixed point is the stage.
///
/// Particles of one colour do not act on each other and are moved together. The blocks are those of newton_matrix where the
/// sweep begins, the residual is evaluated before every colour: the order of work is that of Gauss-Seidel, its cost is not
/// that of an implementation with forces on single particles. An update is a sweep. Memory is allocated at the first sweep.
class VertexDescent : public StageIteration {
 public:
  /// Throws std::invalid_argument if the ODE has no newton_matrix.
  VertexDescent(const SplitOde& ode, const Options& options, StageSystem& system);

 private:
  void begin(const State& y) override;
  LinearResult advance(const Stage& stage, State& y, double target) override;
  void find_blocks(double inertia);
  void find_colours();
  void move(const std::vector<int>& colour, Vectors& v) const;

  SparseMatrix J_;
  std::vector<Eigen::Matrix3d> blocks_;    ///< inverses
  std::vector<std::vector<int>> colours_;  ///< particles of each
  ChebyshevIterates iterates_;
  Vectors last_;
};

}  // namespace drape::solver
