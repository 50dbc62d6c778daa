#include "reference/sundials/klu_factor.hpp"

#include <klu.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

namespace drape::reference {

/// KLU is given the transpose: our rows are its columns.
class KluFactor::Factors {
 public:
  explicit Factors(const WideSparseMatrix& A) : A_(A) {
    klu_l_defaults(&common_);
    symbolic_ = klu_l_analyze(A_.rows(), A_.outerIndexPtr(), A_.innerIndexPtr(), &common_);
    if (symbolic_ == nullptr) throw std::bad_alloc();
  }
  ~Factors() {
    klu_l_free_numeric(&numeric_, &common_);
    klu_l_free_symbolic(&symbolic_, &common_);
  }
  Factors(const Factors&) = delete;
  Factors& operator=(const Factors&) = delete;

  bool have_pattern_of(const WideSparseMatrix& A) const {
    const auto n = A.rows(), entries = A.nonZeros();
    return A_.rows() == n && A_.nonZeros() == entries &&
           std::equal(A.outerIndexPtr(), A.outerIndexPtr() + n + 1, A_.outerIndexPtr()) &&
           std::equal(A.innerIndexPtr(), A.innerIndexPtr() + entries, A_.innerIndexPtr());
  }

  /// Factors with the last pivots if these are still good.
  bool renew(const WideSparseMatrix& A) {
    std::copy_n(A.valuePtr(), A.nonZeros(), A_.valuePtr());
    if (numeric_ != nullptr && refactored()) return true;
    klu_l_free_numeric(&numeric_, &common_);
    numeric_ = klu_l_factor(A_.outerIndexPtr(), A_.innerIndexPtr(), A_.valuePtr(), symbolic_, &common_);
    return numeric_ != nullptr;
  }

  void solve(Eigen::VectorXd& b) { klu_l_tsolve(symbolic_, numeric_, b.size(), 1, b.data(), &common_); }

 private:
  bool refactored() {
    const double singular = std::pow(std::numeric_limits<double>::epsilon(), 2.0 / 3);
    return klu_l_refactor(A_.outerIndexPtr(), A_.innerIndexPtr(), A_.valuePtr(), symbolic_, numeric_, &common_) != 0 &&
           klu_l_rcond(symbolic_, numeric_, &common_) != 0 && common_.rcond > singular;
  }

  WideSparseMatrix A_;
  klu_l_common common_{};
  klu_l_symbolic* symbolic_ = nullptr;
  klu_l_numeric* numeric_ = nullptr;
};

KluFactor::KluFactor(std::int64_t& analyses) : analyses_(analyses) {}
KluFactor::~KluFactor() = default;

bool KluFactor::factor(const WideSparseMatrix& A) {
  if (!factors_ || !factors_->have_pattern_of(A)) {
    factors_ = std::make_unique<Factors>(A);
    ++analyses_;
  }
  return factors_->renew(A);
}

void KluFactor::solve(Eigen::VectorXd& b) { factors_->solve(b); }

}  // namespace drape::reference
