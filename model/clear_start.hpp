#pragma once

#include "model/scene.hpp"

namespace drape::model {

/// Throws std::invalid_argument in one line if cloth begins where contacts could not put it right, or is pulled there by its
/// seams. The line names panel and particles or the seam, the obstacle, and depth [m] and time [s] of the worst place.
///
/// What is inside an obstacle by at most `contact.distance` is right: contacts move it out by the nearest side, which is the
/// one that it came from unless the obstacle is thinner. Deeper places are wrong, and so is each edge or diagonal of a cell
/// that passes through a thinner obstacle, which would push its ends apart. An obstacle wholly between panels is right.
///
/// Not seen: obstacles thinner than an eighth of `contact.distance` or a hundredth of an edge, those between the edges and
/// diagonals of a cell, and seams that are pulled in a phase after the first, whose ways depend on the motion. Particles that
/// are pinned in all directions may be inside, where contacts leave them.
void require_clear_start(const Scene& scene);

}  // namespace drape::model
