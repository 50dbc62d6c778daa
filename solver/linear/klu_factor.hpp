#pragma once

#include <cstdint>
#include <memory>

#include "solver/state.hpp"

namespace drape::solver {

/// The exact factors of an unsymmetric sparse matrix by KLU, analysed again only when its pattern changes  [Davis,
/// Natarajan 2010].
class KluFactor {
 public:
  /// Counts analyses in `analyses`.
  explicit KluFactor(std::int64_t& analyses);
  ~KluFactor();
  KluFactor(const KluFactor&) = delete;
  KluFactor& operator=(const KluFactor&) = delete;

  /// False if the matrix is singular. Rows are compressed; indices have 32 or 64 bits.
  template <class Index>
  bool factor(const Eigen::SparseMatrix<double, Eigen::RowMajor, Index>& A);

  /// b = A⁻¹ b for `size` numbers.
  void solve(double* b, Eigen::Index size);
  void solve(Eigen::VectorXd& b) { solve(b.data(), b.size()); }

  /// Bytes of the factors.
  std::int64_t bytes() const;

 private:
  class Symbolic;
  class Factors;

  std::int64_t& analyses_;
  std::unique_ptr<Factors> factors_;
};

}  // namespace drape::solver
