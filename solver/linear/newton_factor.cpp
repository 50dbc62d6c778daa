#include "solver/linear/newton_factor.hpp"

#include <new>

#include "solver/linear/cholmod_view.hpp"

namespace drape::solver {

/// Simplicial: with Debian's reference BLAS supernodes take 1.8 times as long, from 20 x 20 to 100 x 100 particles.
class NewtonFactor::Factor {
 public:
  explicit Factor(const SparseMatrix& J) {
    cholmod_start(&common_);
    common_.final_ll = 1;  // so that a matrix that is not positive definite is reported
    common_.supernodal = CHOLMOD_SIMPLICIAL;
    common_.print = 0;  // outcomes are returned, not printed
    cholmod_sparse view = cholmod_view(J);
    factor_ = cholmod_analyze(&view, &common_);
    right_ = cholmod_zeros(J.rows(), 1, CHOLMOD_REAL, &common_);
    if (factor_ == nullptr || right_ == nullptr) throw std::bad_alloc();
  }
  ~Factor() {
    cholmod_free_factor(&factor_, &common_);
    for (cholmod_dense** dense : {&right_, &solution_, &work_y_, &work_e_}) cholmod_free_dense(dense, &common_);
    cholmod_finish(&common_);
  }
  Factor(const Factor&) = delete;
  Factor& operator=(const Factor&) = delete;

  Outcome renew(const SparseMatrix& J) {
    cholmod_sparse view = cholmod_view(J);
    cholmod_factorize(&view, factor_, &common_);
    return common_.status == CHOLMOD_OK ? Outcome::success : Outcome::breakdown;
  }

  void solve(const Vectors& r, Vectors& d) {
    Eigen::Map<Vectors>(static_cast<double*>(right_->x), r.rows(), 3) = r;
    cholmod_solve2(CHOLMOD_A, factor_, right_, nullptr, &solution_, nullptr, &work_y_, &work_e_, &common_);
    d = Eigen::Map<const Vectors>(static_cast<const double*>(solution_->x), r.rows(), 3);
  }

 private:
  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  cholmod_dense* right_ = nullptr;
  cholmod_dense* solution_ = nullptr;
  cholmod_dense* work_y_ = nullptr;
  cholmod_dense* work_e_ = nullptr;
};

NewtonFactor::NewtonFactor(Counters& work)
    : factorisations_(work.counter("newton_factorisations", "complete factorisations of a Newton matrix")) {}
NewtonFactor::~NewtonFactor() = default;

Outcome NewtonFactor::factor(const SparseMatrix& J) {
  ++factorisations_;
  if (!factor_) factor_ = std::make_unique<Factor>(J);
  return factor_->renew(J);
}

void NewtonFactor::solve(const Vectors& r, Vectors& d) { factor_->solve(r, d); }

}  // namespace drape::solver
