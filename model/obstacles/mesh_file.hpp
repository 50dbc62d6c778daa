#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "model/obstacles/moving_mesh.hpp"
#include "model/obstacles/triangle_mesh.hpp"

namespace drape::model {

inline constexpr std::uintmax_t most_mesh_bytes = 256 << 20;  ///< of a file

/// The triangles of a file that assimp reads (OBJ, PLY, STL, glTF and others; assimp keeps vertices in single precision). All
/// parts of the file are joined, in the place where its nodes put them; vertices in one place are one. Throws
/// std::invalid_argument, naming the file, unless it can be read, its numbers are finite and it has triangles.
TriangleMesh read_mesh(const std::string& file);

/// A mesh with its vertices at key times, or at rest if there are none.
struct KeyedMesh {
  TriangleMesh mesh;
  std::vector<KeyVertices> keys;
};

/// A file with the vertices of a mesh at a time [s].
struct FrameFile {
  double t = 0;
  std::string file;
};

/// The mesh of a file whose vertices move from frame to frame. Throws std::invalid_argument, naming the file, as read_mesh
/// does, and unless all files have the faces of the first and leave together what is one vertex there.
KeyedMesh read_frames(const std::string& file, std::span<const FrameFile> frames);

/// The mesh of a file as an animation moves its nodes and, by linear blend skinning, its bones: sampled from t = 0 to the end
/// of the animation at `rate` [1/s] and at the end. `animation` is its name, or its index in digits. Throws
/// std::invalid_argument, naming the file, as read_mesh does, and unless there is such an animation, which has no morph
/// targets, and vertices that are one at rest stay together.
KeyedMesh read_animation(const std::string& file, const std::string& animation, double rate);

}  // namespace drape::model
