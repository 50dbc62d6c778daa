#pragma once

namespace drape::reference {

/// A sheet fixed along one edge and pulled away from it by a body force: experiment (a) of [Etzmuß 2002, fig. 2.11].
struct PulledSheet {
  double length = 1;         ///< L [m], from the fixed to the free edge
  double modulus = 1e4;      ///< k [N/m], tension modulus along the pull
  double body_force = 9.81;  ///< f [N/m²]
};

/// Where the material point at the distance X [m] from the fixed edge, 0 <= X <= L, is in equilibrium:
///   s = X + (f/k) (L X - X²/2)   [m, from the fixed edge],
/// the solution of d/dX (k (|s'| - 1)) + f = 0, s(0) = 0, s'(L) = 1   [Etzmuß 2002, (2.10, 2.19)]. The masses and springs of
/// a grid with dual-cell masses have the same equilibrium at the nodes, without any error of discretisation.
inline double pulled_position(const PulledSheet& sheet, double X) {
  const auto [L, k, f] = sheet;
  return X + f / k * (L * X - X * X / 2);
}

}  // namespace drape::reference
