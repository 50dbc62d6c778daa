#include "solver/linear/newton_factor.hpp"

#include "solver/linear/block_cholesky.hpp"

namespace drape::solver {

NewtonFactor::NewtonFactor(Counters& work)
    : factorisations_(work.counter("newton_factorisations", "complete factorisations of a Newton matrix")) {}
NewtonFactor::~NewtonFactor() = default;

Outcome NewtonFactor::factor(const SparseMatrix& J) {
  ++factorisations_;
  if (!factor_) factor_ = std::make_unique<BlockCholesky>(J);
  return factor_->factor(J) ? Outcome::success : Outcome::breakdown;
}

void NewtonFactor::solve(const Vectors& r, Vectors& d) { factor_->solve(r, d); }

}  // namespace drape::solver
