#pragma once

#include "bench/runs/recording.hpp"
#include "bench/studies/draping.hpp"

namespace drape::bench {

/// The block of table 3.2 with the dress.
Job dress_block(bool quick);

}  // namespace drape::bench
