#include "solver/stage_system.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "solver/kernels.hpp"

namespace drape::solver {
namespace {

/// The pattern of M − γ² K − γ D without the rows and columns of particles that are pinned in all directions.
SparseMatrix stage_pattern(const SplitOde& ode) {
  std::vector<bool> gone(ode.particles(), false);
  for (const Pin& pin : ode.pins) gone[pin.particle] = pin.all();
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < ode.particles(); ++i) entries.emplace_back(i, i, 0.0);
  for (const SparseMatrix* B : {&ode.stiffness, &ode.damping})
    for (int i = 0; i < B->outerSize(); ++i)
      for (SparseMatrix::InnerIterator b(*B, i); b; ++b)
        if (!gone[b.row()] && !gone[b.col()]) entries.emplace_back(b.row(), b.col(), 0.0);
  SparseMatrix A(ode.particles(), ode.particles());
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

/// The values of B at the entries of the pattern, 0 where B has none.
Eigen::ArrayXd aligned(const SparseMatrix& pattern, const SparseMatrix& B) {
  Eigen::ArrayXd values(pattern.nonZeros());
  Eigen::Index k = 0;
  for (int i = 0; i < pattern.outerSize(); ++i)
    for (SparseMatrix::InnerIterator a(pattern, i); a; ++a) values[k++] = B.nonZeros() ? B.coeff(a.row(), a.col()) : 0.0;
  return values;
}

auto flat(const Vectors& a) { return Eigen::ArrayXd::Map(a.data(), a.size()); }
auto flat(Vectors& a) { return Eigen::ArrayXd::Map(a.data(), a.size()); }

SparseMatrix diagonal(const Eigen::VectorXd& mass) { return SparseMatrix(mass.asDiagonal()); }

}  // namespace

StageSystem::StageSystem(const SplitOde& ode, const Options& options, ContactResponse* contacts)
    : ode_(ode),
      contacts_(contacts),
      pinned_(Filter::partial(ode.pins)),
      cg_(options.linear_solver->make(), options.max_cg_iterations, *ode.work),
      A_(stage_pattern(ode)),
      mass_(aligned(A_, diagonal(ode.mass))),
      stiffness_(aligned(A_, ode.stiffness)),
      damping_(aligned(A_, ode.damping)),
      momentum_(thrice(ode.mass)),
      spring_(thrice(ode.stiffness.diagonal())),
      work_(*ode.work) {
  cg_.analyze(A_);
  for (Vectors* field : {&r_, &d_, &q_}) field->setZero(ode.particles(), 3);
  work_.entries = A_.nonZeros();
}

Outcome StageSystem::prepare(double gamma, double different) {
  if (std::abs(gamma - gamma_) <= different * gamma_) return Outcome::success;
  gamma_ = gamma;
  ++work_.builds;
  Eigen::Map<Eigen::ArrayXd>(A_.valuePtr(), A_.nonZeros()) = mass_ - gamma * gamma * stiffness_ - gamma * damping_;
  const Outcome outcome = cg_.factor(A_);
  if (outcome != Outcome::success) gamma_ = 0;
  return outcome;
}

double StageSystem::noise(const State& y, double gamma) const {
  const double underflow = std::sqrt(std::numeric_limits<double>::min());  // squares of what is smaller vanish
  return round_off(gamma * (spring_ * flat(y.x)).matrix().norm()) + underflow;
}

/// At rest b vanishes like r does, but for its noise, which a relative test alone would never get below.
StageSystem::Scale StageSystem::scale(const State& y, double gamma) {
  multiply(A_, y.v, q_);
  ++work_.products;
  work_.bytes += multiply_bytes(A_) + vector_bytes(A_.rows(), 3);
  q_ += r_;
  filter(ode_.pins, q_);
  filtered()(q_);
  return {q_.norm(), noise(y, gamma)};
}

void StageSystem::evaluate(const Stage& stage, const Vectors* f_explicit, State& y) {
  y.x = stage.ax + stage.gamma * y.v;
  if (touches()) contacts_->impose(stage, y);
  if (f_explicit == nullptr) {
    ode_.force(stage.t, y.x, y.v, r_);
  } else {
    multiply(ode_.stiffness, y.x, r_);
    ++work_.products;
    work_.bytes += multiply_bytes(ode_.stiffness) + vector_bytes(A_.rows(), 8);
    if (ode_.damping.nonZeros() > 0) {
      multiply(ode_.damping, y.v, q_);
      r_ += q_;
      ++work_.products;
      work_.bytes += multiply_bytes(ode_.damping) + vector_bytes(A_.rows(), 3);
    }
    r_ += *f_explicit;
  }
  flat(r_) = momentum_ * (flat(stage.av) - flat(y.v)) + stage.gamma * flat(r_);
}

bool StageSystem::adapt_contacts(const Stage& stage, const Vectors* f_explicit, State& y, double noise, bool settled) {
  const bool changed = contacts_->update(stage, y, r_, noise, settled);
  if (changed) evaluate(stage, f_explicit, y);
  return changed;
}

LinearResult StageSystem::respond(const Vectors& r, double tolerance) {
  r_ = r;
  filter(ode_.pins, r_);
  filtered()(r_);
  return correct(tolerance * r_.norm());
}

void StageSystem::filter_residual(double gamma) {
  if (touches()) contacts_->add_friction(gamma, r_);
  filter(ode_.pins, r_);
  filtered()(r_);
}

}  // namespace drape::solver
