#pragma once

#include <cstddef>
#include <tuple>
#include <vector>

#include "solver/linear/kernels.hpp"

namespace drape::model {

/// A sparse N × N matrix by its different rows: those of a uniform sheet are alike except on borders, so that they stay in a
/// near cache however large the sheet is.
class StencilMatrix {
 public:
  explicit StencilMatrix(const solver::SparseMatrix& matrix);

  bool empty() const { return entries_.empty(); }

  /// Row i times x, N × 3; the fourth lane means nothing.
  solver::Lanes times(int i, const solver::Vectors& x) const {
    const double* const own = x.data() + 3 * static_cast<std::ptrdiff_t>(i);
    solver::Lanes sum = solver::Lanes::Zero();
    for (int k = begin_[stencil_[i]]; k < begin_[stencil_[i] + 1]; ++k)
      sum += entries_[k].value * lanes(own + 3 * static_cast<std::ptrdiff_t>(entries_[k].offset), i + entries_[k].offset);
    return sum;
  }

  /// y = B x; both N × 3.
  void multiply(const solver::Vectors& x, solver::Vectors& y) const;

 private:
  struct Entry {
    int offset;  ///< column less row
    double value;
    bool operator<(const Entry& other) const { return std::tie(offset, value) < std::tie(other.offset, other.value); }
  };

  /// Four lanes of the last particle would read past the end.
  solver::Lanes lanes(const double* p, int particle) const {
    if (particle < last_) [[likely]]
      return solver::load(p);
    return {p[0], p[1], p[2], 0};
  }

  int last_;
  std::vector<int> stencil_;  ///< of each row
  std::vector<int> begin_;    ///< in entries_, of each stencil and the end
  std::vector<Entry> entries_;
};

}  // namespace drape::model
