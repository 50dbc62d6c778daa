#pragma once

#include <cstdint>
#include <vector>

#include "solver/linear/kernels.hpp"

namespace drape::solver {

/// Rows of a triangular matrix with unit diagonal, stored in the order in which they are eliminated.
struct Triangle {
  std::vector<int> row;
  std::vector<int> start{0};  ///< of each row's entries
  std::vector<int> column;
  std::vector<double> value;

  /// Bytes that an elimination reads.
  std::int64_t bytes() const {
    return static_cast<std::int64_t>(value.size() * (sizeof(double) + sizeof(int)) + row.size() * 2 * sizeof(int));
  }
};

/// Solves the triangle in its order: w_i = begin(i) − Σ_j T_ij w_j, and end(i, w_i) for each. `work`: w, four lanes a particle,
/// so that loads match stores.
template <class Begin, class End>
void eliminate(const Triangle& T, std::vector<Lanes>& work, const Begin& begin, const End& end) {
  const int n = static_cast<int>(T.row.size());
  const int *const row = T.row.data(), *const start = T.start.data(), *const column = T.column.data();
  const double* const value = T.value.data();
  Lanes* const w = work.data();
  for (int k = 0, e = 0; k < n; ++k) {
    const int i = row[k];
    Lanes s = begin(i), other = Lanes::Zero();
    const int last = start[k + 1];
    for (; e + 1 < last; e += 2) {
      other += value[e] * w[column[e]];
      s -= value[e + 1] * w[column[e + 1]];
    }
    if (e < last) {
      s -= value[e] * w[column[e]];
      ++e;
    }
    s -= other;
    w[i] = s;
    end(i, s);
  }
}

/// Rows of a vector field as lanes.
class LaneRows {
 public:
  explicit LaneRows(const Vectors& r) : data_(r.data()), last_(r.rows() - 1) { last_row_.head<3>() = r.row(last_).transpose(); }

  Lanes operator[](Eigen::Index i) const { return i < last_ ? Lanes(load(data_ + 3 * i)) : last_row_; }

 private:
  const double* data_;
  Eigen::Index last_;
  Lanes last_row_ = Lanes::Zero();  // four lanes of it would read past the end
};

}  // namespace drape::solver
