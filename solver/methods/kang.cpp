#include "solver/methods/constant_matrix.hpp"
#include "solver/step.hpp"

namespace drape::solver {

// v1_i = b_i/A_ii,   x1 = x0 + h v1,   with A v1 = b that of `imex-euler`   [Kang et al. 2000, as told in Etzmuß 2002, 3.2]:
// one sweep of Jacobi's iteration from v1 = 0. `sweeps` take more of them, which lead to `imex-euler`.
// Damping slows particles down as if their neighbours were at rest, however short the step.
void kang(Step& s) {
  ConstantMatrix& A = s.keep<ConstantMatrix>();
  const State& y0 = s.y0();
  Vectors &b = s.scratch.f_hat, &q = s.scratch.av, &v = s.y1().v;
  s.error.constant = 1.0 / 2;
  A.make(s.h);
  A.right_side(s.t, y0, b, q);
  A.multiply(y0.v, q);
  b += q;
  v.setZero();
  prescribe(s.ode.pins, v);
  for (int k = 0; k < s.options.sweeps; ++k) {
    A.multiply(v, q);
    q = b - q;
    filter(s.ode.pins, q);
    for (int i = 0; i < q.rows(); ++i) {
      const double diagonal = A().coeff(i, i);
      if (!(diagonal > 0)) s.result.outcome = Outcome::breakdown;
      v.row(i) += q.row(i) / diagonal;
    }
    ++A.work().updates;
    ++s.result.updates;
  }
  s.y1().x = y0.x + s.h * v;
}

}  // namespace drape::solver
