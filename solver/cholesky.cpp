#include <cholmod.h>

#include <new>

#include "solver/kernels.hpp"
#include "solver/preconditioner.hpp"

namespace drape::solver {
namespace {

/// The complete factor A = L Lᵀ by CHOLMOD. Simplicial: the matrices of sheets up to some 300 × 300 are too sparse for
/// supernodes to pay.
class Cholesky : public Preconditioner {
 public:
  Cholesky() {
    cholmod_start(&common_);
    common_.supernodal = CHOLMOD_SIMPLICIAL;
    common_.final_ll = 1;  // so that a matrix that is not positive definite is noticed
    common_.print = 0;     // outcomes are returned, not printed
  }
  ~Cholesky() override {
    release();
    cholmod_finish(&common_);
  }
  Cholesky(const Cholesky&) = delete;
  Cholesky& operator=(const Cholesky&) = delete;

  void analyze(const SparseMatrix& A) override {
    release();
    cholmod_sparse view = lower(A);
    factor_ = cholmod_analyze(&view, &common_);
    right_ = cholmod_zeros(A.rows(), columns, CHOLMOD_REAL, &common_);
    if (factor_ == nullptr || right_ == nullptr) throw std::bad_alloc();
  }

  Outcome factor(const SparseMatrix& A) override {
    cholmod_sparse view = lower(A);
    cholmod_factorize(&view, factor_, &common_);
    return common_.status == CHOLMOD_OK ? Outcome::success : Outcome::breakdown;
  }

  double apply(const Vectors& r, Vectors& z) override {
    const auto n = r.rows();
    using Columns = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 3>>;
    Columns(static_cast<double*>(right_->x), n, 3) = r;
    cholmod_solve2(CHOLMOD_A, factor_, right_, nullptr, &solution_, nullptr, &work_y_, &work_e_, &common_);
    z = Columns(static_cast<double*>(solution_->x), n, 3);
    return r.cwiseProduct(z).sum();
  }

  std::int64_t bytes() const override {
    const auto entries = static_cast<std::int64_t>(common_.lnz);
    return 2 * entries * static_cast<std::int64_t>(sizeof(double) + sizeof(int)) +
           vector_bytes(static_cast<std::int64_t>(right_->nrow), 8);
  }

 private:
  /// CHOLMOD solves four at a time and shrinks its workspace for fewer, to allocate it anew the next time: the fourth is 0.
  static constexpr std::size_t columns = 4;

  /// The matrix as CHOLMOD sees it: our rows are its columns, so the upper half of the one is the lower half of the other.
  static cholmod_sparse lower(const SparseMatrix& A) {
    cholmod_sparse view{};
    view.nrow = view.ncol = static_cast<std::size_t>(A.rows());
    view.nzmax = static_cast<std::size_t>(A.nonZeros());
    view.p = const_cast<int*>(A.outerIndexPtr());
    view.i = const_cast<int*>(A.innerIndexPtr());
    view.x = const_cast<double*>(A.valuePtr());
    view.stype = -1;
    view.itype = CHOLMOD_INT;
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = 1;
    view.packed = 1;
    return view;
  }

  void release() {
    cholmod_free_factor(&factor_, &common_);
    for (cholmod_dense** dense : {&right_, &solution_, &work_y_, &work_e_}) cholmod_free_dense(dense, &common_);
  }

  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  cholmod_dense* right_ = nullptr;
  cholmod_dense* solution_ = nullptr;
  cholmod_dense* work_y_ = nullptr;
  cholmod_dense* work_e_ = nullptr;
};

}  // namespace

std::unique_ptr<Preconditioner> make_cholesky() { return std::make_unique<Cholesky>(); }

}  // namespace drape::solver
