#include "solver/linear/kernels.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "solver/base/threads.hpp"

namespace drape::solver {
namespace {

Eigen::Array3d row_product(const SparseMatrix& A, const Vectors& x, int row) {
  Eigen::Array3d s = Eigen::Array3d::Zero();
  for (SparseMatrix::InnerIterator a(A, row); a; ++a) s += a.value() * x.row(a.col()).transpose().array();
  return s;
}

/// The coordinates [begin, end) of x += a p, r −= a q and <r, r>.
double advance(double a, const Vectors& p, const Vectors& q, Vectors& x, Vectors& r, Eigen::Index begin, Eigen::Index end) {
  using Block = Eigen::Array<double, 8, 1>;
  const Eigen::Index whole = end - (end - begin) % 8;
  Block squares = Block::Zero();
  for (Eigen::Index k = begin; k < whole; k += 8) {
    Block::Map(x.data() + k) += a * Block::Map(p.data() + k);
    const Block residual = Block::Map(r.data() + k) - a * Block::Map(q.data() + k);
    Block::Map(r.data() + k) = residual;
    squares += residual.square();
  }
  double rr = squares.sum();
  for (Eigen::Index k = whole; k < end; ++k) {
    x.data()[k] += a * p.data()[k];
    r.data()[k] -= a * q.data()[k];
    rr += r.data()[k] * r.data()[k];
  }
  return rr;
}

}  // namespace

double multiply(const SparseMatrix& A, const Vectors& x, Vectors& y) {
  const int n = static_cast<int>(A.rows());
  const int* const start = A.outerIndexPtr();
  const int* const column = A.innerIndexPtr();
  const double* const a = A.valuePtr();
  double xy = 0;
  Lanes lanes = Lanes::Zero();
  for (int i = 0, k = 0; i < n; ++i) {
    const int end = start[i + 1];
    // Four lanes of the last particle would read past the end.
    if (i == n - 1 || (end > k && column[end - 1] == n - 1)) [[unlikely]] {
      const Eigen::Array3d s = row_product(A, x, i);
      y.row(i) = s;
      xy += (s * x.row(i).transpose().array()).sum();
      k = end;
      continue;
    }
    Lanes s = Lanes::Zero();
    for (; k < end; ++k) s += a[k] * load(x.data() + 3 * column[k]);
    lanes += s * load(x.data() + 3 * i);
    Eigen::Map<Lanes>(y.data() + 3 * i) = s;  // the fourth lane is overwritten by the next row
  }
  return xy + sum(lanes);
}

double advance(double a, const Vectors& p, const Vectors& q, Vectors& x, Vectors& r) {
  constexpr Eigen::Index block = 32768;  // coordinates whose squares are added up apart, so that threads do not change the sum
  const Eigen::Index blocks = (x.size() + block - 1) / block;
  if (blocks <= 1) return advance(a, p, q, x, r, 0, x.size());
  std::vector<double> squares(blocks);
  base::each_in_parts(base::threads_for(x.rows()), blocks, [&](Eigen::Index k) {
    squares[k] = advance(a, p, q, x, r, block * k, std::min(block * (k + 1), x.size()));
  });
  return std::accumulate(squares.begin(), squares.end(), 0.0);
}

std::int64_t multiply_bytes(const SparseMatrix& A) {
  return A.nonZeros() * static_cast<std::int64_t>(sizeof(double) + sizeof(int)) + vector_bytes(A.rows(), 2);
}

}  // namespace drape::solver
