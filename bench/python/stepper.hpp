#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "model/scene.hpp"
#include "solver/methods.hpp"

namespace drape::bench::python {

namespace py = pybind11;

/// A time integrator written in Python, as a method of ours: step(ode, t, h, y) returns the y at t + h, an (x, v) or an object
/// that has both. A class is made again for every run, so that it may remember what was before.
class Stepper {
 public:
  /// Throws std::invalid_argument if there are too many, or a name is not one that tables and command lines can have.
  Stepper(std::string name, int order, py::object step);
  ~Stepper();
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  const solver::Method& method() const { return method_; }
  const py::object& step() const { return step_; }

 private:
  std::string name_;
  py::object step_;
  std::size_t slot_;
  solver::Method method_;
};

/// An exception of a step that is an error of the program, and not the failure of a method as division by zero is. No
/// std::exception, so that it does not pass for the failure of a run.
struct StepperError {
  py::error_already_set error;
};

/// Throws std::invalid_argument, naming it, if the state of a scene is more than x and v, or does not obey an equation alone.
void require_smooth(const model::Scene& scene);

}  // namespace drape::bench::python
