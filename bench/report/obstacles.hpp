#pragma once

#include <nlohmann/json_fwd.hpp>

#include "results/run_record.hpp"

namespace drape::bench {

/// The obstacles of a run with a trajectory, out of its scene as it was recorded: `drawn` has each with the index of its
/// surface (triangles, with vertices of each frame if they deform; appended to `surfaces` unless it is there) and its poses, a
/// position [m] and a quaternion x, y, z, w: one of each frame, or one if it does not move. `missing` says which cannot be
/// drawn, and why: meshes are in files of their own, which may be gone or have changed. `clearance` is the least distance of a
/// particle from them in each frame [m], unless one is missing.
nlohmann::ordered_json page_obstacles(const results::RunRecord& run, nlohmann::ordered_json& surfaces);

/// The meshes that a run with a trajectory has in the place of its grids, null if it has none: of each vertex three particles
/// and their weights, and `triangles`, corners among the vertices. If they cannot be read, `missing` says why.
nlohmann::ordered_json page_trim(const results::RunRecord& run);

/// The sheet with its virtual particles in each frame of a run with a trajectory, null if its scene has none or if an obstacle
/// is missing: positions of virtual particles, the particles to which they are nearest, and triangles, whose corners are
/// particles or, numbered after these, virtual ones.
nlohmann::ordered_json page_refined(const results::RunRecord& run);

}  // namespace drape::bench
