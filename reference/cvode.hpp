#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "solver/split_ode.hpp"

namespace drape::reference {

/// How closely CVODE follows the solution. The estimated local error of each step is kept below
/// rtol (|x| + size) for a position and rtol (|v| + size / (end - t0)) for a velocity, in the root mean square of these
/// quotients: positions and velocities each have their own scale, and no component is relative to a zero.
struct CvodeOptions {
  double rtol = 1e-10;
  double size = 1;              ///< [m], of the scene
  long max_steps = 10'000'000;  ///< between two output times
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

  std::string flag;  ///< CVODE's name for the failure, for example "CV_CONV_FAILURE"
  double time;       ///< [s], the last time that was reached
};

/// Solves the split equation of motion with CVODE: BDF of orders 1 to 5 with variable step and stability limit detection,
/// Newton's method with the exact sparse Jacobian factorised by KLU [Hindmarsh et al. 2005, SUNDIALS].
///
/// Output times [s] increase, none is before t0 and the last is after it; output between steps is interpolated with the
/// method's own polynomial. Nothing is evaluated after the last time. The velocities of pinned coordinates in y0 are ignored.
/// Counts its work in ode.work under "cvode/". Throws ReferenceError if the solution cannot be followed, and
/// std::invalid_argument if it is ill posed.
Trajectory cvode(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                 const CvodeOptions& options = {});

}  // namespace drape::reference
