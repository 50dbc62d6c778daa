#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"

namespace drape::bench {

/// How a run ended, and the states at the times that were asked for if it succeeded.
struct Solved {
  RunEnd end;
  std::vector<solver::State> states = {};
};

/// Solves a compiled scene within limits; the last time is the end.
using Solve = std::function<Solved(const model::Cloth& cloth, std::span<const double> times, const Limits& limits)>;

/// A configuration with one value of what controls its accuracy.
struct Variant {
  double value;  ///< step [s], tolerance, or fraction of the stability limit
  Solve solve;
  std::function<RunEnd(const Limits& limits)> guarded;  ///< another run, under the energy guard
};

/// Whose a configuration is: ours, or a package of SUNDIALS.
enum class Code {
  drape,
  explicit_steps,
  thesis,
  cvode_bdf,
  cvode_adams,
  arkode_esdirk,
  arkode_imex,
  arkode_erk,
  arkode_steps,
  ida_bdf,
};

/// The code as it is written in files, for example "cvode-bdf".
constexpr std::string_view to_string(Code code) {
  switch (code) {
    case Code::drape: return "drape";
    case Code::explicit_steps: return "explicit";
    case Code::thesis: return "thesis";
    case Code::cvode_bdf: return "cvode-bdf";
    case Code::cvode_adams: return "cvode-adams";
    case Code::arkode_esdirk: return "arkode-esdirk";
    case Code::arkode_imex: return "arkode-imex";
    case Code::arkode_erk: return "arkode-erk";
    case Code::arkode_steps: return "arkode-steps";
    case Code::ida_bdf: return "ida-bdf";
  }
  return "unknown";
}

/// What controls the accuracy of a configuration.
enum class Control { step, tolerance, fraction };

constexpr std::string_view to_string(Control control) {
  switch (control) {
    case Control::step: return "step";
    case Control::tolerance: return "tolerance";
    case Control::fraction: return "fraction";
  }
  return "unknown";
}

/// A way to solve scenes. Its variants differ in one number only, from coarse to fine.
struct Configuration {
  std::string name;  ///< "bdf2/newton/mic0 by steps", "cvode-bdf/constant-gmres order 2, velocities x100"
  Code code;
  Control control;
  const solver::Method* by_default;  ///< ours with the program's choice of stage and linear solvers: the method; else null
  std::vector<Variant> variants = {};
  bool advised = false;  ///< recommended by its authors: tried to the end, however slow; in the study only, not in a ladder

  bool is_ours() const { return code <= Code::thesis; }
  bool is_sundials() const { return !is_ours(); }
  bool is_implicit() const { return code == Code::drape || code == Code::thesis; }
  bool is_explicit() const { return code == Code::explicit_steps; }
  bool is_thesis() const { return code == Code::thesis; }
  bool is_default() const { return by_default != nullptr; }
};

/// The program's default method and control.
inline constexpr const char* advised_ours = "bdf2 by steps";

/// How much is tried.
enum class Search {
  quick,  ///< a few methods and configurations, for tests
  large,  ///< the same without SUNDIALS' packages
  usual,  ///< all methods with automatic stages and linear solvers, as many configurations of SUNDIALS
  full,   ///< also other stage and linear solvers, as many configurations of SUNDIALS
};

/// Everything that is compared on a scene: of our methods those that are given, or, if there are none, all that the search
/// tries. Apart from `large` ones, ours and SUNDIALS' are equally many where none are given.
std::vector<Configuration> configurations(const model::Scene& scene, Search search, const Methods& methods);

/// A method that is not tried on a scene, and why.
struct LeftOut {
  const solver::Method* method;
  std::string reason;
};
std::vector<LeftOut> left_out(const model::Scene& scene, Search search, const Methods& methods);

/// One of our methods with the program's choice of stage and linear solvers, if its name has none: by steps, or, where
/// sub-steps follow the stability limit, by fractions of that. Throws std::invalid_argument as choose_method() does.
Configuration ladder(const model::Scene& scene, const std::string& method);

/// What the program chooses for an error on a scene, its choice included. Throws std::invalid_argument as
/// choose_automatically() does.
Configuration automatic(const model::Scene& scene, double accuracy);

/// From 0.1 on, two a decade, to a number of digits.
std::vector<double> tolerances(int finest);

/// Into how many parts a tenth of the end is divided at most.
int finest_parts(Search search);

/// A fifth of the end, and steps that divide a tenth of it into 1 to `most` parts, each about √2 times the next.
std::vector<double> divided_steps(double end, int parts);

}  // namespace drape::bench
