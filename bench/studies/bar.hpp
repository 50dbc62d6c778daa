#pragma once

#include <string>

namespace drape::bench {

/// A bound from below or above that a value should keep.
struct Bar {
  double wanted;
  bool at_least;
};

/// ">= 5"
std::string to_string(const Bar& bar);

/// "met", or "missed: not met by 1.30", the factor between value and bar.
std::string verdict(const Bar& bar, double value);

}  // namespace drape::bench
