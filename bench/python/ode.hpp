#pragma once

#include <memory>
#include <stdexcept>

#include "bench/python/arrays.hpp"
#include "model/cloth.hpp"

namespace drape::bench::python {

/// The equation of motion of a scene, its vectors in NumPy's memory. One thread at a time.
class Ode {
 public:
  /// Throws std::invalid_argument if the scene has several phases.
  explicit Ode(const model::Scene& scene);

  /// The equation of a run, until end() is called.
  Ode(const solver::SplitOde& ode, solver::State start);

  /// From now on all functions throw std::invalid_argument: the run's equation is gone.
  void end() { ode_ = nullptr; }

  const solver::SplitOde& ode() const {
    if (ode_ == nullptr) throw std::invalid_argument("ode: expected one of a scene, or of a run that has not ended");
    return *ode_;
  }
  const solver::State& start() const { return start_; }

  /// The force [N]; with `out`, there. x [m], v [m/s], N × 3.
  py::object force(double t, py::handle x, py::handle v, py::object out);

  /// M⁻¹ f [m/s²], without the directions of pins.
  py::object acceleration(double t, py::handle x, py::handle v, py::object out);

  /// (v, a) of y = (x, v), both of length 6N.
  py::array_t<double> derivative(double t, py::handle y);

  double potential_energy(py::handle x, double t);
  double kinetic_energy(py::handle v);

  /// ∂f/∂x and ∂f/∂v, 3N × 3N.
  std::pair<solver::SparseMatrix, solver::SparseMatrix> jacobian(double t, py::handle x, py::handle v);

  /// Whether coordinates are free, N × 3. Throws std::invalid_argument if pins hold other directions than those of axes.
  py::array_t<bool> free_coordinates() const;

  /// Removes what r has in the directions of pins.
  void filter(py::handle r);

  /// Arrays that had to be copied since they were not aligned.
  long copies() const { return copies_; }

  /// Mean time of a force within C++ [ns].
  double time_force(int count, double t, py::handle x, py::handle v);

 private:
  /// The Vectors in an array, or in `copy`.
  class Read;

  py::object into(py::object out) const;
  void set_acceleration(double t, const solver::Vectors& x, const solver::Vectors& v, solver::Vectors& a) const;

  std::shared_ptr<const model::Cloth> cloth_;
  const solver::SplitOde* ode_;
  solver::State start_;
  solver::Vectors x_, v_, f_;  ///< copies
  long copies_ = 0;
};

}  // namespace drape::bench::python
