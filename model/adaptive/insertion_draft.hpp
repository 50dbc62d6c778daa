#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <memory_resource>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "model/adaptive/edge_mesh.hpp"
#include "model/adaptive/face_prism.hpp"
#include "model/adaptive/insertion.hpp"
#include "solver/base/hash.hpp"

namespace drape::model {

/// Prisms of the faces of a sheet at a time, computed when they are first needed.
class FacePrisms {
 public:
  /// `x`: positions of the nodes, N × 3 [m]. Both have to outlive this object.
  FacePrisms(const EdgeMesh& sheet, const solver::Vectors& x) : sheet_(sheet), x_(x), places_(sheet.triangles().size(), -1) {}

  const EdgeMesh& sheet() const { return sheet_; }
  const solver::Vectors& x() const { return x_; }
  const FacePrism& of(int face) {
    int& place = places_[face];
    if (place < 0) place = static_cast<int>(known_.size()), known_.emplace_back(sheet_, x_, face);
    return known_[place];
  }

  /// The image, in a face, of a point of the plane through one of its edges: along the edge, from its first end at 0 to its
  /// second at 1. Nothing if the point is beyond the centre of projection.
  std::optional<double> along(int face, int edge, const Eigen::Vector3d& point);

 private:
  const EdgeMesh& sheet_;
  const solver::Vectors& x_;
  std::vector<int> places_;      ///< of the faces in `known_`; −1: not there
  std::deque<FacePrism> known_;  ///< as reached, so that references stay valid
};

/// Collects points on edges of an obstacle and joins those that faces share.
class InsertionDraft {
 public:
  /// `memory`: for what is needed until this object ends.
  InsertionDraft(FacePrisms& prisms, std::pmr::memory_resource& memory) : prisms_(prisms), numbers_(&memory) {}

  /// An end of a segment.
  struct End {
    VirtualParticle particle;
    int vertex;   ///< of the obstacle; −1: the edge is cut here
    int plane;    ///< of the prism, on which it lies; −1: none
    bool shared;  ///< if on a plane to a neighbour: that one sees it as well
  };

  /// Adds a segment of an edge of the obstacle to a face.
  void add(int face, const End& from, const End& to);

  Insertion finish() const;

 private:
  struct Point {
    VirtualParticle particle;
    int face;      ///< of the sheet; −1: shared
    int edge;      ///< of the sheet, in whose separating plane it lies; −1: inside the prism
    double along;  ///< the edge
  };
  struct Segment {
    int face, edge;  ///< of the sheet, of the obstacle
    std::array<int, 2> points;
    std::array<double, 2> parameters;
  };

  /// Face and edge as in Point, and what is there.
  using Key = std::array<int, 3>;
  struct KeyHash {
    std::size_t operator()(const Key& key) const { return base::hash({reinterpret_cast<const char*>(key.data()), sizeof key}); }
  };

  int point(int face, const End& end);
  double along(int edge, const Eigen::Vector3d& position);

  FacePrisms& prisms_;
  std::pmr::unordered_map<Key, int, KeyHash> numbers_;  ///< of points
  std::vector<Point> points_;
  std::vector<Segment> segments_;
};

}  // namespace drape::model
