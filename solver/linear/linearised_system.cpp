#include "solver/linear/linearised_system.hpp"

#include <algorithm>
#include <cmath>

#include "solver/filter.hpp"
#include "solver/linear/kernels.hpp"

namespace drape::solver {
namespace {

using Entry = SparseMatrix::InnerIterator;

int column(const Entry& entry, int none) { return entry ? static_cast<int>(entry.col()) : none; }

/// The entry in this column, if it is the next one, else 0.
double take(Entry& entry, int wanted) {
  if (!entry || entry.col() != wanted) return 0;
  const double value = entry.value();
  ++entry;
  return value;
}

}  // namespace

LinearisedSystem::LinearisedSystem(const SplitOde& ode)
    : ode_(ode),
      pinned_(3 * ode.particles(), false),
      A_(3 * ode.particles(), 3 * ode.particles()),
      right_(Vectors::Zero(ode.particles(), 3)),
      klu_(ode.work->counter("klu_analyses", "symbolic analyses by KLU of the matrix with the exact Jacobian")),
      work_(*ode.work) {
  for (const Pin& pin : ode.pins)
    for (int c = 0; c < 3; ++c) pinned_[3 * pin.particle + c] = pin.fixed(c);
  const ObliquePins oblique(ode.pins);
  if (oblique.empty()) return;
  free_ = oblique.matrix(ode.particles());
  SparseMatrix identity(free_.rows(), free_.cols());
  identity.setIdentity();
  held_ = thrice(ode.mass).asDiagonal() * SparseMatrix(identity - free_);
}

/// Row by row, which costs next to nothing beside the factors, whatever the patterns of the two derivatives.
void LinearisedSystem::merge_derivatives() {
  const int n = static_cast<int>(A_.rows());
  A_.setZero();  // keeps its memory
  for (int i = 0; i < n; ++i) {
    A_.startVec(i);
    if (pinned_[i]) {
      A_.insertBack(i, i) = 1;
      continue;
    }
    Entry x(df_dx_, i), v(df_dv_, i);
    for (int own = i;;) {
      const int j = std::min({own, column(x, n), column(v, n)});
      if (j == n) break;
      const double value = -gamma_ * gamma_ * take(x, j) - gamma_ * take(v, j);
      if (j == own) own = n;
      if (!pinned_[j]) A_.insertBack(i, j) = value + (i == j ? ode_.mass[i / 3] : 0);
    }
  }
  A_.finalize();
  if (free_.nonZeros() > 0) A_ = SparseMatrix(free_ * A_ * free_) + held_;
}

Outcome LinearisedSystem::make(double gamma, double t, const State& y) {
  gamma_ = gamma;
  ode_.jacobian(t, y.x, y.v, df_dx_, df_dv_);
  merge_derivatives();
  ++work_.builds;
  ++work_.factorisations;
  work_.entries = A_.nonZeros();
  return std::isfinite(A_.coeffs().sum()) ? Outcome::success : Outcome::not_finite;
}

Outcome LinearisedSystem::assemble(double gamma, double t, const State& y) {
  const Outcome outcome = make(gamma, t, y);
  if (!gradients_) gradients_.emplace(ode_.particles(), *ode_.work);
  if (outcome == Outcome::success) gradients_->prepare(A_, ode_.mass);
  return outcome;
}

LinearResult LinearisedSystem::solve_symmetric(const Vectors& r, double tolerance, int max_iterations, Vectors& d) {
  right_ = r;
  filter(ode_.pins, right_);
  ++work_.updates;
  return gradients_->solve(A_, right_, d, tolerance * right_.norm(), max_iterations);
}

Outcome LinearisedSystem::factor(double gamma, double t, const State& y) {
  if (const Outcome outcome = make(gamma, t, y); outcome != Outcome::success) return outcome;
  if (!klu_.factor(A_)) return Outcome::breakdown;
  work_.bytes += klu_.bytes();
  return Outcome::success;
}

void LinearisedSystem::multiply_stiffness(const Vectors& x, Vectors& f) {
  Eigen::Map<Eigen::VectorXd>(f.data(), f.size()).noalias() = df_dx_ * Eigen::Map<const Eigen::VectorXd>(x.data(), x.size());
  ++work_.products;
  work_.bytes += multiply_bytes(df_dx_);
}

void LinearisedSystem::solve(const Vectors& r, Vectors& d) {
  d = r;
  filter(ode_.pins, d);
  klu_.solve(d.data(), d.size());
  ++work_.updates;
  work_.bytes += klu_.bytes() + vector_bytes(ode_.particles(), 4);
}

void LinearisedSystem::solve(const State& r, State& k) {
  multiply_stiffness(r.x, right_);
  right_ = gamma_ * right_ + ode_.mass.asDiagonal() * r.v;
  solve(right_, k.v);
  k.x = r.x + gamma_ * k.v;
}

}  // namespace drape::solver
