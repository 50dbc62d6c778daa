#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "model/obstacles/triangle_mesh.hpp"

namespace drape::model {

/// Where the vertices of a mesh are at a time.
struct KeyVertices {
  double t;          ///< [s]
  std::string name;  ///< for messages
  std::vector<Eigen::Vector3d> vertices;
};

/// A closed mesh whose vertices move uniformly between key times, and are at rest before the first and after the last one.
class MovingMesh {
 public:
  /// At rest, or with its vertices at key times that ascend. Throws std::invalid_argument with the name of the mesh or of the
  /// key vertices unless the mesh is closed, and all its triangles have an area and enclose a volume wherever they are given.
  explicit MovingMesh(TriangleMesh mesh, std::vector<KeyVertices> keys = {});

  bool moves() const { return keys_.size() > 1; }

  /// At the first key time.
  const TriangleMesh& first() const { return first_; }

  const PseudoNormals& normals() const { return normals_; }

  /// The largest coordinate at any time.
  double extent() const { return extent_; }

  /// A time at which its vertices are where they are at t: between the first and the last key time [s].
  double within(double t) const;

  /// Sets its vertices to where they are at a time [s].
  void place(double t, std::vector<Eigen::Vector3d>& vertices) const;

  /// Velocity of a vertex at a time [m/s], after it where that is a key time.
  Eigen::Vector3d velocity(double t, int vertex) const;

  /// Length of the way from the first key time on, on each piece that of the vertex that goes farthest [m]. The surface is
  /// between two times nowhere displaced by more than the difference.
  double way(double t) const;

 private:
  /// Part of the way from a key time to the next.
  struct Moment {
    std::size_t key;
    double part;
  };
  Moment moment(double t) const;

  TriangleMesh first_;
  std::vector<KeyVertices> keys_;  ///< at least one
  PseudoNormals normals_;
  std::vector<double> ways_;  ///< at the key times
  double extent_ = 0;
};

}  // namespace drape::model
