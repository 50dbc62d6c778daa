#pragma once

#include <filesystem>
#include <memory>

#include "bench/runs/run.hpp"

namespace drape::bench {

/// Where runs are written as sequences of meshes that ParaView and Blender open, and how often.
struct Frames {
  std::filesystem::path folder;
  double every = 0.04;  ///< [s] of simulated time, at most one frame a step
};

/// Writes the run that it observes to the folder `scene-method-step`: `sheet-0000.obj`, the sheet or what its scene trims it
/// to, at the start and so on, with `contact.adaptive` also `refined-0000.obj` with its virtual particles, beside the k-th
/// obstacle of the scene, where it is at that time, as `obstacle-k-0000.obj`. Each file begins with its time. Throws
/// base::FileError where a file cannot be written.
std::unique_ptr<Observer> frame_writer(const RunSpec& spec, const Frames& frames);

}  // namespace drape::bench
