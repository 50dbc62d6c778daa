#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace drape::model {

/// A particle that exists in one step only and lies on an edge of an obstacle [Etzmuß 2002, 5.2].
struct VirtualParticle {
  Eigen::Vector3d position;  ///< [m]
  int edge;                  ///< of the obstacle
  double parameter;          ///< along the edge, from 0 to 1
};

/// A particle in a face of the sheet. Nodes of the sheet keep their numbers, virtual particles follow them.
struct FacePoint {
  int particle;
  Eigen::Vector3d barycentric;  ///< exactly 0 for the corner opposite to an edge on which the particle lies
};

/// A part of an edge of the obstacle that is inserted into a face.
struct FaceSegment {
  std::array<int, 2> ends;           ///< particles; a node only where an edge passes over it
  int edge;                          ///< of the obstacle
  std::array<double, 2> parameters;  ///< of the ends along the edge
  double ratio;                      ///< for lift(), from the first end to the second
};

/// Points and segments that are inserted into a face.
struct HitFace {
  int face;
  std::vector<FacePoint> points;            ///< also those on its edges; no corners
  std::array<std::vector<int>, 3> borders;  ///< virtual particles on its edges, in order from corner k to the next
  std::vector<FaceSegment> segments;        ///< except those along its edges
};

/// Virtual particles on an edge of the sheet.
struct HitEdge {
  int edge;                        ///< of EdgeMesh
  std::vector<int> particles;      ///< in order from the first end to the second
  std::vector<double> parameters;  ///< along the edge, increasing, between 0 and 1
};

/// Everything that is inserted into a sheet in a step. Faces with a common edge share the particles on it.
struct Insertion {
  std::vector<VirtualParticle> particles;
  std::vector<HitFace> faces;  ///< in the order of their numbers
  std::vector<HitEdge> edges;  ///< in the order of their numbers
};

}  // namespace drape::model
