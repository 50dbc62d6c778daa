#pragma once

#include "bench/studies/studies.hpp"

namespace drape::bench {

/// All fabrics, stretched, sheared and bent to and fro.
Job fabric_tests();

/// Strips of all fabrics that hang over an edge.
Job cantilevers();

/// A sample under a load that stays, of several qualities.
Job creep_tests();

}  // namespace drape::bench
