#pragma once

#include "model/scene.hpp"

namespace drape::bench {

/// Memory that this process may still take [bytes]: what the machine, its control group and its resource limits leave.
double available_memory();

/// Throws model::SceneError if a run of the scene needs more memory than is available, whatever the method.
void require_memory(const model::Scene& scene);

}  // namespace drape::bench
