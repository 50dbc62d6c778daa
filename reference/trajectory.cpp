#include "reference/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace drape::reference {

void check(std::span<const double> times, double t0, const SolveOptions& options) {
  if (times.empty() || times.front() < t0 || times.back() <= t0 ||
      std::ranges::adjacent_find(times, std::greater_equal()) != times.end())
    throw std::invalid_argument(fmt::format("output times must increase, start at t0 = {} s or later and end after it", t0));
  if (!(options.rtol > 0) || !(options.size > 0))
    throw std::invalid_argument(fmt::format("rtol = {} and size = {} m must both be positive", options.rtol, options.size));
}

}  // namespace drape::reference
