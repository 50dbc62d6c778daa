#pragma once

#include <Eigen/Dense>

namespace drape::reference {

/// A square sheet held along its edge X = 0 and sheared by a body force along that edge: experiment (b) of
/// [Etzmuß 2002, fig. 2.11].
struct SideloadedSheet {
  double side = 1;         ///< L [m]
  double modulus = 1e9;    ///< k [N/m], tension modulus both ways
  double shear = 100;      ///< G [N/m]
  double body_force = 10;  ///< f [N/m²], towards +y
};

/// The limit k → ∞, (x, y) [m]: y = Y + (f/G) (L X − X²/2), x = ∫ √(1 − y'²) dX; for 0 < f L ≤ G. The shear stress f (L − X)
/// does not end at the free edges Y = 0, L: their fibres bear it, pulled on one side and pushed on the other by f (L − X)²/2.
Eigen::Vector2d inextensible_position(const SideloadedSheet& sheet, double X, double Y);

/// The equilibrium s(X, Y) = (x, y) [m] for finite k, 0 ≤ X, Y ≤ L: the minimum of
///   ∫ ½ k (|s_u| − 1)² + ½ k (|s_v| − 1)² + ½ G <s_u, s_v>² − f y  [Etzmuß 2002, (2.17–2.19), conservative shear]
/// with s(0, Y) = (0, Y), by polynomial elements graded to all edges and corners; free edges are natural to it.
///
/// For large k the border fibres of the limit become layers of the width L √(G/k) with a stress of the order f L √(k/G), which
/// at the corners (0, 0) and (0, L) of the held edge grows without bound, like its (2/π) log(L/r). Where the push exceeds about
/// G the energy is not elliptic: the fibres buckle in the plane, the finer the mesh the shorter, and there is no solution to
/// converge to. So the problem is well posed only as far as
///   β = f √(k/G)/(G/L) « 1,  down to r ~ L exp(−π/2β).
/// Measured for G = 100 N/m, L = 1 m, degree 6, smallest elements 3·10⁻⁴ L: for f = 1 N/m² all is well up to k = 10⁵ (β = 0.3);
/// with k = 10⁶ it buckles there, not yet with elements of 8·10⁻⁴ L. For f = 10 (the thesis) k = 300 is well, k = 100, so soft
/// that the corner is crushed, buckles with elements of 8·10⁻⁴ L, k = 10³
/// with elements of 5·10⁻³ L and k = 10⁴ with any. With k = 10⁹ no mesh resolves the layers, of 3·10⁻⁴ L: what it then yields
/// is near the limit, but converges to nothing. So: f = 1 and k ≤ 10⁵ for orders; f = 10 and the limit for the thesis' picture.
/// A grid has the order 2 where it resolves the layers, L/n « L √(G/k).
class ShearedSheet {
 public:
  /// Throws std::runtime_error if Newton's method meets no minimum: the sheet buckles. `degree` of the polynomials, at least 4;
  /// 2·`levels` elements each way, at least 4, which shrink towards the edges by 0.4. Half a second with the defaults.
  explicit ShearedSheet(const SideloadedSheet& sheet, int degree = 7, int levels = 6);

  Eigen::Vector2d operator()(double X, double Y) const { return surface_(X / side_, Y / side_); }

  /// Estimate of the error [m]: greatest distance, at 33 × 33 points, to the solution with two degrees and one level less,
  /// which is more than the error of this one. With the defaults 4·10⁻⁸ m for f = 1 N/m², k = 100 N/m, 3·10⁻⁸ m for k = 10⁴
  /// N/m.
  double error() const { return error_; }

  /// Polynomials on the rectangles between the lines u, v = breaks of the unit square, given by their values at the nodes;
  /// node (i, j), i along u, has the row i + lines j.
  struct Surface {
    Eigen::VectorXd breaks, nodes;
    Eigen::MatrixX2d values;

    Surface(int degree, int levels);
    int lines() const { return static_cast<int>((breaks.size() - 1) * (nodes.size() - 1)) + 1; }
    Eigen::VectorXd coordinates() const;  ///< of all lines of nodes
    Eigen::Vector2d operator()(double u, double v) const;
  };

 private:
  ShearedSheet(const SideloadedSheet& sheet, Surface surface, const Surface& coarser);

  double side_;
  Surface surface_;
  double error_ = 0;
};

}  // namespace drape::reference
