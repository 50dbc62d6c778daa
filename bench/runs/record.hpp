#pragma once

#include <span>

#include "bench/runs/run.hpp"
#include "results/run_record.hpp"

namespace drape::bench {

/// Runs under the energy guard and records everything but times and errors. A run that exceeds its limits is recorded as far as
/// it came. Throws Interrupted, and what an observer throws.
results::RunRecord record(const RunSpec& spec, std::span<Observer* const> observers = {}, Limits limits = {});

}  // namespace drape::bench
