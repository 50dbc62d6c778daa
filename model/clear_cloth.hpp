#pragma once

#include "model/scene.hpp"

namespace drape::model {

/// Throws std::invalid_argument in one line, which names panels and cells, unless cloth that meets itself, or bodies between
/// its particles, can do so. Its thickness is at most half of the smallest altitude of its triangles, else neighbours would
/// push each other. It does not begin through itself or a body, nor nearer to itself than its thickness.
void require_clear_cloth(const Scene& scene);

}  // namespace drape::model
