#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "reference/newton_solves.hpp"
#include "reference/tableaux.hpp"
#include "solver/split_ode.hpp"

namespace drape::reference {

/// Settings of SUNDIALS beside the tolerance, for users who know their problem; 0: the package's default.
struct Tuning {
  double velocity_weight = 1;        ///< times which the absolute tolerance of velocities is looser than SolveOptions says
  double kept_factor = 1e-12;        ///< the constant matrix is factored again if γ has changed by more than this part
  double nonlinear = 0;              ///< coefficient of the convergence test of nonlinear systems, over that of the error test
  int max_iterations = 0;            ///< of a nonlinear system
  double step = 0;                   ///< [s], constant steps of ARKODE; rtol is the tolerance of its nonlinear systems then
  bool deduced = false;              ///< whether it infers derivatives of stages instead of evaluating them
  const Tableau* tableau = nullptr;  ///< its method then
};

/// How closely a general solver follows the solution. The estimated local error of each step is kept below
/// rtol (|x| + size) for a position and rtol (|v| + size / (end - t0)) for a velocity, in the root mean square of these
/// quotients: positions and velocities each have their own scale, and no component is relative to a zero.
struct SolveOptions {
  double rtol = 1e-10;
  double size = 1;              ///< [m], of the scene
  long max_steps = 10'000'000;  ///< between two output times
  int max_order = 5;            ///< of a multistep method; the order of a Runge-Kutta method, 2 to 5, with the split 3 to 5
  const NewtonSolve* newton = &newton_solves().front();
  Tuning tuning = {};
};

/// States at given times.
struct Trajectory {
  std::vector<double> times;  ///< [s]
  std::vector<solver::State> states;
};

/// A reference that could not be computed. what() says why in words.
class ReferenceError : public std::runtime_error {
 public:
  ReferenceError(const std::string& message, std::string flag_name, double reached)
      : std::runtime_error(message), flag(std::move(flag_name)), time(reached) {}

  std::string flag;  ///< the solver's name for the failure, for example "CV_CONV_FAILURE"
  double time;       ///< [s], the last time that was reached
};

/// Output times [s] increase, none is before t0 and the last is after it; the tolerance and the size are positive. Throws
/// std::invalid_argument otherwise.
void check(std::span<const double> times, double t0, const SolveOptions& options);

}  // namespace drape::reference
