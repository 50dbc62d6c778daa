#pragma once

#include "reference/sundials/coordinates.hpp"

namespace drape::reference {

/// Calls each(column, value) for a row in increasing order of columns, the diagonal among them even if it is not stored.
template <class Each>
void for_row_with_diagonal(const solver::SparseMatrix& A, int row, const Each& each) {
  bool passed = false;
  for (solver::SparseMatrix::InnerIterator entry(A, row); entry; ++entry) {
    if (!passed && entry.col() > row) each(row, 0.0);
    passed = passed || entry.col() >= row;
    each(static_cast<int>(entry.col()), entry.value());
  }
  if (!passed) each(row, 0.0);
}

/// Sets J to what visit(add) hands to add(row, column, value) row by row and in increasing order of columns. Memory is kept.
template <class Visit>
void fill(WideSparseMatrix& J, int size, const Visit& visit) {
  if (J.rows() != size) J.resize(size, size);
  J.setZero();
  int rows = 0;
  visit([&](int row, int column, double value) {
    for (; rows <= row; ++rows) J.startVec(rows);
    J.insertBack(row, column) = value;
  });
  J.finalize();
}

}  // namespace drape::reference
