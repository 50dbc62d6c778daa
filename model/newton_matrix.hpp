#pragma once

#include <functional>
#include <vector>

#include "model/term.hpp"
#include "solver/split_ode.hpp"

namespace drape::model {

/// Assembles J ≈ M − γ² ∂f/∂x − γ ∂f/∂v from the terms' convex blocks straight into its sparse pattern, which is found once.
class NewtonMatrix {
 public:
  /// Hands the blocks of a configuration to the entries, always in the same order.
  using Visit = std::function<void(const JacobianEntries& entries)>;

  /// `mass`: N. Pinned coordinates have nothing but their mass.
  NewtonMatrix(Curvature curvature, const Eigen::VectorXd& mass, const std::vector<solver::Pin>& pins);

  /// Sets the upper triangle of J, 3N × 3N. J must be empty or what the last call left.
  void assemble(const Visit& visit, double gamma, SparseMatrix& J);

 private:
  /// Where the entries of one kind of block go: nine a block, -1 for those below the diagonal or pinned.
  using Slots = std::vector<int>;

  bool kept(int row, int column) const { return column >= row && !pinned_[row] && !pinned_[column]; }
  void analyse(const Visit& visit);
  Slots slots(const std::vector<Eigen::Vector2i>& blocks) const;

  Curvature curvature_;
  Eigen::VectorXd mass_;      ///< 3N
  std::vector<char> pinned_;  ///< 3N
  SparseMatrix pattern_;
  Slots dx_, dv_, diagonal_;
};

}  // namespace drape::model
