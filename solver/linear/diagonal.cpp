#include <cmath>

#include "solver/linear/kernels.hpp"
#include "solver/linear/preconditioner.hpp"

namespace drape::solver {
namespace {

/// `breakdown` if an entry of the diagonal shows that a matrix is not positive definite.
Outcome check_diagonal(const Eigen::VectorXd& diagonal) {
  if (!diagonal.allFinite()) return Outcome::not_finite;
  return (diagonal.array() > 0).all() ? Outcome::success : Outcome::breakdown;
}

/// No preconditioner: z = r.
class Identity : public Preconditioner {
 public:
  void analyse(const SparseMatrix& A) override { particles_ = A.rows(); }
  Outcome factor(const SparseMatrix& A) override { return check_diagonal(A.diagonal()); }

  double apply(const Vectors& r, Vectors& z) override {
    z = r;
    return r.squaredNorm();
  }

  std::string_view name() const override { return "cg"; }
  std::int64_t bytes() const override { return vector_bytes(particles_, 2); }

 private:
  Eigen::Index particles_ = 0;
};

/// z = r over the diagonal of A.
class Jacobi : public Preconditioner {
 public:
  void analyse(const SparseMatrix& A) override { inverse_.resize(A.rows()); }

  Outcome factor(const SparseMatrix& A) override {
    inverse_ = A.diagonal();
    const Outcome outcome = check_diagonal(inverse_);
    if (outcome == Outcome::success) inverse_ = inverse_.cwiseInverse();
    return outcome;
  }

  double apply(const Vectors& r, Vectors& z) override {
    z = r.array().colwise() * inverse_.array();
    return r.cwiseProduct(z).sum();
  }

  std::string_view name() const override { return "jacobi"; }
  std::int64_t bytes() const override {
    return vector_bytes(inverse_.size(), 2) + inverse_.size() * static_cast<std::int64_t>(sizeof(double));
  }

 private:
  Eigen::VectorXd inverse_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_unpreconditioned() { return std::make_unique<Identity>(); }

std::unique_ptr<Preconditioner> make_jacobi() { return std::make_unique<Jacobi>(); }

}  // namespace drape::solver
