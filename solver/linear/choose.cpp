#include "solver/linear/choose.hpp"

#include <algorithm>
#include <cmath>

#include "solver/linear/five_point.hpp"
#include "solver/linear/preconditioner.hpp"

namespace drape::solver {
namespace {

/// The numerical stiffness γ² k / m [Etzmuß 2002, 3.1.1] of a stage's matrix: the largest spring over its particle's mass,
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

/// Whether couplings along a direction of the grid differ by more than on a uniform one, where those on borders are half of the
/// others, and than multigrid takes without more iterations.
bool varies(const FivePoint& A) {
  constexpr double most = 8;
  double least_u = INFINITY, largest_u = 0, least_v = INFINITY, largest_v = 0;
  for (const FivePoint::Node& node : A.nodes) {
    if (node.right > 0) least_u = std::min(least_u, node.right), largest_u = std::max(largest_u, node.right);
    if (node.up > 0) least_v = std::min(least_v, node.up), largest_v = std::max(largest_v, node.up);
  }
  return largest_u > most * least_u || largest_v > most * least_v;
}

/// A linear solver, and the name of the reason to take it.
struct Choice {
  std::string_view solver, reason;
};

/// The fastest of the linear solvers over about a hundred solves with one matrix.
Choice fastest(const SparseMatrix& A) {
  if (A.rows() <= LinearChoice::most_factored) return {"cholesky", "small"};
  if (stiffness(A) < LinearChoice::soft) return {"mic0", "soft"};
  const bool factored = A.rows() <= LinearChoice::most_factored_without_grid;
  if (const auto star = five_point(A)) {
    if (factored && varies(*star)) return {"cholesky", "varying"};
    return {"multigrid", "grid"};
  }
  if (factored) return {"cholesky", "no-grid"};
  return {"mic0", "large"};
}

/// Chooses again for every matrix.
class Automatic : public Preconditioner {
 public:
  void analyse(const SparseMatrix&) override { solver_ = nullptr; }

  Outcome factor(const SparseMatrix& A) override {
    const Choice best = fastest(A);
    if (solver_ == nullptr || chosen_.solver != best.solver) {
      solver_ = linear_solver(best.solver).make();
      solver_->analyse(A);
    }
    chosen_ = best;
    return solver_->factor(A);
  }

  double apply(const Vectors& r, Vectors& z) override { return solver_->apply(r, z); }
  bool exact() const override { return solver_->exact(); }
  std::int64_t bytes() const override { return solver_->bytes(); }
  std::string_view name() const override { return solver_->name(); }
  std::string_view reason() const override { return chosen_.reason; }

 private:
  Choice chosen_;
  std::unique_ptr<Preconditioner> solver_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_automatic() { return std::make_unique<Automatic>(); }

}  // namespace drape::solver
