#pragma once

#include "solver/linear/counters.hpp"
#include "solver/split_ode.hpp"

namespace drape::solver {

/// A = M − h² K − h D of IMEX Euler as a whole, for methods that do not solve with it as the stage solver does.
class ConstantMatrix {
 public:
  explicit ConstantMatrix(const SplitOde& ode) : ode_(ode), work_(*ode.work) {}

  /// Makes A; true if h is another one than before.
  bool make(double h);

  const SparseMatrix& operator()() const { return A_; }
  double h() const { return h_; }

  /// h (f(t, x0, v0) + h K v0), which is b − A v0 in A v1 = b   [Etzmuß 2002, (3.23)], without its pinned coordinates.
  void right_side(double t, const State& y0, Vectors& r, Vectors& K_v0);

  /// q = A p, counted.
  void multiply(const Vectors& p, Vectors& q);

  LinearCounters& work() { return work_; }

 private:
  const SplitOde& ode_;
  SparseMatrix A_;
  double h_ = 0;
  LinearCounters work_;
};

}  // namespace drape::solver
