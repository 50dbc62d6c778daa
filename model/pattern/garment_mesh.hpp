#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace drape::model {

/// A triangle of a file.
struct MeshFace {
  std::array<int, 3> vertices;  ///< in space
  std::array<int, 3> places;    ///< on the pattern
  int line;                     ///< of the file, or the number of its polygon
};

/// What a file with a mesh has to do with the shape of a garment.
struct GarmentMesh {
  std::string file;                       ///< for messages
  std::vector<Eigen::Vector3d> vertices;  ///< [m]
  std::vector<Eigen::Vector2d> places;    ///< on the pattern [m]; empty: the file has no texture coordinates
  std::vector<MeshFace> faces;
  bool has_lines = true;  ///< whether faces know them

  /// Throws SceneError with the place in the file.
  [[noreturn]] void fail(int line, const std::string& what) const;
};

/// A corner of a polygon of a file.
struct MeshCorner {
  int vertex;
  int place = 0;  ///< among those of the mesh
};

/// Puts triangles of a polygon into a mesh. Throws SceneError with its line unless it has three corners.
void add_polygon(GarmentMesh& mesh, const std::vector<MeshCorner>& corners, int line);

/// Vertices in one place become one: some programs write the corners of every face, or those of every place on the pattern.
void weld(GarmentMesh& mesh);

/// Meshes as files have them. Both throw SceneError, naming the file and the line, if it cannot be read or has no faces.
GarmentMesh read_obj(const std::string& file);

/// PLY, as text or little-endian binary, with texture coordinates s, t or u, v of vertices, or without.
GarmentMesh read_ply(const std::string& file);

}  // namespace drape::model
