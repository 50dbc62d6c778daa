#pragma once

#include "reference/coordinates.hpp"

namespace drape::reference {

/// The split of the equation of motion: K x + D v is linear, f_expl the remainder [Etzmuß 2002, (3.20)].
enum class Part { whole, linear, remainder };

/// The split equation of motion as  dy/dt = g(t, y)  for a general ODE solver.
///
/// y = (positions [m], velocities [m/s]) of the n free coordinates, in the order of their index 3i + c: 2n numbers. Pinned
/// coordinates are no unknowns: they are at x0 + w (t - t0) with the velocity w, and are put in before every evaluation.
/// dx/dt = v belongs to the linear part. The ODE must outlive this object. Evaluations throw std::runtime_error if the
/// result is not finite.
class FirstOrderOde {
 public:
  /// Throws std::invalid_argument if the state does not fit the ODE, or if all coordinates are pinned.
  FirstOrderOde(const solver::SplitOde& ode, const solver::State& start, double t0);

  /// Length of y, 2n.
  int size() const { return 2 * static_cast<int>(coordinates_.free.size()); }

  /// The free part of the start.
  Eigen::VectorXd initial() const;

  /// All coordinates, the pinned ones included, at time t [s].
  solver::State state(double t, const Eigen::Ref<const Eigen::VectorXd>& y) const;

  /// dy/dt, or one part of it.
  void derivative(double t, const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Ref<Eigen::VectorXd> dy,
                  Part part = Part::whole) const;

  /// ∂g/∂y = [0 I; M⁻¹ ∂f/∂x  M⁻¹ ∂f/∂v], 2n × 2n, of the whole or of the linear part. Every diagonal entry is stored, so
  /// that I - γ ∂g/∂y has the same pattern.
  /// Valid until the next call.
  const WideSparseMatrix& jacobian(double t, const Eigen::Ref<const Eigen::VectorXd>& y, Part part = Part::whole) const;

  const solver::SplitOde& ode() const { return ode_; }

  /// n numbers as N × 3, zero in the pinned coordinates.
  solver::Vectors spread(const Eigen::Ref<const Eigen::VectorXd>& free) const;

  /// The free ones of N × 3.
  void gather(const solver::Vectors& all, Eigen::Ref<Eigen::VectorXd> free) const;

 private:
  /// What evaluations would otherwise allocate; it makes them unfit for several threads.
  struct Scratch {
    solver::State state;
    solver::Vectors force;
    solver::SparseMatrix df_dx = {}, df_dv = {};
    WideSparseMatrix jacobian = {};
  };

  const solver::State& put_in(double t, const Eigen::Ref<const Eigen::VectorXd>& y) const;
  void evaluate(double t, const solver::State& s, Part part, solver::Vectors& f) const;
  void update_derivatives(double t, const Eigen::Ref<const Eigen::VectorXd>& y, Part part) const;

  /// Hands all entries of ∂g/∂y to add(row, column, value), in the order in which they are stored.
  template <class Add>
  void for_entries(const Add& add) const;

  const solver::SplitOde& ode_;
  Coordinates coordinates_;
  solver::State start_;  ///< with the prescribed velocities
  double t0_;
  Eigen::VectorXd inverse_mass_;  ///< n, [1/kg]
  mutable Scratch scratch_;
};

}  // namespace drape::reference
