#pragma once

#include <vector>

#include "model/cloth.hpp"

namespace drape::model {

/// The parts of a scene's time in which gravity and seams stay as they are and pins move uniformly, each as a scene with a
/// beginning and an end. A scene without phases and paths is its only one.
std::vector<Scene> phases(const Scene& scene);

/// The cloth of a phase that follows another.
struct NextPhase {
  Cloth cloth;
  double lost;  ///< kinetic energy by merging particles that move differently [J]
};

/// Compiles a phase from the state that the one before has at its end. Particles that a seam merges keep their momentum;
/// counters go on.
NextPhase compile_next(const Scene& phase, const Cloth& before, const solver::State& y);

}  // namespace drape::model
