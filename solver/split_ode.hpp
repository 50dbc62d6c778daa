#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "solver/contact.hpp"
#include "solver/counters.hpp"
#include "solver/state.hpp"

namespace drape::solver {

/// A particle some of whose coordinates move with a prescribed velocity instead of obeying the equation of motion.
struct Pin {
  int particle = 0;
  std::array<bool, 3> fixed{true, true, true};
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s], used in the fixed directions

  bool all() const { return fixed[0] && fixed[1] && fixed[2]; }
};

/// Which part of the Jacobian a Newton matrix has.
enum class Jacobian {
  whole,
  tension,  ///< nothing that couples more than the ends of an edge, which makes it several times cheaper
};

/// The split equation of motion  M dv/dt = K x + D v + f_expl(t, x, v),  dx/dt = v   [Etzmuß 2002, (3.20)].
///
/// Forces are in newtons: the densities of the thesis times the area of a particle's dual cell, so that M, K and D are
/// symmetric. K and D are scalar: one N × N matrix serves all three coordinates. The functions *set* their result (N × 3).
struct SplitOde {
  Eigen::VectorXd mass;    ///< N, [kg], positive
  SparseMatrix stiffness;  ///< K, N × N, symmetric negative semidefinite, [N/m]
  SparseMatrix damping;    ///< D, N × N, symmetric negative semidefinite, [N s/m]; no entries if there is none
  std::vector<Pin> pins;   ///< at most one for a particle

  using Force = std::function<void(double t, const Vectors& x, const Vectors& v, Vectors& f)>;
  Force force;           ///< K x + D v + f_expl
  Force explicit_force;  ///< f_expl

  /// Potential energy [J] of the conservative forces.
  std::function<double(double t, const Vectors& x)> potential_energy;

  /// ∂f/∂x and ∂f/∂v of the whole force, 3N × 3N; coordinate c of particle i has the index 3i + c.
  std::function<void(double t, const Vectors& x, const Vectors& v, SparseMatrix& df_dx, SparseMatrix& df_dv)> jacobian;

  /// Sets the upper triangle of J ≈ M − γ² ∂f/∂x − γ ∂f/∂v, 3N × 3N, for a Newton method: positive definite, because negative
  /// curvature of single elements is left out; pinned coordinates have only their mass. J: empty, or what a call for the same
  /// part left.
  std::function<void(double t, const Vectors& x, const Vectors& v, double gamma, Jacobian part, SparseMatrix& J)> newton_matrix;

  /// Finds what particles may touch in a step from t to t + h, ordered by particle; absent: there are no obstacles.
  std::function<void(double t, double h, const State& y, std::vector<Contact>& found)> contacts;

  std::shared_ptr<Counters> work = std::make_shared<Counters>();

  int particles() const { return static_cast<int>(mass.size()); }
};

/// Kinetic energy ½ Σ m v² [J].
double kinetic_energy(const SplitOde& ode, const Vectors& v);

/// Sets the prescribed velocities in v.
void prescribe(const std::vector<Pin>& pins, Vectors& v);

/// Sets the pinned coordinates of a residual, force or acceleration to zero.
void filter(const std::vector<Pin>& pins, Vectors& r);

/// Forces of the pins on their particles [N], N × 3: M dv/dt - f, where dv/dt = 0 since prescribed velocities are constant;
/// 0 in the free coordinates.
Vectors reactions(const SplitOde& ode, double t, const State& y);

}  // namespace drape::solver
