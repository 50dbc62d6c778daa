#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "solver/counters.hpp"
#include "solver/memory.hpp"
#include "solver/partition.hpp"
#include "solver/state.hpp"
#include "solver/step_forces.hpp"

namespace drape::solver {

/// The orthogonal projector on some of the axes.
inline Eigen::Matrix3d axes(bool x, bool y, bool z) { return Eigen::Vector3d(x, y, z).asDiagonal(); }

/// A particle that moves in some directions with a prescribed velocity instead of obeying the equation of motion.
struct Pin {
  int particle = 0;
  Eigen::Matrix3d held = Eigen::Matrix3d::Identity();  ///< orthogonal projector on these directions
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s], used in these directions

  bool all() const { return held(0, 0) == 1 && held(1, 1) == 1 && held(2, 2) == 1; }  // a projector of trace 3
  /// Whether the coordinate c is prescribed by itself.
  bool fixed(int c) const { return held.col(c) == Eigen::Vector3d::Unit(c); }
  /// Whether directions are held that are not those of axes.
  bool oblique() const { return held != axes(fixed(0), fixed(1), fixed(2)); }
  /// Orthogonal projector on the directions that are not held.
  Eigen::Matrix3d free() const { return Eigen::Matrix3d::Identity() - held; }
  /// Velocity in the held directions [m/s].
  Eigen::Vector3d prescribed() const { return held * velocity; }
};

class PairSearch;

/// A half-space that a particle must not leave in the next step: at its end <x, n> ≥ `least`.
struct Contact {
  int particle = 0;
  int obstacle = 0;        ///< identifies a particle's contact from step to step
  Eigen::Vector3d normal;  ///< n at the end of the step: unit, away from the obstacle
  double gap = 0;          ///< distance from the collision area at the beginning of the step [m], negative inside
  double least = 0;        ///< [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< w of the obstacle's surface, mean over the step [m/s]
  double friction = 0;                                 ///< η, Coulomb's coefficient
  bool alters = false;  ///< whether the particle stops at once and goes to the border by dx/dt = v + c (ContactResponse)
};

/// An energy ½ C²/α of a function C of the positions of two or three particles, as methods need it that move positions towards
/// C = 0   [Macklin, Müller, Chentanez 2016].
struct CompliantConstraint {
  enum class Kind {
    distance,  ///< C = |x1 − x0| − rest [m]
    angle,     ///< C = <x1 − x0, x2 − x0> − rest [m²]
  } kind;
  std::array<int, 3> particles;  ///< of x0, x1, x2; the last is not used by `distance`
  double rest;                   ///< [m], of angles [m²]
  double compliance;             ///< α [m/N], of angles [m³/N], positive
};

/// The part of the Jacobian in a Newton matrix.
enum class Jacobian {
  whole,
  tension,  ///< without terms that couple more than the two ends of an edge: several times cheaper
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

  /// The compliant constraints whose energies are part of the potential energy, in a fixed order; absent: there are none.
  std::function<std::vector<CompliantConstraint>()> compliant_constraints;
  Force unconstrained_force;  ///< force without theirs; absent: that is all of it

  /// Potential energy [J] of the conservative forces, without what memory stores.
  std::function<double(double t, const Vectors& x)> potential_energy;

  /// Null if no force remembers the motion. Else forces are those of the state that it has passed last, or of a path from
  /// there.
  std::shared_ptr<Memory> memory;

  /// Null if no forces are found at the beginnings of steps.
  std::shared_ptr<StepForces> step_forces;

  /// Adds to the force f(t, (x0 + x1)/2, v) what the mean force between these positions has more: a discrete gradient, whose
  /// work along x1 − x0 is the potential energy that is lost, and which keeps both momenta that the force keeps. Absent:
  /// nothing, as where energies are quadratic.
  std::function<void(double t, const Vectors& x0, const Vectors& x1, Vectors& f)> mean_excess;

  /// Names of the elastic forces that have no such mean, as where they are not the gradient of an energy.
  std::vector<std::string> without_energy;

  /// ∂f/∂x and ∂f/∂v of the whole force, 3N × 3N; coordinate c of particle i has the index 3i + c.
  std::function<void(double t, const Vectors& x, const Vectors& v, SparseMatrix& df_dx, SparseMatrix& df_dv)> jacobian;

  /// Sets the upper triangle of J ≈ M − γ² ∂f/∂x − γ ∂f/∂v, 3N × 3N, for a Newton method: positive definite, because negative
  /// curvature of single elements is left out; pinned coordinates have only their mass. J: empty, or the result of an earlier
  /// call for the same part.
  std::function<void(double t, const Vectors& x, const Vectors& v, double gamma, Jacobian part, SparseMatrix& J)> newton_matrix;

  /// Finds the possible contacts of a step from t to t + h, ordered by particle; absent: there are no obstacles.
  std::function<void(double t, double h, const State& y, std::vector<Contact>& found)> contacts;

  /// A response to obstacles after a step from (t, y0) to (t + h, y1): changes y1; false if nothing touches. Pins are put right
  /// by the caller. Absent: there is none.
  std::function<bool(double t, double h, const State& y0, State& y1)> relocate;

  std::shared_ptr<PairSearch> pairs;  ///< finds where the cloth meets itself; null: it passes through itself

  /// Whether obstacles or the cloth itself stop its motion, which is not smooth then.
  bool has_contacts() const { return contacts || pairs; }

  /// Where processes share the particles out: how. Then products with K and D are not those of the whole on copies.
  std::shared_ptr<const Partition> partition = Partition::of_one_process();

  std::shared_ptr<Counters> work = std::make_shared<Counters>();

  double* response_ms = nullptr;  ///< if given, the wall time of the response to contacts is added there, detection apart

  int particles() const { return static_cast<int>(mass.size()); }
};

/// Kinetic energy ½ Σ m v² [J].
double kinetic_energy(const SplitOde& ode, const Vectors& v);

/// Potential energy with what memory and the forces of the last step store [J].
double stored_energy(const SplitOde& ode, double t, const State& y);

/// Sets the prescribed velocities in v.
void prescribe(const std::vector<Pin>& pins, Vectors& v);

/// Removes what a residual, force or acceleration has in the directions of the pins.
void filter(const std::vector<Pin>& pins, Vectors& r);

/// Forces of the pins on their particles [N], N × 3: M dv/dt - f, where dv/dt = 0 since prescribed velocities are constant;
/// 0 in the free directions.
Vectors reactions(const SplitOde& ode, double t, const State& y);

}  // namespace drape::solver
