#pragma once

#include <array>
#include <span>
#include <vector>

#include "solver/filter.hpp"
#include "solver/split_ode.hpp"

namespace drape::solver {

/// A constraint's value C and its gradients by the positions of its particles.
struct ConstraintValue {
  double C;
  int particles;  ///< number of gradients
  std::array<Eigen::Vector3d, 3> gradients;
};

/// At the positions x. Where the ends of a distance coincide its gradients are 0.
inline ConstraintValue evaluate(const CompliantConstraint& constraint, const Vectors& x) {
  const auto [i, j, k] = constraint.particles;
  const Eigen::Vector3d p = x.row(j) - x.row(i);
  if (constraint.kind == CompliantConstraint::Kind::distance) {
    const double length = p.norm();
    const Eigen::Vector3d n = length > 0 ? Eigen::Vector3d(p / length) : Eigen::Vector3d::Zero();
    return {length - constraint.rest, 2, {-n, n}};
  }
  const Eigen::Vector3d q = x.row(k) - x.row(i);
  return {p.dot(q) - constraint.rest, 3, {-p - q, q, p}};
}

/// f += −C/α ∇C, the forces of constraints [N].
void add_forces(std::span<const CompliantConstraint> constraints, const Vectors& x, Vectors& f);

/// The constraints in the order of their colours: those of one colour share no particle, so that their order does not matter.
/// Colours are given in turn, the first that is free.
std::vector<CompliantConstraint> coloured(const std::vector<CompliantConstraint>& constraints);

/// Projects positions on the compliant constraints of an ODE   [Macklin, Müller, Chentanez 2016, (18)]: a sweep changes each
/// multiplier by
///   Δλ = (−C − α̃ λ)/(∇C W ∇Cᵀ + α̃),   x += W ∇Cᵀ Δλ,   α̃ = α/τ²,   W = M⁻¹, 0 in pinned directions.
/// Only the constructor allocates.
class Projection {
 public:
  explicit Projection(const SplitOde& ode);

  /// Begins a sub-step τ [s], with λ = 0.
  void begin(double tau);

  /// One constraint after the other, colour by colour: Gauss and Seidel's sweep.
  void sweep(Vectors& x);

  /// All at the same positions, Jacobi's sweep. Each particle's mass is divided among its n constraints, that is W is n W in
  /// the denominator [Tonge, Benevolenski, Voroshilov 2012]: then sweeps converge, and a single one has the right force for
  /// small τ.
  void sweep_at_once(Vectors& x);

 private:
  template <bool at_once>
  void project(const Vectors& x, Vectors& moved);

  std::vector<CompliantConstraint> constraints_;
  std::vector<double> multipliers_;  ///< λ
  ObliquePins oblique_;
  Vectors weights_, moves_;
  std::vector<double> shares_;  ///< number of constraints of each particle
  double per_tau_squared_ = 0;
  std::int64_t& sweeps_;
};

}  // namespace drape::solver
