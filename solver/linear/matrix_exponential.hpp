#pragma once

#include <Eigen/Dense>

namespace drape::solver {

/// exp(A) of small dense matrices, by scaling and squaring of Taylor's polynomial   [Al-Mohy, Higham 2009]: of the norms below
/// 1e4 that steps have, to about twelve digits. Only the constructor allocates.
class MatrixExponential {
 public:
  /// For at most `most` rows.
  explicit MatrixExponential(Eigen::Index most);

  /// Computes exp(A), n × n with n ≤ `most`. Not finite if A is not.
  void compute(const Eigen::Ref<const Eigen::MatrixXd>& A);

  /// The last result.
  auto result() const { return sum_.topLeftCorner(n_, n_); }

 private:
  Eigen::MatrixXd powers_[4];  ///< A, A², A³, A⁴
  Eigen::MatrixXd sum_, product_;
  Eigen::Index n_ = 0;
};

}  // namespace drape::solver
