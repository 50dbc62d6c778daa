#pragma once

#include <string>

namespace drape::bench {

/// Asks that a value be at least, or at most, so much.
struct Bar {
  double wanted;
  bool at_least;
};

/// ">= 5"
std::string to_string(const Bar& bar);

/// "met", or "missed: not met by 1.30", the factor between value and bar.
std::string verdict(const Bar& bar, double value);

}  // namespace drape::bench
