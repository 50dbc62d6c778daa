#pragma once

#include <filesystem>
#include <vector>

#include "model/obstacles/triangle_mesh.hpp"

namespace drape::verify {

/// Writes a mesh in the format that the name ends in: .obj, .ply, .stl (as text: vertices of their own for each triangle),
/// .gltf (its numbers in a file beside it) or .glb. In the last two the triangles are shared out between two nodes, of which
/// the second is mirrored, below one that scales and shifts.
void write_mesh(const std::filesystem::path& file, const model::TriangleMesh& mesh);

/// Points in a cube around the origin.
std::vector<Eigen::Vector3d> random_points(int count, double extent, unsigned seed);

/// A box around the origin.
model::TriangleMesh box_mesh(const Eigen::Vector3d& size);

/// Vertices 1 and `radius` from the origin in turn, as on an octahedron each of whose faces was quartered twice: a sphere where
/// the radius is 1, else with spikes. Coordinates are exact in single precision.
model::TriangleMesh spiky_mesh(double radius);

}  // namespace drape::verify
