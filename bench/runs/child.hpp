#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "bench/runs/interruption.hpp"
#include "solver/base/process.hpp"

namespace drape::bench {

/// Runs a program as base::run_child does. Throws Error if it takes longer than `limit` [s], and Interrupted if a signal has
/// ended it.
template <class Error>
base::ChildSaid run_within(std::vector<std::string> words, double limit) {
  constexpr double longest = 1e6;  // [s]: a number that counts of milliseconds hold
  try {
    return base::run_child(std::move(words), std::min(limit, longest));
  } catch (const std::system_error& error) {
    check_interruption();
    if (error.code() == std::errc::timed_out) throw Error(fmt::format("out of time after {:g} s", limit));
    throw;
  }
}

}  // namespace drape::bench
