#include "solver/linear/matrix_exponential.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace drape::solver {
namespace {

constexpr int taylor_degree = 16;

/// ‖A‖ up to which the terms beyond this degree are below round-off: θ^16/17! ≤ 2^-53 beside A.
constexpr double taylor_radius = 0.8;

constexpr std::array<double, taylor_degree + 1> taylor_coefficients() {
  std::array<double, taylor_degree + 1> c{1};
  for (int k = 1; k <= taylor_degree; ++k) c[k] = c[k - 1] / k;
  return c;
}

/// C = A B in slices that are so thin that Eigen's product takes its memory from the stack.
void multiply_dense(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::MatrixXd>& B,
                    Eigen::Ref<Eigen::MatrixXd> C) {
  constexpr Eigen::Index slice = 64;
  C.setZero();
  for (Eigen::Index k = 0; k < A.cols(); k += slice) {
    const Eigen::Index width = std::min(slice, A.cols() - k);
    C.noalias() += A.middleCols(k, width) * B.middleRows(k, width);
  }
}

}  // namespace

MatrixExponential::MatrixExponential(Eigen::Index most) : sum_(most, most), product_(most, most) {
  for (Eigen::MatrixXd& power : powers_) power.resize(most, most);
}

// With X = A⁴:  p(A) = q0 + X (q1 + X (q2 + X (q3 + c16 X))),   q_i = Σ_j c_{4i+j} A^j, j < 4   [Paterson, Stockmeyer 1973].
void MatrixExponential::compute(const Eigen::Ref<const Eigen::MatrixXd>& A) {
  static constexpr auto c = taylor_coefficients();
  const Eigen::Index n = n_ = A.rows();
  const double norm = A.cwiseAbs().colwise().sum().maxCoeff();
  const int squarings = norm > taylor_radius && std::isfinite(norm) ? int(std::ceil(std::log2(norm / taylor_radius))) : 0;
  const auto power = [&](int k) { return powers_[k - 1].topLeftCorner(n, n); };
  auto sum = sum_.topLeftCorner(n, n), product = product_.topLeftCorner(n, n);
  power(1) = std::ldexp(1.0, -squarings) * A;
  for (int k = 2; k <= 4; ++k) multiply_dense(power(1), power(k - 1), power(k));
  sum = c[taylor_degree] * power(4);
  for (int i = 3; i >= 0; --i) {
    sum += c[4 * i + 1] * power(1) + c[4 * i + 2] * power(2) + c[4 * i + 3] * power(3);
    sum.diagonal().array() += c[4 * i];
    if (i == 0) break;
    multiply_dense(power(4), sum, product);
    sum = product;
  }
  for (int k = 0; k < squarings; ++k) {
    multiply_dense(sum, sum, product);
    sum = product;
  }
}

}  // namespace drape::solver
