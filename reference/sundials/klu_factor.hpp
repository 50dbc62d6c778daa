#pragma once

#include <memory>

#include "reference/sundials/coordinates.hpp"

namespace drape::reference {

/// The exact factors of an unsymmetric sparse matrix by KLU, analysed again only when its pattern changes  [Davis,
/// Natarajan 2010].
class KluFactor {
 public:
  /// Counts analyses in `analyses`.
  explicit KluFactor(std::int64_t& analyses);
  ~KluFactor();
  KluFactor(const KluFactor&) = delete;
  KluFactor& operator=(const KluFactor&) = delete;

  /// False if the matrix is singular. Rows are compressed.
  bool factor(const WideSparseMatrix& A);

  /// b = A⁻¹ b.
  void solve(Eigen::VectorXd& b);

 private:
  class Factors;

  std::int64_t& analyses_;
  std::unique_ptr<Factors> factors_;
};

}  // namespace drape::reference
