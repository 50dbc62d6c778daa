#pragma once

#include <Eigen/Dense>

#include "reference/exact/collocation.hpp"

namespace drape::reference {

/// Whether the bending force acts in all directions, the gradient of an energy, or only along the normal
/// [Etzmuß 2002, (2.26)]. At small deflections both agree.
enum class BendingForce { whole, along_normal };

/// A strip of length 1 m bent by its weight, all fields constant across it: experiment (c) of [Etzmuß 2002, fig. 2.11]. One
/// end is held in place, the other in height only, so that it approaches the first; neither end is clamped.
struct BentSheet {
  double modulus = 1e6;   ///< k [N/m], tension modulus
  double bend = 5;        ///< B [N m], plate bending modulus
  double body_force = 1;  ///< f [N/m²], downwards
  BendingForce force = BendingForce::along_normal;
};

/// The equilibrium s(X) = (x, z) [m] of a BentSheet, 0 ≤ X ≤ 1, x from the fixed to the free end, z upwards.
///
/// With the stretch λ = |s'| = 1 + τ/k, the slope θ of the tangent t = (cos θ, sin θ), the normal N and κ = θ',
///   whole:         (τ t − B s''')' = f e_z,                s'' = 0 at both ends, (τ t − B s''')_x = 0 at the free one;
///   along_normal:  (τ t)' − <N, B s''''> N = f e_z,        κ = 0 at both ends, (τ t − <N, B s'''> N)_x = 0 at the free one,
/// the conditions being those to which the discrete forces of model/forces/plate.cpp converge: at the end node as well, its
/// bending force is projected. The tension τ is an unknown of its own, so that the stiffness k costs no digits. `whole` has
/// layers of the width √(B/k) at both ends, in which λ' goes to zero.
class BentStrip {
 public:
  /// Throws std::runtime_error if Newton's method does not converge.
  explicit BentStrip(const BentSheet& sheet);

  Eigen::Vector2d operator()(double X) const { return solution_(X).head<2>(); }

  /// θ [rad], κ [1/m] and τ [N/m] at X.
  Eigen::Vector3d slope_curvature_tension(double X) const;

  /// Estimate of the error of the position [m]: greatest distance to the solution with polynomials of degree 12 instead of 16.
  /// At most 2e-14 for B = 5, 2e-13 for B = 0.01 and 3e-12 for B = 0.005.
  double error() const { return error_; }

 private:
  BentStrip(const BentSheet& sheet, const PiecewisePolynomial& coarser);

  PiecewisePolynomial solution_;
  double error_;
};

}  // namespace drape::reference
