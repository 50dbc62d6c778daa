#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/scene.hpp"
#include "results/file/motion_file.hpp"

namespace drape::bench {

/// The motion of another simulator, its vertices put in the order of our particles.
struct ExternalMotion {
  std::string name;                   ///< of the file, or of the first and the last one
  int vertices = 0;                   ///< of a frame, including those that are not particles
  std::vector<double> times;          ///< [s], from 0 on
  std::vector<solver::State> states;  ///< velocities by difference() if `differenced`
  bool differenced = false;           ///< there were no velocities
};

/// Reads one HDF5 file, or meshes, one a frame, `frame_time` [s] apart; a process of its own does it, since damaged files crash
/// the libraries. Vertices are matched to the particles of the scene by where they are in the first frame. Throws
/// std::invalid_argument with what is wrong and what would be right.
ExternalMotion read_external_motion(const std::vector<std::string>& files, std::optional<double> frame_time,
                                    const model::Scene& scene);

/// For each particle the vertex that is where it starts. Vertices that belong to none are allowed. Throws std::invalid_argument
/// if a particle has none within 1 % of the shorter spacing, or shares it.
std::vector<Eigen::Index> match(const solver::Vectors& vertices, const solver::Vectors& particles, const model::Grid& grid);

}  // namespace drape::bench
