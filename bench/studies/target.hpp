#pragma once

#include <string>

#include "results/verdict.hpp"

namespace drape::bench {

/// A bound from below or above that a value should keep.
struct Target {
  double wanted;
  bool at_least;
};

/// ">= 5"
std::string to_string(const Target& target);

/// Met, or missed: "not met by 1.30", the factor between value and target.
results::Verdict check(const Target& target, double value);

}  // namespace drape::bench
