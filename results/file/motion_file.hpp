#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "solver/state.hpp"

namespace drape::results {

/// A motion as simulators exchange it: frames at increasing times.
struct Motion {
  std::vector<double> times;                ///< F [s]
  std::vector<solver::Vectors> positions;   ///< F times N × 3 [m]
  std::vector<solver::Vectors> velocities;  ///< the same [m/s], or none
};

/// A motion that others are measured by.
struct ReferenceMotion {
  std::string scene, families;
  Motion motion;
  std::vector<double> uncertainty;  ///< F, of the positions: root mean square over the particles [m]
};

/// The HDF5 file of a reference; its layout is in results/README.md.
std::vector<std::byte> to_bytes(const ReferenceMotion& reference);

/// Reads a motion in the same layout, of which only /time and /positions need to be there, and which one of our own scripts
/// has just written. Throws hdf5::Error.
Motion read_motion(const std::filesystem::path& path);

}  // namespace drape::results
