#pragma once

#include "bench/runs/checkpoint.hpp"

namespace drape::bench {

inline constexpr int growth_parts = 4;

/// How much perturbations of small sheets grow: the one that is found to grow most against the largest singular value.
results::Table growth_of_perturbations(bool quick, Checkpoint& checkpoint);

}  // namespace drape::bench
