#include "solver/linear/klu_factor.hpp"

#include <klu.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <utility>

#include "solver/linear/pattern_cache.hpp"

namespace drape::solver {
namespace {

/// Rows with the 64 bit indices of KLU's long interface.
using LongSparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, std::int64_t>;

}  // namespace

/// KLU's ordering.
class KluFactor::Symbolic {
 public:
  explicit Symbolic(const LongSparseMatrix& A) {
    klu_l_defaults(&common_);
    // KLU takes pointers to what it only reads.
    symbolic_ = klu_l_analyze(A.rows(), const_cast<std::int64_t*>(A.outerIndexPtr()),
                              const_cast<std::int64_t*>(A.innerIndexPtr()), &common_);
    if (symbolic_ == nullptr) throw std::bad_alloc();
  }
  ~Symbolic() { klu_l_free_symbolic(&symbolic_, &common_); }
  Symbolic(const Symbolic&) = delete;
  Symbolic& operator=(const Symbolic&) = delete;

  klu_l_symbolic* get() const { return symbolic_; }

 private:
  klu_l_common common_{};
  klu_l_symbolic* symbolic_ = nullptr;
};

/// KLU is given the transpose: our rows are its columns.
class KluFactor::Factors {
 public:
  explicit Factors(const LongSparseMatrix& A) : A_(A) {
    static PatternCache<Symbolic, std::int64_t> orderings;
    symbolic_ = orderings.of(A_, [&] { return std::make_shared<const Symbolic>(A_); });
    klu_l_defaults(&common_);
  }
  ~Factors() { klu_l_free_numeric(&numeric_, &common_); }
  Factors(const Factors&) = delete;
  Factors& operator=(const Factors&) = delete;

  template <class Matrix>
  bool have_pattern_of(const Matrix& A) const {
    return has_pattern<std::int64_t>(A, {A_.outerIndexPtr(), A_.outerIndexPtr() + A_.rows() + 1},
                                     {A_.innerIndexPtr(), A_.innerIndexPtr() + A_.nonZeros()});
  }

  /// Factors with the last pivots if these are still good.
  bool renew(const double* values) {
    std::copy_n(values, A_.nonZeros(), A_.valuePtr());
    if (numeric_ != nullptr && refactored()) return true;
    klu_l_free_numeric(&numeric_, &common_);
    numeric_ = klu_l_factor(A_.outerIndexPtr(), A_.innerIndexPtr(), A_.valuePtr(), symbolic_->get(), &common_);
    return numeric_ != nullptr;
  }

  void solve(double* b, Eigen::Index size) { klu_l_tsolve(symbolic_->get(), numeric_, size, 1, b, &common_); }

  std::int64_t bytes() const { return (numeric_->lnz + numeric_->unz) * (sizeof(double) + sizeof(std::int64_t)); }

 private:
  bool refactored() {
    const double singular = std::pow(std::numeric_limits<double>::epsilon(), 2.0 / 3);
    return klu_l_refactor(A_.outerIndexPtr(), A_.innerIndexPtr(), A_.valuePtr(), symbolic_->get(), numeric_, &common_) != 0 &&
           klu_l_rcond(symbolic_->get(), numeric_, &common_) != 0 && common_.rcond > singular;
  }

  LongSparseMatrix A_;
  std::shared_ptr<const Symbolic> symbolic_;
  klu_l_common common_{};
  klu_l_numeric* numeric_ = nullptr;
};

KluFactor::KluFactor(std::int64_t& analyses) : analyses_(analyses) {}
KluFactor::~KluFactor() = default;

template <class Index>
bool KluFactor::factor(const Eigen::SparseMatrix<double, Eigen::RowMajor, Index>& A) {
  if (!factors_ || !factors_->have_pattern_of(A)) {
    factors_ = std::make_unique<Factors>(A);
    ++analyses_;
  }
  return factors_->renew(A.valuePtr());
}
template bool KluFactor::factor(const SparseMatrix& A);
template bool KluFactor::factor(const LongSparseMatrix& A);

void KluFactor::solve(double* b, Eigen::Index size) { factors_->solve(b, size); }

std::int64_t KluFactor::bytes() const { return factors_->bytes(); }

}  // namespace drape::solver
