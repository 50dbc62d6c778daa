#include "solver/stage_solver.hpp"

#include <algorithm>
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

/// Every value three times, once a coordinate.
Eigen::ArrayXd thrice(const Eigen::VectorXd& values) { return values.replicate(1, 3).reshaped<Eigen::RowMajor>(); }

auto flat(const Vectors& a) { return Eigen::ArrayXd::Map(a.data(), a.size()); }
auto flat(Vectors& a) { return Eigen::ArrayXd::Map(a.data(), a.size()); }

constexpr double operations = 8;  ///< roundings that add up in the force on one particle

SparseMatrix diagonal(const Eigen::VectorXd& mass) { return SparseMatrix(mass.asDiagonal()); }

}  // namespace

StageSolver::StageSolver(const SplitOde& ode, const Options& options, ContactResponse* contacts)
    : ode_(ode),
      options_(options),
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

Outcome StageSolver::prepare(double gamma) {
  if (gamma == gamma_) return Outcome::success;
  gamma_ = gamma;
  ++work_.builds;
  Eigen::Map<Eigen::ArrayXd>(A_.valuePtr(), A_.nonZeros()) = mass_ - gamma * gamma * stiffness_ - gamma * damping_;
  const Outcome outcome = cg_.factor(A_);
  if (outcome != Outcome::success) gamma_ = 0;
  return outcome;
}

/// |b| = |r + A v| over the free coordinates. At rest b vanishes like r does, but for the round-off of differences of
/// positions times spring constants, which a relative test alone would never get below.
StageSolver::Scale StageSolver::scale(const Vectors& residual, const State& y, double gamma) {
  const double underflow = std::sqrt(std::numeric_limits<double>::min());  // squares of what is smaller vanish
  multiply(A_, y.v, q_);
  ++work_.products;
  work_.bytes += multiply_bytes(A_) + vector_bytes(A_.rows(), 3);
  q_ += residual;
  filter(ode_.pins, q_);
  filtered()(q_);
  const double forces = (spring_ * flat(y.x)).matrix().norm();
  return {q_.norm(), operations * std::numeric_limits<double>::epsilon() * gamma * forces + underflow};
}

/// x = ax + γ v and r = M (av − v) + γ f in all coordinates; f = K x + D v + f̂ if f̂ is given.
void StageSolver::evaluate(const Stage& stage, const Vectors* f_explicit, State& y) {
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

void StageSolver::filter_residual(double gamma) {
  if (touches()) contacts_->add_friction(gamma, r_);
  filter(ode_.pins, r_);
  filtered()(r_);
}

StageResult StageSolver::solve_linear(const Stage& stage, const Vectors& f_explicit, State& y) {
  return solve(stage, &f_explicit, y);
}

StageResult StageSolver::solve(const Stage& stage, State& y) { return solve(stage, nullptr, y); }

StageResult StageSolver::solve(const Stage& stage, const Vectors* f_explicit, State& y) {
  StageResult result;
  result.outcome = prepare(stage.gamma);
  if (result.outcome != Outcome::success) return result;
  prescribe(ode_.pins, y.v);
  const auto ended = [&](Outcome outcome) { return StageResult{outcome, result.updates, result.cg_iterations}; };

  const bool linear = f_explicit != nullptr, contacts = touches();
  const double loop_tolerance = linear ? options_.cg_tolerance : options_.loop_tolerance;
  const double cg_tolerance =
      linear ? loop_tolerance : std::min(options_.cg_tolerance, loop_tolerance / 2);  // or it could not end
  const int changing_updates = linear ? 10 : 50;
  Scale size{};
  for (;; ++result.updates, ++work_.updates) {
    evaluate(stage, f_explicit, y);
    const bool solved = result.updates > 0;
    const bool changed =
        contacts && solved && contacts_->update(stage, y, r_, size.target(loop_tolerance), result.updates >= changing_updates);
    if (changed) evaluate(stage, f_explicit, y);
    const double whole = contacts ? r_.norm() : 0;
    filter_residual(stage.gamma);
    if (!solved) size = scale(r_, y, stage.gamma);
    size.round_off = std::max(size.round_off, operations * std::numeric_limits<double>::epsilon() * whole);

    const double residual = r_.norm();
    if (!std::isfinite(residual)) return ended(Outcome::not_finite);
    const bool guessed = !linear && !contacts && residual <= size.target(cg_tolerance);
    if (solved ? !changed && residual <= size.target(loop_tolerance) : guessed) return ended(Outcome::success);
    if (result.updates == options_.max_updates) return ended(Outcome::not_converged);

    const LinearResult system = cg_.solve(A_, filtered(), r_, d_, size.target(cg_tolerance));
    result.cg_iterations += system.iterations;
    y.v += d_;
    if (linear && !contacts) {
      y.x = stage.ax + stage.gamma * y.v;
      ++work_.updates;
      return {system.outcome, 1, system.iterations};
    }
    if (system.outcome != Outcome::success) return ended(system.outcome);
  }
}

}  // namespace drape::solver
