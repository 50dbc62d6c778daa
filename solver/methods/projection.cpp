#include "solver/methods/projection.hpp"

#include <algorithm>
#include <numeric>

#include "solver/methods/sub_steps.hpp"

namespace drape::solver {
namespace {

std::span<const int> ends(const CompliantConstraint& constraint) {
  return {constraint.particles.data(), constraint.kind == CompliantConstraint::Kind::distance ? 2u : 3u};
}

int particles_of(const std::vector<CompliantConstraint>& constraints) {
  int most = -1;
  for (const CompliantConstraint& constraint : constraints)
    for (const int i : ends(constraint)) most = std::max(most, i);
  return most + 1;
}

std::vector<CompliantConstraint> listed(const SplitOde& ode) {
  return ode.compliant_constraints ? ode.compliant_constraints() : std::vector<CompliantConstraint>();
}

}  // namespace

void add_forces(std::span<const CompliantConstraint> constraints, const Vectors& x, Vectors& f) {
  for (const CompliantConstraint& constraint : constraints) {
    const ConstraintValue now = evaluate(constraint, x);
    for (int k = 0; k < now.particles; ++k)
      f.row(constraint.particles[k]) -= now.C / constraint.compliance * now.gradients[k].transpose();
  }
}

std::vector<CompliantConstraint> coloured(const std::vector<CompliantConstraint>& constraints) {
  std::vector<std::vector<CompliantConstraint>> colours;
  std::vector<std::vector<bool>> taken;  // [colour][particle]
  const int particles = particles_of(constraints);
  for (const CompliantConstraint& constraint : constraints) {
    const auto free = std::ranges::find_if(taken, [&](const std::vector<bool>& by) {
      return std::ranges::none_of(ends(constraint), [&](int i) { return by[i]; });
    });
    const std::size_t colour = free - taken.begin();
    if (free == taken.end()) {
      taken.emplace_back(particles, false);
      colours.emplace_back();
    }
    for (const int i : ends(constraint)) taken[colour][i] = true;
    colours[colour].push_back(constraint);
  }
  std::vector<CompliantConstraint> all;
  for (const auto& colour : colours) all.insert(all.end(), colour.begin(), colour.end());
  return all;
}

Projection::Projection(const SplitOde& ode)
    : constraints_(coloured(listed(ode))),
      multipliers_(constraints_.size()),
      oblique_(ode.pins),
      weights_(ode.particles(), 3),
      moves_(ode.particles(), 3),
      shares_(ode.particles()),
      sweeps_(ode.work->counter("sweeps", "passes over all compliant constraints")) {
  inverse_masses(ode, weights_);
  for (const CompliantConstraint& constraint : constraints_)
    for (const int i : ends(constraint)) ++shares_[i];
}

void Projection::begin(double tau) {
  per_tau_squared_ = 1 / (tau * tau);
  std::ranges::fill(multipliers_, 0);
}

template <bool at_once>
void Projection::project(const Vectors& x, Vectors& moved) {
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    const CompliantConstraint& constraint = constraints_[c];
    ConstraintValue now = evaluate(constraint, x);
    if (!oblique_.empty())
      for (int k = 0; k < now.particles; ++k) now.gradients[k] = oblique_.filtered(constraint.particles[k], now.gradients[k]);
    const double alpha = constraint.compliance * per_tau_squared_;
    double denominator = alpha;
    for (int k = 0; k < now.particles; ++k) {
      const int i = constraint.particles[k];
      denominator += (at_once ? shares_[i] : 1) * weights_.row(i).dot(now.gradients[k].cwiseAbs2());
    }
    const double change = (-now.C - alpha * multipliers_[c]) / denominator;
    multipliers_[c] += change;
    for (int k = 0; k < now.particles; ++k) {
      const int i = constraint.particles[k];
      moved.row(i) += change * weights_.row(i).cwiseProduct(now.gradients[k].transpose());
    }
  }
  ++sweeps_;
}

void Projection::sweep(Vectors& x) { project<false>(x, x); }

void Projection::sweep_at_once(Vectors& x) {
  moves_.setZero();
  project<true>(x, moves_);
  x += moves_;
}

}  // namespace drape::solver
