#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "bench/studies/studies.hpp"
#include "bench/studies/trial.hpp"
#include "results/columns.hpp"

/// The pieces of the study `stability`, a table each or more.
namespace drape::bench {

inline constexpr double error_bound = 1e-2;  ///< of the size of the scene: below it a run is accurate
inline constexpr double horizon = 0.24;      ///< [s], in which a free sheet falls by a third of its side

/// A trial with its error and what follows from them.
struct Judged {
  RunEnd trial;
  UncertainError error;
  Verdict verdict = Verdict::bounded;

  bool stable() const { return verdict <= Verdict::bounded; }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Judged, trial, error, verdict)

Judged judged(RunEnd trial, const CrossCheckedReference& reference);

/// A square sheet of n × n particles, horizontal, hung by two corners, with the shear modulus k/100.
Specimen hung_by_corners(int n, double k, double d);

/// What became of a run.
inline constexpr results::ColumnOf<Judged> judged_columns[] = {
    {"verdict", "verdict", "", "what became of the run", results::Role::verdict,
     [](const Judged& run) -> results::Cell { return std::string(to_string(run.verdict)); }},
    {"error", "error", "1", "of the end over the size, positions or centre of mass; none: not known", results::Role::error,
     [](const Judged& run) { return std::isnan(run.error.error) ? results::Cell() : run.error.error; }},
    {"uncertainty", "±", "1", "of the error: how far two reference methods differ", results::Role::uncertainty,
     [](const Judged& run) { return std::isnan(run.error.error) ? results::Cell() : run.error.uncertainty; }},
    {"steps", "steps", "1", "accepted ones", results::Role::counter,
     [](const Judged& run) { return results::to_cell(run.trial.result.steps); }},
    {"rejected", "rejected", "1", "steps that were cut", results::Role::counter,
     [](const Judged& run) { return results::to_cell(run.trial.result.rejected_steps); }},
    {"evaluations", "evaluations", "1", "of forces, and of Newton matrices", results::Role::counter,
     [](const Judged& run) { return results::to_cell(run.trial.evaluations); }},
    {"newton_matrices", "Newton", "1", "matrices made", results::Role::counter,
     [](const Judged& run) { return results::to_cell(run.trial.newton_matrices); }},
    {"cpu_ms", "", "ms", "processor time", results::Role::time,
     [](const Judged& run) { return results::to_cell(run.trial.cpu_ms); }},
    {"reason", "reason", "", "why it did not succeed", results::Role::note,
     [](const Judged& run) -> results::Cell { return reason(run.trial); }},
};

/// The largest of equal steps to the horizon, by bisection [s]; 0: none.
struct LargestSteps {
  double accurate, stable;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LargestSteps, accurate, stable)

LargestSteps largest_steps(const Specimen& specimen, const CrossCheckedReference& reference, const solver::Method& method,
                           const solver::Options& options);

inline constexpr results::ColumnOf<LargestSteps> largest_columns[] = {
    {"accurate", "accurate", "s", "largest step that is accurate", results::Role::quantity,
     [](const LargestSteps& row) { return row.accurate > 0 ? results::Cell(row.accurate) : results::Cell(); }},
    {"stable", "stable", "s", "largest step that is stable, right or wrong", results::Role::quantity,
     [](const LargestSteps& row) { return row.stable > 0 ? results::Cell(row.stable) : results::Cell(); }},
};

Job stability_atlas(bool quick, const Methods& methods);
Job largest_steps(bool quick, const Methods& methods);
Job stress_cases(bool quick, const Methods& methods);

}  // namespace drape::bench
