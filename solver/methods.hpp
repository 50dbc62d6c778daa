#pragma once

#include <span>
#include <string>
#include <string_view>

#include "solver/step.hpp"

namespace drape::solver {

/// A time integrator: a row of the table, its step a free function in a file of its own under solver/methods/.
struct Method {
  std::string_view name;         ///< on command lines and in files
  std::string_view description;  ///< a few words, with the equation
  int order;
  /// linear: one system a stage, with the constant matrix; linearised: one system a stage, with the exact Jacobian and
  /// without the stage solver; exponential: functions of the exact Jacobian; own: systems with the constant matrix that the
  /// method itself solves, or does not quite; none: no systems that the program knows of.
  enum class Stages { none, linear, nonlinear, linearised, exponential, own } stages;
  void (*step)(Step&);
  int history = 1;              ///< points of the history that it reads, the start of the step among them
  int forces = 0;               ///< how many of these with a force or an acceleration
  bool meets_obstacles = true;  ///< whether its stages end where contacts are defined
  bool sub_steps = false;       ///< whether it divides its steps by a stability limit of its own
  bool needs_energies = false;  ///< whether every elastic force must be the gradient of an energy
  /// What users may ask for by METHOD/SWEEPS, or by METHOD/SUB_STEPSxSWEEPS.
  enum class Repeats { none, sweeps, sub_steps_and_sweeps } repeats = Repeats::none;
  bool converges = true;   ///< whether its error vanishes with the step; if not, `order` is that without what hinders it
  bool in_thesis = false;  ///< true for velocity Verlet as well, which is measured beside its methods
  std::string_view own_family = {};  ///< of a method whose family the fields above do not tell

  bool implicit() const { return stages == Stages::linear || nonlinear(); }  ///< whether it uses the stage solver
  bool nonlinear() const { return stages == Stages::nonlinear; }

  /// The kind of method by what a step solves, for example "semi-implicit": margins between methods are told family by family.
  std::string_view family() const;

  /// Whether springs are explicit: their stability limits the steps, and a stage costs little more than a force.
  bool explicit_springs() const { return stages == Stages::none || sub_steps; }
};

/// All methods, those with `in_thesis` first.
std::span<const Method> methods();

/// The rows with `in_thesis`.
std::span<const Method> thesis_methods();

/// The method with this name. Throws std::invalid_argument, listing the names.
const Method& method(std::string_view name);

}  // namespace drape::solver
