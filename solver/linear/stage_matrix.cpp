#include "solver/linear/stage_matrix.hpp"

namespace drape::solver {

SparseMatrix stage_matrix(const SplitOde& ode, double gamma) {
  SparseMatrix A = -gamma * gamma * ode.stiffness;
  if (ode.damping.nonZeros() > 0) A -= gamma * ode.damping;
  for (int i = 0; i < A.rows(); ++i) A.coeffRef(i, i) += ode.mass[i];
  A.makeCompressed();
  return A;
}

}  // namespace drape::solver
