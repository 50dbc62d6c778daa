#include "solver/stage/newton_gradients.hpp"

#include <cmath>

#include "solver/linear/kernels.hpp"

namespace drape::solver {
namespace {

/// The forcing term η. Eisenstat and Walker's second choice, at most 0.1 or 0.5, takes 3 to 44 % more iterations: with a lagged
/// matrix Newton's method converges linearly at best.
constexpr double forcing_term = 0.1;

/// Estimated error of d over d that is accepted. On crumpled sheets of numerical stiffness 2e3 to 2e5 |d| then is within an
/// eighth of that of a factor, and its error less than half of it; without this test |d| was 0.6 to 2.3 times as large and its
/// error up to twice that. The final states of such runs are four to five times nearer to those of a factor.
constexpr double unseen = 0.3;

/// The preconditioner's share of the blocks. Against A alone it takes 0.3 to 0.7 of the iterations on stiff or undamped sheets
/// and hardly less on others; with 1 it is the same within a fifth.
constexpr double share_of_blocks = 0.3;

constexpr double distant_gamma = 0.25;  ///< A serves for a γ as near as this

/// q = J p, where only the upper triangle of J is stored.
void multiply_symmetric(const SparseMatrix& J, const Vectors& p, Vectors& q) {
  using Flat = Eigen::VectorXd;
  const Eigen::Map<const Flat> flat_p(p.data(), p.size());
  Eigen::Map<Flat>(q.data(), q.size()).noalias() = J.selfadjointView<Eigen::Upper>() * flat_p;
}

/// Bytes of one iteration without A: every entry of J and of the blocks (nine numbers) once, and 19 passes over vectors.
std::int64_t iteration_bytes(const SparseMatrix& J) {
  return J.nonZeros() * static_cast<std::int64_t>(sizeof(double) + sizeof(int)) + vector_bytes(J.rows() / 3, 3 + 19);
}

}  // namespace

NewtonGradients::NewtonGradients(const SplitOde& ode, const Options& options, StageSystem& system)
    : ode_(ode), max_iterations_(options.max_cg_iterations), system_(system), blocks_(ode.particles()), work_(*ode.work) {
  for (Vectors* field : {&r_, &z_, &p_, &q_}) field->setZero(ode.particles(), 3);
}

void NewtonGradients::prepare(const SparseMatrix& J) {
  for (int i = 0; i < ode_.particles(); ++i) {
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    for (int a = 0; a < 3; ++a)
      for (SparseMatrix::InnerIterator entry(J, 3 * i + a); entry && entry.col() < 3 * i + 3; ++entry)
        block(a, entry.col() - 3 * i) = block(entry.col() - 3 * i, a) = entry.value();
    blocks_[i] = share_of_blocks * block.inverse();
  }
}

/// z = preconditioned r. Returns <r, z>.
double NewtonGradients::precondition() {
  system_.precondition(r_, z_);
  double rz = 0;
  for (int i = 0; i < ode_.particles(); ++i) {
    const Eigen::Vector3d r = r_.row(i);
    const Eigen::Vector3d z = z_.row(i).transpose() + blocks_[i] * r;
    z_.row(i) = z;
    rz += r.dot(z);
  }
  return rz;
}

/// Whether the error that d had five iterations ago is a small part of d; in the norm of M, |d|² = 2 E_kin.
bool NewtonGradients::settled(const Vectors& d) const { return falls_.sum() <= unseen * unseen * 2 * kinetic_energy(ode_, d); }

LinearResult NewtonGradients::solve(const SparseMatrix& J, double gamma, double inertia, const Vectors& r, Vectors& d) {
  const Outcome prepared = system_.prepare(gamma, inertia, distant_gamma);
  if (prepared != Outcome::success) return {prepared, 0};
  r_ = r;
  d.setZero(r.rows(), 3);
  falls_.setZero();
  double norm = r.norm(), rz = 0;
  const double target = forcing_term * norm;
  for (int k = 0;; ++k) {
    if (!std::isfinite(norm)) return {Outcome::not_finite, k};
    if (norm <= target && settled(d)) return {Outcome::success, k};
    if (k == max_iterations_) return {Outcome::not_converged, k};

    const double before = rz;
    rz = precondition();
    if (k == 0)
      p_ = z_;
    else
      p_ = z_ + rz / before * p_;
    multiply_symmetric(J, p_, q_);
    ++work_.cg_iterations;
    ++work_.products;
    work_.bytes += iteration_bytes(J);
    const double pq = p_.cwiseProduct(q_).sum();
    if (std::isfinite(pq) && pq <= 0) return {Outcome::breakdown, k};
    falls_[k % falls_.size()] = rz * rz / pq;
    norm = std::sqrt(advance(rz / pq, p_, q_, d, r_));
  }
}

}  // namespace drape::solver
