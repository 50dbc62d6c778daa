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

/// "met", or by what factor it is not.
std::string verdict(const Bar& bar, double value);

}  // namespace drape::bench
