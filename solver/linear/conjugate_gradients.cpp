#include "solver/linear/conjugate_gradients.hpp"

#include <cmath>
#include <utility>

#include "solver/linear/kernels.hpp"

namespace drape::solver {

ConjugateGradients::ConjugateGradients(std::unique_ptr<Preconditioner> preconditioner, int max_iterations, Counters& work)
    : preconditioner_(std::move(preconditioner)), max_iterations_(max_iterations), work_(work) {}

void ConjugateGradients::analyse(const SparseMatrix& A) {
  preconditioner_->analyse(A);
  for (Vectors* field : {&z_, &p_, &q_}) field->setZero(A.rows(), 3);
}

Outcome ConjugateGradients::factor(const SparseMatrix& A) {
  const Outcome outcome = preconditioner_->factor(A);
  work_.count_factorisation(*preconditioner_);
  star_ = preconditioner_->exact() ? std::nullopt : five_point(A);  // an exact factor needs no products
  return outcome;
}

LinearResult ConjugateGradients::solve_exactly(Vectors& r, Vectors& d) {
  const double rd = precondition({}, r, d);
  r.setZero();
  return {std::isfinite(rd) ? Outcome::success : Outcome::not_finite, 0};
}

double ConjugateGradients::precondition(const Filter& filter, const Vectors& r, Vectors& z) {
  ++work_.preconditioner;
  work_.bytes += preconditioner_->bytes();
  const double rz = preconditioner_->apply(r, z);
  if (filter.empty()) return rz;
  filter(z);
  return r.cwiseProduct(z).sum();
}

/// The next direction p = z + β p and q = A p. Returns <p, q>.
double ConjugateGradients::update_direction(const SparseMatrix& A, double beta) {
  if (star_) return solver::update_direction(*star_, z_, beta, p_, q_);
  if (beta == 0)
    p_ = z_;
  else
    p_ = z_ + beta * p_;
  return multiply(A, p_, q_);
}

std::int64_t ConjugateGradients::direction_bytes(const SparseMatrix& A) const {
  return star_ ? star_->bytes() + vector_bytes(A.rows(), 4) : multiply_bytes(A) + vector_bytes(A.rows(), 3);
}

LinearResult ConjugateGradients::solve(const SparseMatrix& A, const Filter& filter, Vectors& r, Vectors& d, double target) {
  if (preconditioner_->exact() && filter.empty()) return solve_exactly(r, d);
  d.setZero();
  double rz = 0;
  double norm = r.norm();
  for (int k = 0;; ++k) {
    if (!std::isfinite(norm)) return {Outcome::not_finite, k};
    if (norm <= target) return {Outcome::success, k};
    if (k == max_iterations_) return {Outcome::not_converged, k};

    const double previous = rz;
    rz = precondition(filter, r, z_);
    double pq = update_direction(A, k == 0 ? 0 : rz / previous);
    if (!filter.empty()) {
      filter(q_);
      pq = p_.cwiseProduct(q_).sum();
    }
    ++work_.cg_iterations;
    ++work_.products;
    work_.bytes += direction_bytes(A) + vector_bytes(A.rows(), 6);
    if (std::isfinite(pq) && pq <= 0) return {Outcome::breakdown, k};
    norm = std::sqrt(advance(rz / pq, p_, q_, d, r));
  }
}

}  // namespace drape::solver
