#pragma once

#include "bench/studies/studies.hpp"
#include "bench/studies/trial.hpp"
#include "results/table_builder.hpp"

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

/// The columns of a verdict in the current row.
void add_verdict(results::TableBuilder& table, const Judged& judged, bool shown);

/// The largest of equal steps to the horizon, by bisection [s]; 0: none.
struct LargestSteps {
  double accurate, stable;
};
LargestSteps largest_steps(const Specimen& specimen, const CrossCheckedReference& reference, const solver::Method& method,
                           const solver::Options& options);

/// Their columns in the current row.
void add_largest(results::TableBuilder& table, const LargestSteps& largest);

std::vector<TableJob> stability_atlas(bool quick, const Methods& methods);
TableJob largest_steps(bool quick, const Methods& methods);
TableJob stress_cases(bool quick, const Methods& methods);

}  // namespace drape::bench
