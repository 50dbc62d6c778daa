#pragma once

#include <memory>

#include "solver/counters.hpp"
#include "solver/outcome.hpp"
#include "solver/state.hpp"

namespace drape::solver {

class BlockCholesky;

/// The complete factor of a Newton matrix.
class NewtonFactor {
 public:
  /// Registers its counter.
  explicit NewtonFactor(Counters& work);
  ~NewtonFactor();

  /// J: the upper triangle, 3N × 3N, with the pattern of the first call.
  Outcome factor(const SparseMatrix& J);

  /// d = J⁻¹ r; both N × 3.
  void solve(const Vectors& r, Vectors& d);

 private:
  std::unique_ptr<BlockCholesky> factor_;
  std::int64_t& factorisations_;
};

}  // namespace drape::solver
