#pragma once

#include "bench/studies.hpp"
#include "bench/trial.hpp"
#include "results/table_builder.hpp"

/// The pieces of the study `stability`, a table each or more.
namespace drape::bench {

inline constexpr double error_bound = 1e-2;  ///< of the size of the scene: below it a run is accurate
inline constexpr double horizon = 0.24;      ///< [s], in which a free sheet falls by a third of its side

/// A trial with its error and what follows from them.
struct Judged {
  Attempt trial;
  results::UncertainError error;
  results::Verdict verdict = results::Verdict::bounded;

  bool stable() const { return verdict <= results::Verdict::bounded; }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Judged, trial, error, verdict)

Judged judged(Attempt trial, const Yardstick& yardstick);

/// A square sheet of n × n particles, horizontal, hung by two corners, with the shear modulus k/100.
Specimen hung_by_corners(int n, double k, double d);

/// The columns of a verdict in the current row.
void add_verdict(results::TableBuilder& table, const Judged& judged, bool shown);

std::vector<TableJob> stability_atlas(bool quick);
TableJob largest_steps(bool quick);
TableJob stress_cases(bool quick);

}  // namespace drape::bench
