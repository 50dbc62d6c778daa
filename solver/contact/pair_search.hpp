#pragma once

#include <array>
#include <tuple>
#include <vector>

#include "solver/state.hpp"

namespace drape::solver {

/// Two points of a cloth, or of a cloth and a body, that come near each other: of a face and a vertex, or of two edges. Points
/// of bodies are numbered after the particles of the cloth.
struct PairContact {
  /// Nearest points of the pair.
  struct Points {
    Eigen::Vector4d weights;  ///< Σ w x is the vector from the second point to the first [m]; their sum is 0
    Eigen::Vector3d normal;   ///< unit, along it
    double distance;          ///< [m]

    /// Whether both lie inside: not on the border of the face, nor at the end of an edge.
    bool is_inside() const { return (weights.array() != 0).all(); }

    /// Σ w <v, n>: how fast the distance grows, or what it is along n if v are positions.
    double along_normal(const std::array<int, 4>& of, const Vectors& v) const {
      return (weights[0] * v.row(of[0]) + weights[1] * v.row(of[1]) + weights[2] * v.row(of[2]) + weights[3] * v.row(of[3]))
          .dot(normal);
    }
  };
  std::array<int, 4> particles;
  bool edges;       ///< whether it is one of two edges
  Points begin;     ///< when the step begins, or where renew() was asked for
  Points touch;     ///< when the step ends, if that is on the same side, else when they have come as near as was asked for
  double keeps;     ///< distance that is to be kept [m]
  double friction;  ///< Coulomb's coefficient μ

  /// The order of pairs in this program; those of one vertex follow each other.
  auto order() const { return std::tie(edges, particles); }
};

/// For each of some ordered pairs whether it is one of a vertex that is nearest to the border of a face, while it is inside
/// above a neighbour of that face. Such a pair asks for nothing that is missing, and its tilted normal would stop a vertex that
/// slides. `points`: PairContact::begin or touch.
std::vector<char> on_borders(const std::vector<PairContact>& pairs, PairContact::Points PairContact::*points);

/// Points of bodies, M × 3 each [m].
struct BodyPoints {
  Vectors begin, end;  ///< of the step
};

/// Finds the pairs of a cloth that come near each other, or near bodies.
class PairSearch {
 public:
  virtual ~PairSearch() = default;

  /// Sets where bodies are when a step begins, at t, and when it ends.
  virtual void begin(double t, double h) = 0;

  /// Where they are; they move uniformly.
  virtual const BodyPoints& bodies() const = 0;

  /// Whether pairs rub on each other.
  virtual bool rubs() const = 0;

  /// Sets `found` to the pairs whose distance falls below `part` of what they keep while particles move uniformly from x0 to
  /// x1; those that begin nearer only if they do not end farther apart than they began. Ordered, and without those of
  /// on_borders().
  virtual void find(const Vectors& x0, const Vectors& x1, double part, std::vector<PairContact>& found) = 0;

  /// Sets `begin` of these pairs to the nearest points where particles are at x and bodies where the step ends.
  virtual void renew(const Vectors& x, std::vector<PairContact>& pairs) const = 0;
};

}  // namespace drape::solver
