#pragma once

#include "solver/state.hpp"

namespace drape::reference {

/// A rectangular sheet of nu × nv particles, pinned all round and stretched, flat in the xy plane: u along x, v along y.
/// Weft (1) is along u, warp (2) along v; moduli as in the model.
struct PinnedSheet {
  int nu = 2, nv = 2;
  double size_u = 1, size_v = 1;      ///< at rest [m]
  double strain_u = 0, strain_v = 0;  ///< ε0 in each direction
  double density = 1;                 ///< ρ [kg/m²]
  double k1 = 0, k2 = 0;              ///< tension [N/m]
  double contraction = 0;             ///< C12 [N/m]
  double d1 = 0, d2 = 0;              ///< linear damping [N s/m]
  double B1 = 0, B2 = 0;              ///< thin plate [N m]
  double dB1 = 0, dB2 = 0;            ///< its damping [N m s]
  bool plate_projected = true;        ///< the plate's forces are along the normal, or else in all directions
};

enum class Motion { along_u, along_v, transverse };

/// Half waves m along u and n along v, 1 ≤ m ≤ nu − 2 and 1 ≤ n ≤ nv − 2, in one direction.
struct SheetMode {
  int m = 1, n = 1;
  Motion motion = Motion::transverse;
};

/// A mode of the linearised equation of motion, q'' = −ω² q − c q': left alone, its amplitude decays with c/2.
struct LinearMode {
  double kappa;          ///< eigenvalue of −K/ρ [1/s²], the part that the split treats implicitly
  double omega_squared;  ///< the whole ω² [1/s²]
  double damping;        ///< c [1/s]
};

/// The mode of the masses and springs themselves, without error of discretisation. With λ_u = 4/l_u² sin²(π m l_u/2L_u),
/// λ_v in the same way, σ11 = k1 ε_u + C12 ε_v, σ22 = k2 ε_v + C12 ε_u:
///   transverse   ρ ω² = σ11 λ_u/(1+ε_u) + σ22 λ_v/(1+ε_v) + (B1 λ_u + B2 λ_v)(λ_u + λ_v)
///   along u      ρ ω² = k1 λ_u + σ22 λ_v/(1+ε_v), and the plate's part unless it is projected
///   ρ κ = k1 λ_u + k2 λ_v,   ρ c = d1 λ_u + d2 λ_v, and the plate's part, which D does not hold, where there is its force.
/// Shear does not move transverse modes. In-plane modes have this form without shear and contraction only.
/// Throws std::invalid_argument if the grid does not have the mode, or for an in-plane mode with contraction.
LinearMode linear_mode(const PinnedSheet& sheet, const SheetMode& mode);

/// The displacement of all particles, sin(π m u/L_u) sin(π n v/L_v) in the direction of motion: N × 3, u fastest.
solver::Vectors mode_shape(const PinnedSheet& sheet, const SheetMode& mode);

}  // namespace drape::reference
