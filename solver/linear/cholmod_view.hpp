#pragma once

#include <cholmod.h>

#include <cstddef>

#include "solver/state.hpp"

namespace drape::solver {

/// A symmetric matrix for CHOLMOD, which reads its upper triangle only. Our rows are CHOLMOD's columns, so our upper triangle
/// is CHOLMOD's lower one. Valid as long as A is and keeps its pattern.
inline cholmod_sparse cholmod_view(const SparseMatrix& A) {
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(A.rows());
  view.nzmax = static_cast<std::size_t>(A.nonZeros());
  view.p = const_cast<int*>(A.outerIndexPtr());
  view.i = const_cast<int*>(A.innerIndexPtr());
  view.x = const_cast<double*>(A.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

}  // namespace drape::solver
