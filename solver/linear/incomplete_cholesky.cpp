#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "solver/linear/preconditioner.hpp"
#include "solver/linear/triangle.hpp"

namespace drape::solver {
namespace {

/// A triangle of the factor, ordered by levels: a row comes after all it depends on, and rows of one level do not depend on
/// each other, so that the processor need not wait for one row before it begins the next. The result equals that of the natural
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
///
/// Fill outside of them is dropped, and ω times it is subtracted from the diagonals of its row and its column. With ω = 1 the
/// factor has the row sums of A [Gustafsson 1978]: it treats smooth fields, which slow conjugate gradients on fine sheets,
/// almost exactly. ω a little below 1 keeps the pivots away from 0.
class IncompleteCholesky : public Preconditioner {
 public:
  explicit IncompleteCholesky(double omega) : omega_(omega) {}

  void analyse(const SparseMatrix& A) override;
  Outcome factor(const SparseMatrix& A) override;
  double apply(const Vectors& r, Vectors& z) override;
  std::string_view name() const override { return omega_ == 0 ? "ic0" : "mic0"; }
  std::int64_t bytes() const override {
    const auto n = static_cast<std::int64_t>(diagonal_.size());
    return forward_.bytes() + backward_.bytes() + n * static_cast<std::int64_t>(2 * sizeof(double)) + vector_bytes(n, 5);
  }

 private:
  Outcome factor(const SparseMatrix& A, double omega);
  void eliminate_column(int k, double omega);

  const double omega_;
  std::vector<int> start_, column_;                        // the strictly lower rows of A
  std::vector<std::vector<std::pair<int, int>>> columns_;  // its columns: row, and index in `column_`
  std::vector<double> lower_;                              // L
  std::vector<double> diagonal_;                           // D
  std::vector<double> inverse_;                            // D⁻¹
  LeveledTriangle forward_, backward_;
  std::vector<Lanes> work_;
};

void IncompleteCholesky::analyse(const SparseMatrix& A) {
  const int n = static_cast<int>(A.rows());
  std::vector<std::vector<std::pair<int, int>>> rows(n);
  columns_.assign(n, {});
  start_ = {0};
  column_.clear();
  for (int i = 0; i < n; ++i) {
    for (SparseMatrix::InnerIterator a(A, i); a && a.col() < i; ++a) {
      const int index = static_cast<int>(column_.size());
      rows[i].emplace_back(a.col(), index);
      columns_[a.col()].emplace_back(i, index);
      column_.push_back(static_cast<int>(a.col()));
    }
    start_.push_back(static_cast<int>(column_.size()));
  }
  lower_.resize(column_.size());
  diagonal_.resize(n);
  inverse_.resize(n);
  work_.assign(n, Lanes::Zero());
  forward_.order(rows, false);
  backward_.order(columns_, true);
}

/// Subtracts L_ik D_k L_jk from all entries (i, j) below and right of column k.
void IncompleteCholesky::eliminate_column(int k, double omega) {
  const auto& below = columns_[k];
  for (auto entry = below.begin(); entry != below.end(); ++entry) {
    const auto [i, index] = *entry;
    lower_[index] *= inverse_[k];
    diagonal_[i] -= lower_[index] * lower_[index] * diagonal_[k];
    const auto row = column_.begin() + start_[i], row_end = column_.begin() + start_[i + 1];
    for (auto above = below.begin(); above != entry; ++above) {
      const auto [j, index_j] = *above;
      const double fill = lower_[index] * diagonal_[k] * lower_[index_j];
      if (const auto found = std::lower_bound(row, row_end, j); found != row_end && *found == j) {
        lower_[found - column_.begin()] -= fill;
      } else {
        diagonal_[i] -= omega * fill;
        diagonal_[j] -= omega * fill;
      }
    }
  }
}

Outcome IncompleteCholesky::factor(const SparseMatrix& A, double omega) {
  const int n = static_cast<int>(A.rows());
  for (int i = 0; i < n; ++i) {
    SparseMatrix::InnerIterator a(A, i);
    for (int k = start_[i]; k < start_[i + 1]; ++k, ++a) lower_[k] = a.value();
    diagonal_[i] = a.value();
  }
  for (int k = 0; k < n; ++k) {
    if (!std::isfinite(diagonal_[k])) return Outcome::not_finite;
    if (diagonal_[k] <= 0) return Outcome::breakdown;
    inverse_[k] = 1 / diagonal_[k];
    eliminate_column(k, omega);
  }
  return Outcome::success;
}

/// Where entries have both signs, a factor with these row sums may not be positive; ω = 0 is more robust.
Outcome IncompleteCholesky::factor(const SparseMatrix& A) {
  Outcome outcome = factor(A, omega_);
  if (outcome == Outcome::breakdown && omega_ != 0) outcome = factor(A, 0);
  if (outcome != Outcome::success) return outcome;
  forward_.gather(lower_);
  backward_.gather(lower_);
  return outcome;
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

std::unique_ptr<Preconditioner> make_incomplete_cholesky() { return std::make_unique<IncompleteCholesky>(0); }

std::unique_ptr<Preconditioner> make_modified_incomplete_cholesky() { return std::make_unique<IncompleteCholesky>(0.999); }

}  // namespace drape::solver
