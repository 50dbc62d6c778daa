#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"

namespace drape::bench {

/// Solves a compiled scene and returns its positions at some times, the last of which is the end. Throws std::exception with
/// the reason if it cannot.
using Solve = std::function<std::vector<solver::Vectors>(const model::Cloth& cloth, std::span<const double> times)>;

/// One way to solve a scene, with one value of what controls its accuracy.
struct Candidate {
  double value;  ///< step [s], tolerance, or fraction of the stability limit
  Solve solve;
  std::function<std::string()> energy_fault = {};  ///< why its energy cannot be, found by another run; empty if it can
};

/// Ways that differ in one number only, from coarse to fine.
struct Family {
  std::string name;     ///< "bdf2/newton/mic0 by steps", "cvode-bdf/constant-gmres order 2, velocities x100"
  std::string code;     ///< whose it is: "drape", "explicit", "thesis", or the package of SUNDIALS
  std::string control;  ///< "step", "tolerance" or "fraction"
  std::string method;   ///< ours with the program's choice of stage and linear solvers: the method; else empty
  std::vector<Candidate> candidates;
  bool advised = false;  ///< recommended by its authors: tried to the end, however slow; in the study only, not in a ladder
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

/// Whether a code is ours, and not a package of SUNDIALS.
bool is_ours(std::string_view code);

/// Everything that is compared on a scene: of our methods those that are given, or, if there are none, all that the search
/// tries. Apart from `large` ones, ours and SUNDIALS' are equally many where none are given.
std::vector<Family> families(const model::Scene& scene, Search search, const Methods& methods);

/// A method that is not tried on a scene, and why.
struct LeftOut {
  const solver::Method* method;
  std::string reason;
};
std::vector<LeftOut> left_out(const model::Scene& scene, Search search, const Methods& methods);

/// One of our methods with the program's choice of stage and linear solvers, if its name has none: by steps, or, where
/// sub-steps follow the stability limit, by fractions of that. Throws std::invalid_argument as choose_method() does.
Family ladder(const model::Scene& scene, const std::string& method);

/// From 0.1 on, two a decade, to a number of digits.
std::vector<double> tolerances(int finest);

/// Into how many parts a tenth of the end is divided at most.
int finest_parts(Search search);

/// A fifth of the end, and steps that divide a tenth of it into 1 to `most` parts, each about √2 times the next.
std::vector<double> divided_steps(double end, int parts);

}  // namespace drape::bench
