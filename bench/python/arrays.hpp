#pragma once

#include <pybind11/numpy.h>

#include <string>

#include "solver/state.hpp"

namespace drape::bench::python {

namespace py = pybind11;

/// From now on the arrays that NumPy allocates in this context begin where Eigen's vectors do [NEP 49], so that they need not
/// be copied. Throws pybind11::error_already_set.
void align_new_arrays();

/// Vectors in borrowed memory, for functions that take them by reference: as long as this lives, and without a copy.
/// What receives them must neither resize nor move them.
class Borrowed {
 public:
  /// `data`: as Eigen aligns it, rows × 3.
  Borrowed(double* data, Eigen::Index rows);
  ~Borrowed();
  Borrowed(const Borrowed&) = delete;
  Borrowed& operator=(const Borrowed&) = delete;

  solver::Vectors& operator*() { return vectors_; }

 private:
  solver::Vectors vectors_;
};

/// Throws std::runtime_error if Eigen's vectors are not made as Borrowed assumes.
void check_borrowing();

/// Whether vectors may begin there.
bool aligned(const double* data);

/// Memory of an array of `rows` × 3 float64, row by row. Throws std::invalid_argument, with the argument's name and what was
/// expected, if it is something else.
double* vectors_of(py::handle array, Eigen::Index rows, const char* name, bool writeable = false);

/// A new array of rows × 3.
py::array_t<double> new_vectors(Eigen::Index rows);

/// A new array with a copy.
py::array_t<double> to_array(const solver::Vectors& vectors);

}  // namespace drape::bench::python
