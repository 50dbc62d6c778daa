#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "model/obstacles/obstacle.hpp"
#include "model/obstacles/triangle_mesh.hpp"

namespace drape::model {

inline constexpr std::uintmax_t most_mesh_bytes = 256 << 20;  ///< of a file

/// The triangles of a file that assimp reads; vertices in one place are one. Throws std::invalid_argument, naming the file,
/// unless it can be read, its numbers are finite and it has triangles.
TriangleMesh read_mesh(const std::string& file);

/// The closed triangle mesh of a file (OBJ, PLY, STL, glTF and what else assimp reads; assimp keeps vertices in single
/// precision), its coordinates times `scale` giving metres. All parts of the file are joined, in the place where its nodes put
/// them; a mesh that is inside out is turned round. The nearest triangle is found by a bounding-volume hierarchy, the sign of
/// the distance by angle-weighted pseudo-normals [Bærentzen, Aanæs 2005].
/// Throws std::invalid_argument, naming the file, unless it can be read, its numbers are finite, every triangle has an area,
/// every edge belongs to two triangles that agree on which side is outside, and the mesh encloses a volume.
std::unique_ptr<const Shape> mesh_shape(const std::string& file, double scale);

}  // namespace drape::model
