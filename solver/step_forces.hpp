#pragma once

#include <cstdint>

#include "solver/state.hpp"

namespace drape::solver {

/// Forces of obstacles that are found where a step begins and stay the same functions of t, x and v until it ends, so that its
/// stages converge. All forces of an ODE that has them, and its K and D, are those of the step that began last.
class StepForces {
 public:
  virtual ~StepForces() = default;

  /// A step begins with this state. The same step may begin more than once.
  virtual void begin(double t, const State& y) = 0;

  /// How often the forces have changed, and K and D as they are now, whose patterns never change: SplitOde::stiffness and
  /// SplitOde::damping follow at the beginnings of steps.
  virtual std::int64_t changes() const = 0;
  virtual const SparseMatrix& stiffness() const = 0;
  virtual const SparseMatrix& damping() const = 0;

  /// What is not linear is explicit to methods that split forces.
  enum class Part { whole, without_linear };

  /// Sets f (N × 3) to the forces that obstacles exert on particles by them [N], all of them or without what K x + D v has.
  virtual void of_obstacles(Part part, double t, const State& y, Vectors& f) const = 0;

  /// What is stored by them more than SplitOde::potential_energy has [J].
  virtual double energy(double t, const Vectors& x) const = 0;
};

}  // namespace drape::solver
