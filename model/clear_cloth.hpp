#pragma once

#include "model/scene.hpp"

namespace drape::model {

/// Throws std::invalid_argument in one line, which names panels and cells, unless cloth that meets itself can do so: its
/// thickness is at most half of the smallest altitude of its triangles, else neighbours would push each other, it does not
/// begin through itself or nearer than its thickness, and no seams are pulled together, which would press the cloth beside
/// them. Nothing of cloth without thickness.
void require_clear_cloth(const Scene& scene);

}  // namespace drape::model
