#pragma once

#include "bench/runs/recording.hpp"

namespace drape::bench {

/// How much perturbations of small sheets grow: the one that is found to grow most against the largest singular value.
Job growth_of_perturbations(bool quick);

}  // namespace drape::bench
