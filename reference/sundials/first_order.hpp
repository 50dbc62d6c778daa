#pragma once

#include "reference/sundials/coordinates.hpp"
#include "solver/filter.hpp"

namespace drape::reference {

/// The split of the equation of motion: K x + D v is linear, f_expl the remainder [Etzmuß 2002, (3.20)].
enum class Part { whole, linear, remainder };

/// The split equation of motion as  dy/dt = g(t, y)  for a general ODE solver.
///
/// y = (positions [m], velocities [m/s]) of all coordinates with the internal variables, as forces read them: nothing is
/// gathered or scattered. Pinned coordinates have no acceleration, so that they keep their prescribed velocities and move
/// linearly, which every method reproduces to round-off; they are not unknowns. dx/dt = v belongs to the linear part. The ODE
/// must outlive this object. Evaluations throw std::runtime_error if the result is not finite.
class FirstOrderOde {
 public:
  /// Throws std::invalid_argument if the state does not fit the ODE, or if all coordinates are pinned.
  FirstOrderOde(const solver::SplitOde& ode, const solver::State& start, double t0);

  /// Positions and velocities of the n free coordinates, 2n, in the order of their index 3i + c: the unknowns of Newton's
  /// matrix.
  int size() const { return 2 * static_cast<int>(coordinates_.free.size()); }

  /// All unknowns: these and the internal variables.
  int unknowns() const { return size() + static_cast<int>(start_.z.size()); }

  /// The start with the prescribed velocities.
  const solver::State& initial() const { return start_; }

  /// A solution at time t [s], with pinned coordinates rounded as x0 + w (t - t0).
  solver::State output(double t, solver::State y) const;

  /// Sets dy/dt, or one part of it.
  void derivative(double t, const solver::State& y, solver::State& dy, Part part = Part::whole) const;

  /// ∂g/∂y = [0 I; M⁻¹ ∂f/∂x  M⁻¹ ∂f/∂v], 2n × 2n, of the whole or of the linear part. Every diagonal entry is stored, so
  /// that I - γ ∂g/∂y has the same pattern.
  /// Valid until the next call, and known until then.
  const WideSparseMatrix& known_jacobian() const { return scratch_.jacobian; }
  const WideSparseMatrix& jacobian(double t, const solver::State& y, Part part = Part::whole) const;

  const solver::SplitOde& ode() const { return ode_; }

  /// The unknowns of a state but the internal variables.
  Eigen::VectorXd gather(const solver::State& y) const;

  /// Sets the unknowns of a state.
  void scatter(const Eigen::VectorXd& unknowns, solver::State& y) const;

 private:
  /// What evaluations would otherwise allocate; it makes them unfit for several threads.
  struct Scratch {
    solver::Vectors damping = {};
    solver::SparseMatrix df_dx = {}, df_dv = {};
    WideSparseMatrix jacobian = {};
  };

  const solver::SparseMatrix& stiffness() const;  ///< K of now
  void evaluate(double t, const solver::State& y, Part part, solver::Vectors& f) const;
  void derive_memory(double t, const solver::State& y, Part part, Eigen::VectorXd& dz) const;
  void update_derivatives(double t, const solver::State& y, Part part) const;

  /// Hands all entries of ∂g/∂y to add(row, column, value), in the order in which they are stored.
  template <class Add>
  void for_entries(const Add& add) const;

  const solver::SplitOde& ode_;
  Coordinates coordinates_;
  solver::State start_;  ///< with the prescribed velocities
  double t0_;
  solver::Vectors inverse_mass_;  ///< N × 3, [1/kg], 0 in the pinned coordinates
  solver::ObliquePins oblique_;
  solver::SparseMatrix free_;  ///< their projector; empty without any
  mutable Scratch scratch_;
};

}  // namespace drape::reference
