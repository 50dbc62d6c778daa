#include "solver/methods/strain_limited.hpp"

#include <algorithm>

#include "solver/methods/projection.hpp"
#include "solver/methods/sub_steps.hpp"
#include "solver/stability.hpp"

namespace drape::solver {
namespace {

/// Part of the tension's stiffness that is left.
constexpr double softness = 0.01;

/// The springs of an ODE, in its own order, with the compliance of what is taken away.
struct Softened {
  std::vector<CompliantConstraint> springs;

  explicit Softened(const SplitOde& ode) {
    if (!ode.compliant_constraints) return;
    for (CompliantConstraint& constraint : springs = ode.compliant_constraints()) constraint.compliance /= softness - 1;
    std::erase_if(springs, [](const auto& c) { return c.kind != CompliantConstraint::Kind::distance; });
  }

  void force(const SplitOde& ode, double t, const Vectors& x, const Vectors& v, Vectors& f) const {
    ode.force(t, x, v, f);
    add_forces(springs, x, f);
  }
};

/// That of `verlet` with the soft springs.
double soft_step_limit(const SplitOde& ode, double t, const State& y) {
  const Softened softened(ode);
  SplitOde soft;
  soft.mass = ode.mass;
  soft.pins = ode.pins;
  soft.force = [&](double time, const Vectors& x, const Vectors& v, Vectors& f) { softened.force(ode, time, x, v, f); };
  return verlet_limit(spectrum(soft, t, y));
}

bool whole_soft_step(Step& s, double substeps) {
  const Softened& softened = s.keep<Softened>();
  const ObliquePins oblique(s.ode.pins);
  const double tau = s.h / substeps;
  Vectors &weight = s.scratch.ax, &before = s.scratch.av, &f = s.scratch.f_hat;
  State& y = s.y1();
  s.error.constant = 0.5 / substeps;
  inverse_masses(s.ode, weight);
  y = s.y0();
  softened.force(s.ode, s.t, y.x, y.v, f);
  oblique(f);
  for (double k = 1; k <= substeps; ++k) {
    y.v.array() += 0.5 * tau * weight.array() * f.array();
    y.x += tau * y.v;
    before = y.x;
    for (int n = 0; n < s.options.sweeps && limit_strain(softened.springs, weight, oblique, y.x); ++n) {
    }
    y.v += (y.x - before) / tau;
    softened.force(s.ode, s.t + k * tau, y.x, y.v, f);
    oblique(f);
    s.pass(s.t + k * tau, y);
    if (limit_narrowed(s, soft_step_limit, s.t + k * tau, y.v, alternates(s, f, weight))) return false;
    y.v.array() += 0.5 * tau * weight.array() * f.array();
  }
  return true;
}

}  // namespace

bool limit_strain(std::span<const CompliantConstraint> constraints, const Vectors& inverse_masses, const ObliquePins& pins,
                  Vectors& x) {
  bool any = false;
  for (const CompliantConstraint& spring : constraints) {
    if (spring.kind != CompliantConstraint::Kind::distance) continue;
    const ConstraintValue now = evaluate(spring, x);
    const double excess = now.C - most_strain * spring.rest;
    const auto [i, j, unused] = spring.particles;
    const Eigen::RowVector3d n_i = pins.filtered(i, now.gradients[1]), n_j = pins.filtered(j, now.gradients[1]);
    const double weight = inverse_masses.row(i).dot(n_i.cwiseAbs2()) + inverse_masses.row(j).dot(n_j.cwiseAbs2());
    if (excess <= 0 || weight == 0) continue;
    x.row(i) += excess / weight * inverse_masses.row(i).cwiseProduct(n_i);
    x.row(j) -= excess / weight * inverse_masses.row(j).cwiseProduct(n_j);
    any = true;
  }
  return any;
}

// Velocity Verlet in sub-steps τ inside its limit, with a hundredth of the tension; after each sub-step springs that are longer
// than 1.1 times their rest length are cut, in the order in which they are listed: x1 += Δx, v1 += Δx/τ
// [Provot 1995; Etzmuß 2002, 3.2]. This is a motion of another sheet, to which it converges at best; and the result depends on
// the order.
void strain_limited(Step& s) { sub_step(s, soft_step_limit, whole_soft_step); }

}  // namespace drape::solver
