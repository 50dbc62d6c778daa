#include <Eigen/SparseLU>

#include "solver/step.hpp"

namespace drape::solver {
namespace {

/// Rows and columns of pinned coordinates keep their diagonal only.
void pin(const std::vector<Pin>& pins, SparseMatrix& A, Eigen::VectorXd& b) {
  std::vector<bool> fixed(static_cast<std::size_t>(b.size()));
  for (const Pin& p : pins)
    for (int c = 0; c < 3; ++c)
      if (p.fixed[c]) {
        fixed[3 * p.particle + c] = true;
        b[3 * p.particle + c] = 0;
      }
  A.prune([&](Eigen::Index row, Eigen::Index col, double) { return row == col || !(fixed[row] || fixed[col]); });
}

}  // namespace

// One Newton step of implicit Euler: (M − h² ∂f/∂x − h ∂f/∂v) Δv = h (f(t1, x0, v0) + h ∂f/∂x v0),
// v1 = v0 + Δv,   x1 = x0 + h v1   [Baraff, Witkin 1998]
void linear_euler(Step& s) {
  const SplitOde& ode = s.ode;
  const State& y0 = s.y0();
  SparseMatrix df_dx, df_dv, M(3 * ode.particles(), 3 * ode.particles());
  ode.jacobian(s.t + s.h, y0.x, y0.v, df_dx, df_dv);
  ode.force(s.t + s.h, y0.x, y0.v, s.scratch.f_hat);
  M.setIdentity();
  for (int i = 0; i < 3 * ode.particles(); ++i) M.coeffRef(i, i) = ode.mass[i / 3];
  SparseMatrix A = M - s.h * s.h * df_dx - s.h * df_dv;
  const Eigen::VectorXd v0 = y0.v.reshaped<Eigen::RowMajor>();
  Eigen::VectorXd b = s.h * (s.scratch.f_hat.reshaped<Eigen::RowMajor>() + s.h * (df_dx * v0));
  pin(ode.pins, A, b);
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factor(A);
  if (factor.info() != Eigen::Success) {
    s.result.outcome = Outcome::breakdown;
    return;
  }
  const Eigen::VectorXd dv = factor.solve(b);
  s.y1().v = y0.v + dv.reshaped<Eigen::RowMajor>(ode.particles(), 3);
  s.y1().x = y0.x + s.h * s.y1().v;
}

}  // namespace drape::solver
