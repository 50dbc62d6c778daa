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

/// An animation of a file and how it is played.
struct AnimationRule {
  std::string name;  ///< or its index in digits; empty: none
  double rate = 60;  ///< at which it is sampled [1/s]
  double start = 0;  ///< its time at t = 0 [s], at least 0
};

/// The mesh of a file as an animation moves its nodes and, by linear blend skinning, its bones: sampled at its rate from its
/// start on and at its end. Throws std::invalid_argument, naming the file, as read_mesh does, and unless there is such an
/// animation, which ends after its start and has no morph targets, and vertices that are one at rest stay together.
KeyedMesh read_animation(const std::string& file, const AnimationRule& animation);

}  // namespace drape::model
