#include "solver/methods/constant_matrix.hpp"

#include "solver/linear/kernels.hpp"
#include "solver/linear/stage_matrix.hpp"

namespace drape::solver {

bool ConstantMatrix::make(double h) {
  if (h == h_) return false;
  h_ = h;
  A_ = stage_matrix(ode_, h);
  ++work_.builds;
  ++work_.factorisations;
  work_.entries = A_.nonZeros();
  return true;
}

void ConstantMatrix::right_side(double t, const State& y0, Vectors& r, Vectors& K_v0) {
  ode_.force(t, y0.x, y0.v, r);
  solver::multiply(ode_.stiffness, y0.v, K_v0);
  ++work_.products;
  work_.bytes += multiply_bytes(ode_.stiffness);
  r = h_ * (r + h_ * K_v0);
  filter(ode_.pins, r);
}

void ConstantMatrix::multiply(const Vectors& p, Vectors& q) {
  solver::multiply(A_, p, q);
  ++work_.products;
  work_.bytes += multiply_bytes(A_);
}

}  // namespace drape::solver
