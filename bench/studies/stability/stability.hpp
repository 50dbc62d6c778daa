#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bench/studies/cross_checked_reference.hpp"
#include "bench/studies/studies.hpp"
#include "results/columns.hpp"

/// The pieces of the study `stability`, a table each or more.
namespace drape::bench {

inline constexpr double error_bound = 1e-2;  ///< of the size of the scene: below it a run is accurate
inline constexpr double horizon = 0.24;      ///< [s], in which a free sheet falls by a third of its side

/// What became of a run.
enum class Classification {
  accurate,       ///< its error is below a bound
  wrong,          ///< bounded energy, but an error above it
  bounded,        ///< bounded energy; there is no reference to tell the error
  unstable,       ///< its energy rose beyond what the scene can have, or it ended in a NaN
  not_converged,  ///< a step's equations were not solved
  not_finished,   ///< it exceeded its budget
};
inline constexpr int classifications = 6;

/// As it is written in tables and files, for example "stable but wrong".
constexpr std::string_view to_string(Classification classification) {
  switch (classification) {
    case Classification::accurate: return "accurate";
    case Classification::wrong: return "stable but wrong";
    case Classification::bounded: return "stable, error unknown";
    case Classification::unstable: return "unstable";
    case Classification::not_converged: return "not converged";
    case Classification::not_finished: return "not finished";
  }
  return "unknown";
}

/// In the order of Classification: the best first.
inline constexpr auto classification_names = [] {
  std::array<std::string_view, classifications> names;
  for (int k = 0; k < classifications; ++k) names[k] = to_string(static_cast<Classification>(k));
  return names;
}();

/// The error of a run counts as below or above the bound only if it is so however the reference errs.
Classification classify(solver::Outcome outcome, const UncertainError& measured, double bound);

/// How a run ended, its error, and what follows from them.
struct ClassifiedRun {
  RunEnd end;
  UncertainError error;
  Classification classification = Classification::bounded;

  bool stable() const { return classification <= Classification::bounded; }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ClassifiedRun, end, error, classification)

ClassifiedRun classified(RunEnd end, const CrossCheckedReference& reference);

/// A square sheet of n × n particles, horizontal, hung by two corners, with the shear modulus k/100.
CompiledScene hung_by_corners(int n, double k, double d);

/// What became of a run.
inline constexpr results::ColumnOf<ClassifiedRun> classified_columns[] = {
    {"verdict", "verdict", "", "what became of the run", results::Role::outcome,
     [](const ClassifiedRun& run) -> results::Datum { return std::string(to_string(run.classification)); }, nullptr,
     classification_names},
    {"error", "error", "1", "of the end over the size, positions or centre of mass; none: not known", results::Role::error,
     [](const ClassifiedRun& run) { return std::isnan(run.error.error) ? results::Datum() : run.error.error; }},
    {"uncertainty", "±", "1", "of the error: how far two reference methods differ", results::Role::uncertainty,
     [](const ClassifiedRun& run) { return std::isnan(run.error.error) ? results::Datum() : run.error.uncertainty; }},
    {"steps", "steps", "1", "accepted ones", results::Role::counter,
     [](const ClassifiedRun& run) { return results::to_datum(run.end.result.steps); }},
    {"rejected", "rejected", "1", "steps that were cut", results::Role::counter,
     [](const ClassifiedRun& run) { return results::to_datum(run.end.result.rejected_steps); }},
    {"evaluations", "evaluations", "1", "of forces, and of Newton matrices", results::Role::counter,
     [](const ClassifiedRun& run) { return results::to_datum(run.end.evaluations); }},
    {"newton_matrices", "Newton", "1", "matrices made", results::Role::counter,
     [](const ClassifiedRun& run) { return results::to_datum(run.end.newton_matrices); }},
    {"cpu_ms", "", "ms", "processor time", results::Role::time,
     [](const ClassifiedRun& run) { return results::to_datum(run.end.cpu_ms); }},
    {"reason", "reason", "", "why it did not succeed", results::Role::note,
     [](const ClassifiedRun& run) -> results::Datum { return reason(run.end); }},
};

/// What a run may cost. A sub-step of an explicit method is far cheaper than an update of an implicit one.
inline std::int64_t usual_evaluations(const solver::Method& method) { return method.explicit_springs() ? 100'000 : 4'000; }

/// The largest of equal steps to the horizon, by bisection [s]; 0: none.
struct LargestSteps {
  double accurate, stable;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LargestSteps, accurate, stable)

LargestSteps largest_steps(const CompiledScene& sheet, const CrossCheckedReference& reference, const solver::Method& method,
                           const solver::Options& options);

inline constexpr results::ColumnOf<LargestSteps> largest_columns[] = {
    {"accurate", "accurate", "s", "largest step that is accurate", results::Role::quantity,
     [](const LargestSteps& row) { return row.accurate > 0 ? results::Datum(row.accurate) : results::Datum(); }},
    {"stable", "stable", "s", "largest step that is stable, right or wrong", results::Role::quantity,
     [](const LargestSteps& row) { return row.stable > 0 ? results::Datum(row.stable) : results::Datum(); }},
};

Job stability_atlas(bool quick, const Methods& methods);
Job largest_steps(bool quick, const Methods& methods);
Job stress_cases(bool quick, const Methods& methods);

}  // namespace drape::bench
