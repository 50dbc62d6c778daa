#pragma once

#include <array>
#include <vector>

#include "solver/state.hpp"

namespace drape::solver {

/// Two points of a cloth that come near each other: of a face and a vertex, or of two edges.
struct PairContact {
  /// Nearest points of the pair.
  struct Points {
    Eigen::Vector4d weights;  ///< Σ w x is the vector from the second point to the first [m]; their sum is 0
    Eigen::Vector3d normal;   ///< unit, along it
    double distance;          ///< [m]

    /// Σ w <v, n>: how fast the distance grows, or what it is along n if v are positions.
    double along_normal(const std::array<int, 4>& of, const Vectors& v) const {
      return (weights[0] * v.row(of[0]) + weights[1] * v.row(of[1]) + weights[2] * v.row(of[2]) + weights[3] * v.row(of[3]))
          .dot(normal);
    }
  };
  std::array<int, 4> particles;
  bool edges;    ///< whether it is one of two edges
  Points begin;  ///< when the step begins
  Points touch;  ///< when they have come as near as was asked for, or at the end if they only have come nearer
};

/// Finds the pairs of a cloth that come near each other.
class PairSearch {
 public:
  virtual ~PairSearch() = default;

  /// Distance that is to be kept [m].
  virtual double thickness() const = 0;

  /// Sets `found` to the pairs whose distance falls below `distance` [m] while particles move uniformly from x0 to x1; those
  /// that begin nearer only if they do not end farther apart than they began.
  virtual void find(const Vectors& x0, const Vectors& x1, double distance, std::vector<PairContact>& found) = 0;

  /// Sets the nearest points of these pairs where particles are at x, as at the beginning of a step.
  virtual void renew(const Vectors& x, std::vector<PairContact>& pairs) const = 0;
};

}  // namespace drape::solver
