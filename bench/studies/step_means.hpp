#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "results/run_record.hpp"

/// Means over some of the steps of a run, and what contact at rest costs.
namespace drape::bench {

using Steps = std::span<const results::StepRecord>;

inline constexpr double most_iterations_at_rest = 1.5;  ///< over those before the first contact, if resting costs little

/// The steps before the first contact.
inline Steps before_contact(const results::RunRecord& run) {
  return {run.steps.begin(),
          std::ranges::find_if(run.steps, [](const results::StepRecord& step) { return step.contacts > 0; })};
}

/// NaN if there are none.
inline double mean(Steps steps, int results::StepRecord::*value) {
  double sum = 0;
  for (const results::StepRecord& step : steps) sum += step.*value;
  return sum / static_cast<double>(steps.size());
}

/// CG iterations a step.
inline double iterations(Steps steps) { return mean(steps, &results::StepRecord::cg_iterations); }

/// CG iterations a step in the last 20 of a run that ends at rest, over those before the first contact.
inline double iterations_at_rest(const results::RunRecord& run) {
  constexpr std::size_t at_rest = 20;
  const Steps all = run.steps;
  return iterations(all.last(std::min(all.size(), at_rest))) / iterations(before_contact(run));
}

}  // namespace drape::bench
