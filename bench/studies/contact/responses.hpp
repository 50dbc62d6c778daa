#pragma once

#include "bench/runs/recording.hpp"

namespace drape::bench {

/// Methods with all responses to obstacles.
Job compare_responses(bool quick);

}  // namespace drape::bench
