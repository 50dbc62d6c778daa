#pragma once

#include <random>

#include "model/scene.hpp"

namespace drape::verify::random_scenes {

/// A small sheet of any material that the model has: moduli, dampings and forms, pins at rest and moved, wind, air, gravity in
/// any direction or none, prestress, pleats, start velocities; one in six meets an obstacle, at rest or moved.
model::Scene random_scene(std::mt19937& random);

}  // namespace drape::verify::random_scenes
