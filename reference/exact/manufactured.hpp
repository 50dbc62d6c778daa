#pragma once

#include <Eigen/Core>
#include <vector>

/// Manufactured solutions of the continuum model [Etzmuß 2002, 2.1–2.3]: choose any smooth moving surface; what is left over
/// when it is inserted into the equation of motion is the body force and the load on the borders that make it the solution.
/// All that is generated: derivatives of the surface from its building blocks, the divergence of the stress by automatic
/// differentiation of the stress itself.
namespace drape::reference {

// --- Surfaces with all their derivatives -----------------------------------------------------------------------------------

/// f(x) = Σ c_k x^k + a sin(ω x + φ).
struct Function {
  std::vector<double> coefficients;  ///< c_0, c_1, …
  double amplitude = 0, frequency = 0, phase = 0;

  /// The n-th derivative.
  double operator()(double x, int n = 0) const;
};

/// ∂^(i + j)/∂u^i ∂v^j of a vector field at one point, for i + j ≤ 4.
struct Jet {
  static constexpr int count = 15;
  Eigen::Matrix<double, 3, count> derivatives = Eigen::Matrix<double, 3, count>::Zero();

  static int index(int i, int j) { return (i + j) * (i + j + 1) / 2 + j; }
  Eigen::Vector3d operator()(int i, int j) const { return derivatives.col(index(i, j)); }
};

/// The field a U(u) V(v).
struct Product {
  Eigen::Vector3d a;
  Function u, v;
};

/// A sum of products that moves as one: T(t) Σ a U(u) V(v).
struct SurfaceMode {
  std::vector<Product> products;
  Function time;
};

/// s(u, v, t) [m] of the parameters u, v [m] and the time [s]: a sum of modes.
using Surface = std::vector<SurfaceMode>;

/// What the equation of motion asks of a surface at one point and time.
struct MovingJet {
  Jet s;                         ///< of the positions
  Jet rate;                      ///< of the velocities
  Eigen::Vector3d acceleration;  ///< [m/s²]
};

/// A point of a surface. Its jets in space are evaluated once, so that a new time costs little.
class SurfacePoint {
 public:
  SurfacePoint(const Surface& surface, double u, double v);

  MovingJet at(double t) const;

 private:
  std::vector<Jet> jets_;
  std::vector<Function> times_;
};

// --- The continuum ---------------------------------------------------------------------------------------------------------

/// A modulus in the weft (u) and in the warp (v) direction.
struct Directional {
  double u = 0, v = 0;
};

enum class Bending {
  membrane,         ///< <N, B1 s_uu + B2 s_vv> N   (2.24)
  plate,            ///< −(B1 s_uuuu + (B1 + B2) s_uuvv + B2 s_vvvv)
  projected_plate,  ///< the same along the normal N   (2.26) with the sign that removes energy
};

/// Moduli of the continuum with their viscous counterparts.
struct ContinuumMaterial {
  double density = 1;              ///< ρ [kg/m²]
  Directional tension;             ///< k1, k2 [N/m]
  Directional linear_damping;      ///< d1, d2 [N s/m] of d s_tu, d s_tv: the form of chapter 3
  Directional projected_damping;   ///< d1, d2 [N s/m] of the strain rates (2.28)
  double shear = 0;                ///< G [N/m]
  double shear_damping = 0;        ///< dG [N s/m]
  double contraction = 0;          ///< C12 [N/m]
  double contraction_damping = 0;  ///< d12 [N s/m]
  Directional bend;                ///< B1, B2: [N/m] for the membrane, [N m] for plates
  Directional bend_damping;        ///< dB1, dB2: [N s/m] or [N m s]
  Bending bending = Bending::plate;
};

/// Forces a length that the sheet transmits across lines u = const and v = const [N/m].
struct Stress {
  Eigen::Vector3d p_u, p_v;
};

/// The stress of (2.18, 2.22, 2.28) in the form that is differenced, div P = ∂u p_u + ∂v p_v (2.19). The shear is the
/// conservative one, p_u = σ12 s_v and p_v = σ12 s_u, and the linear damping of chapter 3 is added as p_u = d1 s_tu.
Stress stress(const ContinuumMaterial& material, const MovingJet& jet);

/// The body force b = ρ s_tt − div P − f_bend [N/m²] that makes the surface move as it does.
Eigen::Vector3d body_force(const ContinuumMaterial& material, const MovingJet& jet);

/// The part of the domain that belongs to a node: widths along u and v [m], and on which border it lies: −1 on the lower, 1 on
/// the upper, 0 on none.
struct DualCell {
  double width_u, width_v;
  int side_u, side_v;
};

/// What must be added to the forces of the sheet on a node [N].
struct NodeLoad {
  Eigen::Vector3d force;    ///< body force and tractions on the cell
  Eigen::Vector3d bending;  ///< edge and corner forces of plates, before their projection onto the normal if there is one
};

/// The load on the dual cell of a node with free borders, by the rule of one point. The bending moment B1 s_uu on borders
/// u = const and B2 s_vv on borders v = const is not part of it: the surface must have none there.
NodeLoad node_load(const ContinuumMaterial& material, const MovingJet& jet, const DualCell& cell);

}  // namespace drape::reference
