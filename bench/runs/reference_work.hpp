#pragma once

#include <chrono>
#include <functional>
#include <limits>

#include "model/cloth.hpp"
#include "reference/reference.hpp"

namespace drape::bench {

/// While references are computed.
struct ReferenceWatch {
  double seconds = std::numeric_limits<double>::infinity();  ///< wall time for all references together
  std::function<void(const std::string&)> say = {};          ///< how far the motions have come; may be empty
};

/// A reference of a scene's motion, by two threads. Every 0.2 s from the fourth second on it says where they are and how long
/// they will take, from either thread. `seconds`: as long as it may take; `watch.seconds` is what messages name. Throws
/// reference::ReferenceError, also where it is out of time, and Interrupted.
reference::Reference compute_reference(const model::Scene& scene, const model::Cloth& cloth, const std::vector<double>& times,
                                       const reference::SolveOptions& options, const ReferenceWatch& watch, double seconds);

}  // namespace drape::bench
