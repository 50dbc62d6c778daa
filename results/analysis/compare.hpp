#pragma once

#include <string>
#include <vector>

#include "results/file/run_file.hpp"

namespace drape::results {

enum class Change { same, better, changed, regression, not_comparable };  ///< changed: neither better nor worse

/// The change of one kind, why, and the cells that speak most for it.
struct Aspect {
  Change change = Change::same;
  std::string reason;
  Table worst;
};

/// Three changes, none of which makes up for another.
struct Comparison {
  Aspect accuracy, work, time;
};

/// What is called a change.
struct CompareOptions {
  bool times = true;           ///< whether times are compared at all
  double error_factor = 1.01;  ///< an error grows if it does by this factor, beyond the uncertainties of both references
  double level = 0.01;         ///< probability that times of the same program are called slower
  double time_factor = 1.05;   ///< a slowdown below this is none
  bool quiet = false;          ///< whether the machine was as quick for b as for a: then what all cells share is judged as well
};

/// Compares b with a. Cells are matched by scene, method, parameters, step and end; tables by name, rows by their keys.
/// - accuracy: outcomes; errors (where positions are not comparable, of energy and centre); errors, orders, outcomes,
///   verdicts and quantities in tables; how a run failed may change, and rows be missing where times decide which there are
/// - work: counters, which are the same whenever the same program does the same; any more is a regression
/// - time: the repetitions' times by rank tests with Holm's correction. They are interleaved within a file, so cells of a file
///   compare with each other whatever the machine does meanwhile, but not with those of another hour: the ratio that all cells
///   share is divided out, which takes five cells. On a quiet machine it is judged instead, by a test of all cells together
///   with half of the level.
Comparison compare(const Recording& a, const Recording& b, const CompareOptions& options = {});

/// 1 if any is a regression, else 2 if any is not comparable, else 0.
int exit_code(const Comparison& comparison);

std::string to_string(Change change);

}  // namespace drape::results
