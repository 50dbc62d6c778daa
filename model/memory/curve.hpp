#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace drape::model {

/// A continuous function through points with increasing arguments: piecewise affine, or smooth and as monotonic as the points.
/// Beyond its ends it goes on with the slopes that it has there.
class Polyline {
 public:
  using Point = std::array<double, 2>;

  Polyline() = default;
  explicit Polyline(std::vector<Point> points) : points_(std::move(points)) {}

  const std::vector<Point>& points() const { return points_; }
  bool empty() const { return points_.empty(); }

  /// The same points with cubic pieces and continuous slopes   [Fritsch, Butland 1984].
  Polyline smoothed() const;

  /// At least two points.
  double value(double x) const;
  double slope(double x) const;
  double chord_slope(double x) const;  ///< between the points about x

  /// Which of the pieces that join with a kink, from 0 on.
  int straight_piece(double x) const { return slopes_.empty() ? static_cast<int>(piece(x)) : 0; }

  /// From the first point to x.
  double integral(double x) const;

  bool operator==(const Polyline&) const = default;

 private:
  std::size_t piece(double x) const;
  double length(std::size_t k) const { return points_[k + 1][0] - points_[k][0]; }
  double chord(std::size_t k) const { return (points_[k + 1][1] - points_[k][1]) / length(k); }  ///< slope of a piece
  double integral_of_piece(std::size_t k, double x) const;

  std::vector<Point> points_;
  std::vector<double> slopes_;  ///< at the points; empty: piecewise affine
};

/// A measured curve of stress over strain [Etzmuß 2002, 2.1.3]: on its loading branch σ = L(ε) where the strain is the largest
/// ever, ε_m; else on the unloading branch σ = L(ε_m) u(ε/ε_m), which joins it at ε_m and is taken in both directions. u
/// vanishes up to the residual strain over ε_m. Compression follows the first slope of L. (The thesis does not say how branches
/// join.)
struct StressCurve {
  Polyline loading;    ///< L [N/m], from (0, 0)
  Polyline unloading;  ///< u, from (residual part, 0) to (1, 1); empty: what is loading is unloading as well

  bool given() const { return !loading.empty(); }

  double stress(double strain, double largest) const;

  /// dσ/dε of the branch on which the strain is [N/m], and that of the piece between two of its points.
  double slope(double strain, double largest) const;
  double branch_slope(double strain, double largest) const;

  /// Where the strain is, and whether it grows: two that differ have a kink in between.
  int branch(double strain, bool grows, double largest) const;

  StressCurve smoothed() const;

  /// What can be got back on the way to zero strain [J/m²].
  double recoverable(double strain, double largest) const;

  bool operator==(const StressCurve&) const = default;

 private:
  template <class Slope>
  double slope_by(const Slope& slope_of, double strain, double largest) const;
  bool unloads(double strain, double largest) const { return !unloading.empty() && strain >= 0 && strain < largest; }
};

}  // namespace drape::model
