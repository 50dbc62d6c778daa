#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "model/adaptive/edge_mesh.hpp"
#include "model/adaptive/face_projection.hpp"
#include "solver/state.hpp"

namespace drape::model {

/// Points nearer to a plane than this lie on it [m].
inline constexpr double on_plane = 1e-12;

/// The space in front of a face of a sheet: above its plane and between the planes that separate it from its neighbours.
///
/// Faces with a common edge compute distances from the plane between them that differ in sign alone, to the last bit, so that
/// both cut a segment at the same point.
class FacePrism {
 public:
  /// The planes: that of the face, and those through its edges from corner k to the next.
  static constexpr int base = 0, first_side = 1, planes = 4;

  /// `x`: positions of the nodes, N × 3 [m].
  FacePrism(const EdgeMesh& sheet, const solver::Vectors& x, int face);

  const FaceProjection& projection() const { return projection_; }

  /// Distances from the planes, positive inside, 0 for points that lie on them [m].
  Eigen::Vector4d distances(const Eigen::Vector3d& point) const;

  /// A part of a segment, from 0 to 1.
  struct Part {
    double begin = 0, end = 1;
    int begin_plane = -1, end_plane = -1;  ///< that cut the segment; −1: it ends there itself
  };

  /// The part of a segment inside, from the distances of its ends: nothing if that is a point or not above the face. A segment
  /// in a plane between two faces is inside both prisms.
  static std::optional<Part> clip(const Eigen::Vector4d& from, const Eigen::Vector4d& to);

  /// The sides of the part of a triangle inside, from the distances of its corners, as bits: 1 << k for the side of the
  /// triangle from corner k to the next, 8 << k for one on plane k. 0 if it is nowhere above the face.
  static unsigned sides_inside(const std::array<Eigen::Vector4d, 3>& corners);

 private:
  struct Plane {
    Eigen::Vector3d origin, normal;
    double sign;  ///< −1: the normal points outward
  };

  std::array<Plane, planes> planes_;
  FaceProjection projection_;
};

}  // namespace drape::model
