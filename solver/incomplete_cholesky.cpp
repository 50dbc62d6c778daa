#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "solver/kernels.hpp"
#include "solver/preconditioner.hpp"

namespace drape::solver {
namespace {

/// Rows of a triangular matrix with unit diagonal, stored in the order in which they are eliminated.
///
/// That order is by levels: a row comes after all it depends on, and rows of one level do not depend on each other, so
/// that a processor need not wait for one row before it begins the next. The result is that of the natural order.
struct Triangle {
  std::vector<int> row;
  std::vector<int> start;
  std::vector<int> column;
  std::vector<int> source;  ///< index of the entry in the values of the factor
  std::vector<double> value;

  void order(const std::vector<std::vector<std::pair<int, int>>>& rows, bool backward);
  void gather(const std::vector<double>& factor) {
    for (std::size_t k = 0; k < value.size(); ++k) value[k] = factor[source[k]];
  }
};

void Triangle::order(const std::vector<std::vector<std::pair<int, int>>>& rows, bool backward) {
  const int n = static_cast<int>(rows.size());
  std::vector<int> level(n, 0);
  for (int k = 0; k < n; ++k) {
    const int i = backward ? n - 1 - k : k;
    for (const auto& [j, index] : rows[i]) level[i] = std::max(level[i], level[j] + 1);
  }
  row.resize(n);
  std::iota(row.begin(), row.end(), 0);
  std::ranges::stable_sort(row, {}, [&](int i) { return level[i]; });
  start = {0};
  column.clear();
  source.clear();
  for (const int i : row) {
    for (const auto& [j, index] : rows[i]) {
      column.push_back(j);
      source.push_back(index);
    }
    start.push_back(static_cast<int>(column.size()));
  }
  value.resize(column.size());
}

/// A ≈ L D Lᵀ with unit triangular L whose entries lie where A has entries [Etzmuß 2002, 3.4.2].
class IncompleteCholesky : public Preconditioner {
 public:
  void analyze(const SparseMatrix& A) override;
  Outcome factor(const SparseMatrix& A) override;
  double apply(const Vectors& r, Vectors& z) override;
  std::int64_t bytes() const override {
    const auto entries = static_cast<std::int64_t>(forward_.value.size() + backward_.value.size());
    const auto n = static_cast<std::int64_t>(diagonal_.size());
    return entries * static_cast<std::int64_t>(sizeof(double) + sizeof(int)) + n * 8 + vector_bytes(n, 5);
  }

 private:
  double product(int i, int j) const;

  std::vector<int> start_, column_;  // the strictly lower rows of A
  std::vector<double> lower_;        // L
  std::vector<double> diagonal_;     // D
  std::vector<double> inverse_;      // D⁻¹
  Triangle forward_, backward_;
  std::vector<Lanes> work_;  // four lanes a particle, so that what is stored is what is loaded
};

void IncompleteCholesky::analyze(const SparseMatrix& A) {
  const int n = static_cast<int>(A.rows());
  std::vector<std::vector<std::pair<int, int>>> rows(n), columns(n);
  start_ = {0};
  column_.clear();
  for (int i = 0; i < n; ++i) {
    for (SparseMatrix::InnerIterator a(A, i); a && a.col() < i; ++a) {
      const int index = static_cast<int>(column_.size());
      rows[i].emplace_back(a.col(), index);
      columns[a.col()].emplace_back(i, index);
      column_.push_back(static_cast<int>(a.col()));
    }
    start_.push_back(static_cast<int>(column_.size()));
  }
  lower_.resize(column_.size());
  diagonal_.resize(n);
  inverse_.resize(n);
  work_.assign(n, Lanes::Zero());
  forward_.order(rows, false);
  backward_.order(columns, true);
}

/// Σ_k<j L_ik D_k L_jk over the common entries of rows i and j.
double IncompleteCholesky::product(int i, int j) const {
  double s = 0;
  for (int p = start_[i], q = start_[j]; p < start_[i + 1] && q < start_[j + 1];) {
    if (column_[p] < column_[q]) {
      ++p;
    } else if (column_[q] < column_[p]) {
      ++q;
    } else {
      if (column_[p] >= j) break;
      s += lower_[p++] * diagonal_[column_[q]] * lower_[q];
      ++q;
    }
  }
  return s;
}

Outcome IncompleteCholesky::factor(const SparseMatrix& A) {
  for (int i = 0, n = static_cast<int>(A.rows()); i < n; ++i) {
    SparseMatrix::InnerIterator a(A, i);
    double d = 0;
    for (int k = start_[i]; k < start_[i + 1]; ++k, ++a) {
      const int j = column_[k];
      lower_[k] = (a.value() - product(i, j)) * inverse_[j];
      d += lower_[k] * lower_[k] * diagonal_[j];
    }
    diagonal_[i] = a.value() - d;
    if (!std::isfinite(diagonal_[i])) return Outcome::not_finite;
    if (diagonal_[i] <= 0) return Outcome::breakdown;
    inverse_[i] = 1 / diagonal_[i];
  }
  forward_.gather(lower_);
  backward_.gather(lower_);
  return Outcome::success;
}

/// Solves the triangle in its order: w_i = begin(i) − Σ_j T_ij w_j, and end(i, w_i) for each.
template <class Begin, class End>
void eliminate(const Triangle& T, std::vector<Lanes>& work, const Begin& begin, const End& end) {
  const int n = static_cast<int>(T.row.size());
  const int *const row = T.row.data(), *const start = T.start.data(), *const column = T.column.data();
  const double* const value = T.value.data();
  Lanes* const w = work.data();
  for (int k = 0, e = 0; k < n; ++k) {
    const int i = row[k];
    Lanes s = begin(i);
    for (const int last = start[k + 1]; e < last; ++e) s -= value[e] * w[column[e]];
    w[i] = s;
    end(i, s);
  }
}

double IncompleteCholesky::apply(const Vectors& r, Vectors& z) {
  const auto last = r.rows() - 1;
  Lanes last_row = Lanes::Zero();  // four lanes of it would read past the end
  last_row.head<3>() = r.row(last).transpose();
  const auto residual = [&](Eigen::Index i) -> Lanes { return i < last ? Lanes(load(r.data() + 3 * i)) : last_row; };

  eliminate(forward_, work_, residual, [](int, const Lanes&) {});
  Lanes rz = Lanes::Zero();
  eliminate(
      backward_, work_, [&](int i) -> Lanes { return work_[i] * inverse_[i]; },
      [&](int i, const Lanes& s) {
        store(z.data() + 3 * static_cast<Eigen::Index>(i), s);
        rz += s * residual(i);
      });
  return sum(rz);
}

}  // namespace

std::unique_ptr<Preconditioner> make_incomplete_cholesky() { return std::make_unique<IncompleteCholesky>(); }

}  // namespace drape::solver
