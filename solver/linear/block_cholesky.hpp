#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <vector>

#include "solver/state.hpp"

namespace drape::solver {

/// The complete factor P A Pᵀ = L Lᵀ of a symmetric matrix of 3 × 3 blocks, by the multifrontal method [Duff, Reid 1983]:
/// columns of nearly the same pattern are one dense panel, and what it takes off later columns goes to its parent in the tree
/// of elimination. Branches of the tree, and tiles of large fronts, are independent: threads take them as they come, and
/// results are the same bit for bit for any number.
class BlockCholesky {
 public:
  /// Orders the blocks. A: the upper triangle, 3N × 3N. Throws std::bad_alloc.
  explicit BlockCholesky(const SparseMatrix& A);

  /// False if A, of the same pattern, is not positive definite.
  bool factor(const SparseMatrix& A);

  /// d = A⁻¹ r; both N × 3.
  void solve(const Vectors& r, Vectors& d) const;

 private:
  using Panel = Eigen::Map<Eigen::MatrixXd>;
  using ConstPanel = Eigen::Map<const Eigen::MatrixXd>;

  /// Columns that are eliminated together. Blocks are numbered in the order of elimination, except where `order_` is.
  struct Front {
    int begin, blocks;                ///< its own
    int rows_begin, rows;             ///< in rows_: those of its panel, its own first
    std::int64_t panel;               ///< in values_: 3 rows × 3 blocks numbers, column by column
    std::int64_t update;              ///< in updates_: a square of 3 (rows − blocks), for the parent
    std::vector<int> children = {};   ///< ascending
    std::vector<int> in_parent = {};  ///< where the parent has the rows that are not its own
    int first = 0;                    ///< of its descendants, which precede it one after the other
    double work = 0;                  ///< multiplications, descendants included
  };

  void order(const SparseMatrix& A);
  std::vector<int> fronts_of_blocks() const;
  void plant();
  void find_places(const SparseMatrix& A);

  Panel update(const Front& front) {
    const int rest = 3 * (front.rows - front.blocks);
    return {updates_.data() + front.update, rest, rest};
  }
  Panel panel(const Front& front) { return {values_.data() + front.panel, 3 * front.rows, 3 * front.blocks}; }
  ConstPanel panel(const Front& front) const { return {values_.data() + front.panel, 3 * front.rows, 3 * front.blocks}; }

  void eliminate_branch(int front);
  void eliminate(int front);
  void add_update(const Front& child, const Front& parent, Panel& to_parents);

  std::vector<int> order_;  ///< the k-th block to be eliminated
  std::vector<Front> fronts_;
  std::vector<int> roots_;
  std::vector<int> rows_;
  std::vector<std::int64_t> places_;  ///< in values_, of A's values
  Eigen::VectorXd values_;
  Eigen::VectorXd updates_;
  std::atomic<bool> is_definite_ = true;
  mutable Eigen::VectorXd solution_, below_;
};

}  // namespace drape::solver
