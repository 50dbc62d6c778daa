#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "solver/state.hpp"

namespace drape::solver {

/// The complete factor P A Pᵀ = L Lᵀ of a symmetric matrix of 3 × 3 blocks, by the multifrontal method [Duff, Reid 1983]:
/// columns of nearly the same pattern are one dense panel, and what it takes off later columns goes to its parent in the tree
/// of elimination. Branches of the tree, and tiles of large fronts, are independent: threads take them as they come, and
/// results are the same bit for bit for any number.
class BlockCholesky {
 public:
  /// Orders the blocks, if those of this pattern were not. A: the upper triangle, 3N × 3N. Throws std::bad_alloc.
  explicit BlockCholesky(const SparseMatrix& A);

  /// False if A, of the same pattern, is not positive definite.
  bool factor(const SparseMatrix& A);

  /// d = A⁻¹ r; both N × 3.
  void solve(const Vectors& r, Vectors& d) const;

 private:
  struct Front;
  class Plan;
  using Panel = Eigen::Map<Eigen::MatrixXd>;
  using ConstPanel = Eigen::Map<const Eigen::MatrixXd>;

  void place_updates();
  bool is_task(const Front& front) const;
  Panel update(int front);
  Panel panel(const Front& front);
  ConstPanel panel(const Front& front) const;

  void eliminate_branch(int front);
  void eliminate(int front);
  void add_update(int child, const Front& parent, Panel& to_parents);

  std::shared_ptr<const Plan> plan_;  ///< what follows from the pattern
  int threads_ = 1;
  double least_branch_ = 0;  ///< multiplications of a task
  Eigen::VectorXd values_;
  Eigen::VectorXd updates_;  ///< what fronts take off their parents
  std::vector<std::int64_t> updates_at_;
  std::atomic<bool> is_definite_ = true;
  mutable Eigen::VectorXd solution_, below_;
};

}  // namespace drape::solver
