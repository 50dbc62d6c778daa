#include <cmath>

#include "solver/linear/five_point.hpp"
#include "solver/linear/preconditioner.hpp"

namespace drape::solver {
namespace {

/// The numerical stiffness γ² k / m [Etzmuß 2002, 3.1.1] of a stage's matrix: the largest spring over what its particle weighs,
/// which is the sum of a row since springs pull on differences.
double stiffness(const SparseMatrix& A) {
  double stiffness = 0;
  for (int i = 0; i < A.outerSize(); ++i) {
    double mass = 0, spring = 0;
    for (SparseMatrix::InnerIterator a(A, i); a; ++a) {
      mass += a.value();
      if (a.col() != i) spring = std::max(spring, std::abs(a.value()));
    }
    stiffness = std::max(stiffness, mass > 0 ? spring / mass : INFINITY);
  }
  return stiffness;
}

/// The quickest of the linear solvers over about a hundred solves with one matrix, as measured (`study scaling` shows some of
/// it): up to 150 × 150 particles a substitution takes less time than two multigrid cycles, at 200 × 200 its factorisation no
/// longer pays; where springs are softer than masses two or three iterations suffice, however large the sheet.
const LinearSolver& quickest(const SparseMatrix& A) {
  if (A.rows() <= 25000) return linear_solver("cholesky");
  if (stiffness(A) < 1) return linear_solver("mic0");
  if (five_point(A)) return linear_solver("multigrid");
  return linear_solver(A.rows() <= 200000 ? "cholesky" : "mic0");
}

/// Chooses anew for every matrix.
class Automatic : public Preconditioner {
 public:
  void analyze(const SparseMatrix&) override { solver_ = nullptr; }

  Outcome factor(const SparseMatrix& A) override {
    const LinearSolver& best = quickest(A);
    if (solver_ == nullptr || chosen_ != &best) {
      chosen_ = &best;
      solver_ = best.make();
      solver_->analyze(A);
    }
    return solver_->factor(A);
  }

  double apply(const Vectors& r, Vectors& z) override { return solver_->apply(r, z); }
  bool exact() const override { return solver_->exact(); }
  std::int64_t bytes() const override { return solver_->bytes(); }
  std::string_view name() const override { return solver_->name(); }

 private:
  const LinearSolver* chosen_ = nullptr;
  std::unique_ptr<Preconditioner> solver_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_automatic() { return std::make_unique<Automatic>(); }

}  // namespace drape::solver
