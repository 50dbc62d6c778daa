#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "solver/preconditioner.hpp"
#include "solver/triangle.hpp"

namespace drape::solver {
namespace {

/// A triangle of the factor, ordered by levels: a row comes after all it depends on, and rows of one level do not depend on
/// each other, so that a processor need not wait for one row before it begins the next. The result is that of the natural
/// order.
struct LeveledTriangle : Triangle {
  std::vector<int> source;  ///< index of the entry in the values of the factor

  void order(const std::vector<std::vector<std::pair<int, int>>>& rows, bool backward);
  void gather(const std::vector<double>& factor) {
    for (std::size_t k = 0; k < value.size(); ++k) value[k] = factor[source[k]];
  }
};

void LeveledTriangle::order(const std::vector<std::vector<std::pair<int, int>>>& rows, bool backward) {
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
    const auto n = static_cast<std::int64_t>(diagonal_.size());
    return forward_.bytes() + backward_.bytes() + n * static_cast<std::int64_t>(2 * sizeof(double)) + vector_bytes(n, 5);
  }

 private:
  double product(int i, int j) const;

  std::vector<int> start_, column_;  // the strictly lower rows of A
  std::vector<double> lower_;        // L
  std::vector<double> diagonal_;     // D
  std::vector<double> inverse_;      // D⁻¹
  LeveledTriangle forward_, backward_;
  std::vector<Lanes> work_;
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

double IncompleteCholesky::apply(const Vectors& r, Vectors& z) {
  const LaneRows residual(r);
  Lanes rz = Lanes::Zero();  // <r, z> = <w, D⁻¹ w> half way
  eliminate(
      forward_, work_, [&](int i) { return residual[i]; }, [&](int i, const Lanes& w) { rz += inverse_[i] * w.square(); });
  eliminate(
      backward_, work_, [&](int i) -> Lanes { return work_[i] * inverse_[i]; },
      [&](int i, const Lanes& w) { store(z.data() + 3 * static_cast<Eigen::Index>(i), w); });
  return sum(rz);
}

}  // namespace

std::unique_ptr<Preconditioner> make_incomplete_cholesky() { return std::make_unique<IncompleteCholesky>(); }

}  // namespace drape::solver
