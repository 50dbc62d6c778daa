#include <memory>
#include <new>
#include <numeric>
#include <vector>

#include "solver/linear/cholmod_view.hpp"
#include "solver/linear/pattern_cache.hpp"
#include "solver/linear/preconditioner.hpp"
#include "solver/linear/triangle.hpp"

namespace drape::solver {
namespace {

/// CHOLMOD's settings and memory.
///
/// Simplicial: the matrices of sheets up to some 300 × 300 are too sparse for supernodes to pay. Nested dissection would fill
/// 5 % less at 100 × 100 and takes 10 times as long to order.
class Cholmod {
 public:
  Cholmod() {
    cholmod_start(&common_);
    common_.supernodal = CHOLMOD_SIMPLICIAL;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_AMD;
    common_.final_ll = 1;  // so that a matrix that is not positive definite is reported
    common_.print = 0;     // outcomes are returned, not printed
  }
  ~Cholmod() {
    cholmod_free_factor(&factor, &common_);
    cholmod_finish(&common_);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  cholmod_common* common() { return &common_; }

  cholmod_factor* factor = nullptr;

 private:
  cholmod_common common_{};
};

/// The ordering, and how many entries columns have.
std::shared_ptr<const Cholmod> analysis(const SparseMatrix& A) {
  auto result = std::make_shared<Cholmod>();
  cholmod_sparse view = cholmod_view(A);
  result->factor = cholmod_analyze(&view, result->common());
  if (result->factor == nullptr) throw std::bad_alloc();
  return result;
}

PatternCache<Cholmod> analyses;

/// The complete factor P A Pᵀ = L D Lᵀ: CHOLMOD orders and factors, the substitutions are our own.
///
/// Both substitutions gather from rows in their own order, so L is stored twice; they process three coordinates at a time. They
/// take a third to half the time of CHOLMOD's, which copies and permutes.
class Cholesky : public Preconditioner {
 public:
  void analyse(const SparseMatrix& A) override {
    const std::shared_ptr<const Cholmod> known = analyses.of(A, [&] { return analysis(A); });
    cholmod_free_factor(&own_.factor, own_.common());
    own_.factor = cholmod_copy_factor(known->factor, own_.common());
    if (own_.factor == nullptr) throw std::bad_alloc();
    inverse_.resize(A.rows());
    work_.assign(A.rows(), Lanes::Zero());
    forward_.row.resize(A.rows());
    std::iota(forward_.row.begin(), forward_.row.end(), 0);
    backward_.row.assign(forward_.row.rbegin(), forward_.row.rend());
  }

  Outcome factor(const SparseMatrix& A) override {
    cholmod_sparse view = cholmod_view(A);
    cholmod_factorize(&view, own_.factor, own_.common());
    if (own_.common()->status != CHOLMOD_OK) return Outcome::breakdown;
    take_factor();
    return Outcome::success;
  }

  double apply(const Vectors& r, Vectors& z) override {
    const LaneRows residual(r);
    const int* const permuted = static_cast<int*>(own_.factor->Perm);
    Lanes rz = Lanes::Zero();  // <r, z> = <w, D⁻¹ w> half way
    eliminate(
        forward_, work_, [&](int i) { return residual[permuted[i]]; },
        [&](int i, const Lanes& w) { rz += inverse_[i] * w.square(); });
    eliminate(
        backward_, work_, [&](int i) -> Lanes { return work_[i] * inverse_[i]; },
        [&](int i, const Lanes& w) { store(z.data() + 3 * static_cast<Eigen::Index>(permuted[i]), w); });
    return sum(rz);
  }

  bool exact() const override { return true; }
  std::string_view name() const override { return "cholesky"; }

  std::int64_t bytes() const override {
    const auto n = static_cast<std::int64_t>(inverse_.size());
    return forward_.bytes() + backward_.bytes() + n * (2 * sizeof(double) + 2 * sizeof(int)) + vector_bytes(n, 5);
  }

 private:
  void take_factor();

  Cholmod own_;
  Triangle forward_, backward_;  // L with unit diagonal and its transpose
  std::vector<double> inverse_;  // D⁻¹
  std::vector<Lanes> work_;
};

/// Takes CHOLMOD's columns of G = L √D apart. Within a row the most recently computed unknowns come last, to avoid stalls.
void Cholesky::take_factor() {
  const int n = static_cast<int>(own_.factor->n);
  const int *const begin = static_cast<int*>(own_.factor->p), *const count = static_cast<int*>(own_.factor->nz);
  const int* const row = static_cast<int*>(own_.factor->i);
  const double* const G = static_cast<double*>(own_.factor->x);  // the diagonal first in each column

  forward_.start.assign(n + 1, 0);
  for (int j = 0; j < n; ++j)
    for (int k = begin[j] + 1; k < begin[j] + count[j]; ++k) ++forward_.start[row[k] + 1];
  std::partial_sum(forward_.start.begin(), forward_.start.end(), forward_.start.begin());
  backward_.start.assign(1, 0);
  for (Triangle* T : {&forward_, &backward_}) {
    T->column.resize(forward_.start[n]);
    T->value.resize(forward_.start[n]);
  }

  std::vector<int> free(forward_.start.begin(), forward_.start.end() - 1);
  for (int j = 0; j < n; ++j) {
    inverse_[j] = 1 / (G[begin[j]] * G[begin[j]]);
    for (int k = begin[j] + 1; k < begin[j] + count[j]; ++k) {
      forward_.column[free[row[k]]] = j;
      forward_.value[free[row[k]]++] = G[k] / G[begin[j]];
    }
  }
  for (int j = n - 1, e = 0; j >= 0; --j) {
    for (int k = begin[j] + count[j] - 1; k > begin[j]; --k, ++e) {
      backward_.column[e] = row[k];
      backward_.value[e] = G[k] / G[begin[j]];
    }
    backward_.start.push_back(e);
  }
}

}  // namespace

std::unique_ptr<Preconditioner> make_cholesky() { return std::make_unique<Cholesky>(); }

}  // namespace drape::solver
