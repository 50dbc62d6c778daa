#pragma once

#include "model/jacobian/slots.hpp"
#include "solver/filter.hpp"
#include "solver/split_ode.hpp"

namespace drape::model {

/// Assembles J ≈ M − γ² ∂f/∂x − γ ∂f/∂v from the terms' convex blocks straight into its sparse pattern, which is found once.
class NewtonMatrix {
 public:
  /// `mass`: N. Pinned directions have only their mass.
  NewtonMatrix(Curvature curvature, const Eigen::VectorXd& mass, const std::vector<solver::Pin>& pins);

  /// Sets the upper triangle of J, 3N × 3N. J must be empty or the result of the last call. `in_threads`: whether several
  /// threads may visit at the same time; each takes some rows.
  void assemble(const VisitBlocks& visit, bool in_threads, double gamma, SparseMatrix& J);

 private:
  bool kept(int row, int column) const { return column >= row && !pinned_[row] && !pinned_[column]; }
  void analyse(const VisitBlocks& visit);
  void add_rows(const VisitBlocks& visit, double gamma, int begin, int end, double* values) const;

  Curvature curvature_;
  Eigen::VectorXd mass_;      ///< 3N
  std::vector<char> pinned_;  ///< 3N
  solver::ObliquePins oblique_;
  SparseMatrix pattern_;
  BlockSlots dx_, dv_;
  std::vector<int> diagonal_;
};

}  // namespace drape::model
