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
  bool two_step;                                         ///< needs the state before the last
  bool keeps_force;                                      ///< needs a force or acceleration with every state
  enum class Stages { none, linear, nonlinear } stages;  ///< linear: one system a stage; none: explicit
  void (*step)(Step&);
  int past_states = 0;          ///< that it finds in the history, the start of the step among them
  bool meets_obstacles = true;  ///< whether its stages end where contacts are defined

  bool implicit() const { return stages != Stages::none; }
  bool nonlinear() const { return stages == Stages::nonlinear; }
};

/// All methods, those of the thesis first.
std::span<const Method> methods();

/// The thesis' methods, and velocity Verlet.
std::span<const Method> thesis_methods();

/// The method with this name. Throws std::invalid_argument, naming all that there are.
const Method& method(std::string_view name);

void imex_euler(Step& s);
void implicit_euler(Step& s);
void sbdf2(Step& s);
void bdf2(Step& s);
void midpoint(Step& s);
void imex_midpoint(Step& s);
void verlet(Step& s);
void tr_bdf2(Step& s);
void esdirk3(Step& s);
void esdirk4(Step& s);
void bdf3(Step& s);
void bdf4(Step& s);
void bdf5(Step& s);

/// Coefficients of BDF(2) and SBDF(2) for steps that change by the factor w  [Etzmuß 2002, after (3.28)].
struct Bdf2Coefficients {
  double c1, c2, c3;
};
constexpr Bdf2Coefficients bdf2_coefficients(double w) {
  return {(1 + w) * (1 + w) / (1 + 2 * w), w * w / (1 + 2 * w), (1 + w) / (1 + 2 * w)};
}

/// c in the error c h³ d³y/dt³ of a step of BDF(2).
constexpr double bdf2_error(double w) { return (1 + w) * (1 + w) / (6 * w * (1 + 2 * w)); }

}  // namespace drape::solver
