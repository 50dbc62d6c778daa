#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "model/forces/term.hpp"

namespace drape::model {

/// Adds the blocks of a configuration to the entries, always in the same order.
using VisitBlocks = std::function<void(const JacobianEntries& entries)>;

/// Blocks (i, j) in the order of a visit.
using Blocks = std::vector<Eigen::Vector2i>;

/// Records the blocks of a visit instead of adding them up.
JacobianEntries::Add recorder(Blocks& blocks);

/// Calls each(row, column, k) for the nine entries of a block, row by row.
template <class Each>
void for_entries(int i, int j, const Each& each) {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) each(3 * i + a, 3 * j + b, 3 * a + b);
}

/// Places of the blocks of every visit in a matrix whose pattern never changes.
class BlockSlots {
 public:
  /// `kept`: whether the matrix has an entry for (row, column).
  void find(const Blocks& blocks, const SparseMatrix& pattern, const std::function<bool(int row, int column)>& kept);

  /// Adds `weight` times each block of one visit to the values of the matrix, if its row particle is in [begin, end). Valid as
  /// long as the slots. Visits take a reference to it: a copy in a std::function would allocate.
  class Adder {
   public:
    Adder(const BlockSlots& slots, double* values, double weight, int begin = 0, int end = std::numeric_limits<int>::max())
        : begin_(begin), end_(end), values_(values), weight_(weight), slot_(slots.slots_.data()) {}
    void operator()(int i, int j, const Eigen::Matrix3d& block);
    void skip(int blocks) { slot_ += std::ptrdiff_t{9} * blocks; }

   private:
    int begin_, end_;
    double* values_;
    double weight_;
    const int* slot_;
  };

 private:
  std::vector<int> slots_;  ///< nine a block, -1 for entries that are not kept
};

}  // namespace drape::model
