#include "solver/stage_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "solver/kernels.hpp"

namespace drape::solver {
namespace {

std::vector<Pin> partial(const std::vector<Pin>& pins) {
  std::vector<Pin> found;
  std::ranges::copy_if(pins, std::back_inserter(found), [](const Pin& pin) { return !pin.all(); });
  return found;
}

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

SparseMatrix diagonal(const Eigen::VectorXd& mass) { return SparseMatrix(mass.asDiagonal()); }

}  // namespace

StageSolver::StageSolver(const SplitOde& ode, const Options& options)
    : ode_(ode),
      options_(options),
      cg_(options.linear_solver->make(), partial(ode.pins), options.max_cg_iterations, *ode.work),
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
  constexpr double operations = 8;                                         // roundings that add up in the force on one particle
  const double underflow = std::sqrt(std::numeric_limits<double>::min());  // squares of what is smaller vanish
  multiply(A_, y.v, q_);
  ++work_.products;
  work_.bytes += multiply_bytes(A_) + vector_bytes(A_.rows(), 3);
  q_ += residual;
  filter(ode_.pins, q_);
  const double forces = (spring_ * flat(y.x)).matrix().norm();
  return {q_.norm(), operations * std::numeric_limits<double>::epsilon() * gamma * forces + underflow};
}

/// r = M (av − v) + γ f over the free coordinates; f may be r.
void StageSolver::form_residual(const Stage& stage, const Vectors& v, const Vectors& f) {
  flat(r_) = momentum_ * (flat(stage.av) - flat(v)) + stage.gamma * flat(f);
  filter(ode_.pins, r_);
}

StageResult StageSolver::solve_linear(const Stage& stage, const Vectors& f_explicit, State& y) {
  StageResult result;
  result.outcome = prepare(stage.gamma);
  if (result.outcome != Outcome::success) return result;
  prescribe(ode_.pins, y.v);
  const double gamma = stage.gamma;

  // r = M (av − v) + γ (K (ax + γ v) + D v + f̂)
  y.x = stage.ax + gamma * y.v;
  multiply(ode_.stiffness, y.x, r_);
  if (ode_.damping.nonZeros() > 0) {
    multiply(ode_.damping, y.v, q_);
    r_ += q_;
    ++work_.products;
    work_.bytes += multiply_bytes(ode_.damping) + vector_bytes(A_.rows(), 3);
  }
  ++work_.products;
  work_.bytes += multiply_bytes(ode_.stiffness) + vector_bytes(A_.rows(), 8);
  r_ += f_explicit;
  form_residual(stage, y.v, r_);

  const double target = scale(r_, y, gamma).target(options_.cg_tolerance);
  const LinearResult linear = cg_.solve(A_, r_, d_, target);
  ++work_.updates;
  y.v += d_;
  y.x = stage.ax + gamma * y.v;
  return {linear.outcome, 1, linear.iterations};
}

StageResult StageSolver::solve(const Stage& stage, State& y) {
  StageResult result;
  result.outcome = prepare(stage.gamma);
  if (result.outcome != Outcome::success) return result;
  prescribe(ode_.pins, y.v);
  const double gamma = stage.gamma;

  const double cg_tolerance = std::min(options_.cg_tolerance, options_.loop_tolerance / 2);  // or the loop could not end
  Scale size{};
  for (;; ++result.updates, ++work_.updates) {
    y.x = stage.ax + gamma * y.v;
    ode_.force(stage.t, y.x, y.v, r_);
    form_residual(stage, y.v, r_);
    if (result.updates == 0) size = scale(r_, y, gamma);

    const double residual = r_.norm();
    const double tolerance = result.updates == 0 ? cg_tolerance : options_.loop_tolerance;
    if (!std::isfinite(residual)) return {Outcome::not_finite, result.updates, result.cg_iterations};
    if (residual <= size.target(tolerance)) return {Outcome::success, result.updates, result.cg_iterations};
    if (result.updates == options_.max_updates) return {Outcome::not_converged, result.updates, result.cg_iterations};

    const LinearResult linear = cg_.solve(A_, r_, d_, size.target(cg_tolerance));
    result.cg_iterations += linear.iterations;
    if (linear.outcome != Outcome::success) return {linear.outcome, result.updates, result.cg_iterations};
    y.v += d_;
  }
}

}  // namespace drape::solver
