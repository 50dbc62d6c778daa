#pragma once

#include <memory>

#include "solver/outcome.hpp"
#include "solver/split_ode.hpp"

namespace drape::solver {

/// The complete factor of a Newton matrix, 3N × 3N, kept until it is asked to be renewed.
class NewtonFactor {
 public:
  /// `lean`: as SplitOde::newton_matrix has it.
  NewtonFactor(const SplitOde& ode, bool lean);
  ~NewtonFactor();

  bool empty() const { return gamma_ == 0; }
  double gamma() const { return gamma_; }  ///< that it was made for, 0 if there is none

  /// Evaluates the Jacobian at this state and factors it.
  Outcome renew(double t, const State& y, double gamma);
  void discard() { gamma_ = 0; }

  /// d = J⁻¹ r; both N × 3.
  void solve(const Vectors& r, Vectors& d);

 private:
  class Factor;

  const SplitOde& ode_;
  const bool lean_;
  SparseMatrix J_;
  std::unique_ptr<Factor> factor_;
  double gamma_ = 0;
  std::int64_t& renewals_;
};

}  // namespace drape::solver
