#pragma once

#include <string>

#include "results/verdict.hpp"

namespace drape::bench {

/// A bound from below or above that a value should keep.
struct Bar {
  double wanted;
  bool at_least;
};

/// ">= 5"
std::string to_string(const Bar& bar);

/// Met, or missed: "not met by 1.30", the factor between value and bar.
results::Verdict verdict(const Bar& bar, double value);

}  // namespace drape::bench
