#pragma once

#include <Eigen/Core>
#include <array>

#include "solver/state.hpp"

namespace drape::model {

using solver::Vectors;

/// What is near: a vertex and a face, or two edges.
enum class PairKind { vertex_face, edge_edge };

/// The vertex and the face's corners, or the ends of one edge and of the other [m].
using FourPoints = std::array<Eigen::Vector3d, 4>;

/// The particles of a pair among all at x, N × 3 [m].
inline FourPoints points_of(const std::array<int, 4>& particles, const Vectors& x) {
  return {x.row(particles[0]), x.row(particles[1]), x.row(particles[2]), x.row(particles[3])};
}

/// Nearest points of a vertex and a face, or of two edges.
struct Proximity {
  std::array<int, 4> particles;  ///< the vertex and the face's corners, or the ends of one edge and of the other
  Eigen::Vector4d weights;       ///< Σ w x is the vector from the second nearest point to the first [m]; their sum is 0
  Eigen::Vector3d normal;        ///< unit, along it
  double distance;               ///< [m]

  /// Whether no particle is without weight: neither point lies at the end of an edge or on the border of a face.
  bool is_inside() const { return (weights.array() != 0).all(); }
};

/// Where both are nearest to each other, also if they are parallel or have no area or length. Where they touch the normal is
/// that of the face, or of both edges, or any perpendicular. Particles are numbered from 0 to 3.
Proximity proximity(PairKind kind, const FourPoints& x);

/// The same with other numbers.
Proximity proximity(PairKind kind, const std::array<int, 4>& particles, const FourPoints& x);

}  // namespace drape::model
