#pragma once

#include <cholmod.h>

#include <cstddef>

#include "solver/state.hpp"

namespace drape::solver {

/// The pattern of a symmetric n × n matrix for CHOLMOD: its lower triangle, column by column with ascending rows. Valid as long
/// as these are.
inline cholmod_sparse cholmod_pattern(std::size_t n, const int* begin, const int* row, std::size_t entries) {
  cholmod_sparse view{};
  view.nrow = view.ncol = n;
  view.nzmax = entries;
  view.p = const_cast<int*>(begin);
  view.i = const_cast<int*>(row);
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_PATTERN;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

/// A symmetric matrix for CHOLMOD, which reads its upper triangle only. Our rows are CHOLMOD's columns, so our upper triangle
/// is CHOLMOD's lower one. Valid as long as A is and keeps its pattern.
inline cholmod_sparse cholmod_view(const SparseMatrix& A) {
  cholmod_sparse view = cholmod_pattern(static_cast<std::size_t>(A.rows()), A.outerIndexPtr(), A.innerIndexPtr(),
                                        static_cast<std::size_t>(A.nonZeros()));
  view.x = const_cast<double*>(A.valuePtr());
  view.xtype = CHOLMOD_REAL;
  return view;
}

}  // namespace drape::solver
