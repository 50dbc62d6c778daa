#pragma once

#include <vector>

#include "solver/split_ode.hpp"

namespace drape::reference {

/// Compressed rows with the 64 bit indices of SUNDIALS.
using WideSparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, std::int64_t>;

/// The split equation of motion as  dy/dt = g(t, y)  for a general ODE solver.
///
/// y = (positions [m], velocities [m/s]) of the n free coordinates, in the order of their index 3i + c: 2n numbers. Pinned
/// coordinates are no unknowns: they are at x0 + w (t - t0) with the velocity w, and are put in before every evaluation.
/// The ODE must outlive this object. Evaluations throw std::runtime_error if the result is not finite.
class FirstOrderOde {
 public:
  /// Throws std::invalid_argument if the state does not fit the ODE, or if all coordinates are pinned.
  FirstOrderOde(const solver::SplitOde& ode, const solver::State& start, double t0);

  /// Length of y, 2n.
  int size() const { return 2 * static_cast<int>(free_.size()); }

  /// The free part of the start.
  Eigen::VectorXd initial() const;

  /// All coordinates, the pinned ones included, at time t [s].
  solver::State state(double t, const Eigen::Ref<const Eigen::VectorXd>& y) const;

  /// dy/dt.
  void derivative(double t, const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Ref<Eigen::VectorXd> dy) const;

  /// ∂g/∂y = [0 I; M⁻¹ ∂f/∂x  M⁻¹ ∂f/∂v], 2n × 2n. Every diagonal entry is stored, so that I - γ ∂g/∂y has the same pattern.
  WideSparseMatrix jacobian(double t, const Eigen::Ref<const Eigen::VectorXd>& y) const;

 private:
  const solver::SplitOde& ode_;
  solver::State start_;  ///< with the prescribed velocities
  double t0_;
  std::vector<int> free_;         ///< 3i + c of each free coordinate
  std::vector<int> pinned_;       ///< 3i + c of each pinned coordinate
  std::vector<int> unknown_;      ///< 3N: place among the free coordinates, -1 if pinned
  Eigen::VectorXd inverse_mass_;  ///< n, [1/kg]
};

}  // namespace drape::reference
