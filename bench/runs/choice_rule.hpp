#pragma once

#include <string>
#include <vector>

#include "solver/options.hpp"

namespace drape::bench {

/// What a sheet hangs by.
enum class Support { points, edge };

/// A uniform sheet that hangs by some of its particles and falls under its weight, in the numbers that decide which method is
/// the quickest at which error. L: its longer side, ρ: its density, g: gravity, T = √(L/g).
struct FallingSheet {
  Support support = Support::points;
  int particles = 0;
  double end = 0;        ///< [s]
  double fall_time = 0;  ///< T [s]
  double damping = 0;    ///< δ = d T/(ρ L²): over inertia, for waves as long as the sheet
  double tension = 0;    ///< κ = k/(ρ g L), the inverse of the strain by its own weight
  double limit = 0;      ///< stability limit of velocity Verlet [s]
};

/// A method with its solvers that the rule chooses between.
struct Way {
  const char* method;  ///< as on the command line
  double stage_accuracy = solver::Options().stage_accuracy;
  double loop_tolerance = solver::Options().loop_tolerance;
};

/// A way with the longest step that should do.
struct Prediction {
  Way way;
  double step = 0;      ///< [s]
  double fraction = 0;  ///< of the stability limit; 0 where steps do not follow that
  double error = 0;     ///< over the size
  double updates = 0;   ///< of stages, or evaluations of forces where there are none
  double ms = 0;        ///< of CPU time, on the machine that the rule was measured on
};

/// Every way that should reach an error over the size, the quickest first; empty if none does.
std::vector<Prediction> predictions(const FallingSheet& sheet, double accuracy);

/// Why a sheet is not one of those that the rule was measured on, with the number that is out of its range; empty if it is.
std::string reason_out_of_range(const FallingSheet& sheet);

}  // namespace drape::bench
