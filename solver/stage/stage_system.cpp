#include "solver/stage/stage_system.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include "solver/linear/kernels.hpp"

namespace drape::solver {
namespace {

/// The remaining entries of a row of a compressed matrix.
class Row {
 public:
  Row(const SparseMatrix& B, int i) {
    if (B.nonZeros() == 0) return;
    next_ = B.innerIndexPtr() + B.outerIndexPtr()[i];
    end_ = B.innerIndexPtr() + B.outerIndexPtr()[i + 1];
    value_ = B.valuePtr() + B.outerIndexPtr()[i];
  }

  int column(int none) const { return next_ == end_ ? none : *next_; }

  /// The entry in this column, if it is the next one, else 0.
  double take(int column) {
    if (next_ == end_ || *next_ != column) return 0;
    ++next_;
    return *value_++;
  }

 private:
  const int *next_ = nullptr, *end_ = nullptr;
  const double* value_ = nullptr;
};

auto array(const std::vector<double>& values) { return Eigen::ArrayXd::Map(values.data(), std::ssize(values)); }

auto flat(const Vectors& a) { return Eigen::ArrayXd::Map(a.data(), a.size()); }
auto flat(Vectors& a) { return Eigen::ArrayXd::Map(a.data(), a.size()); }

}  // namespace

/// M, K and D merged row by row, without the couplings of particles that are pinned in all directions. On small sheets assembly
/// by triplets and look-ups would cost as much as some steps.
struct StageSystem::Merged {
  explicit Merged(const SplitOde& ode) : n(ode.particles()) {
    std::vector<bool> gone(n, false);
    for (const Pin& pin : ode.pins) gone[pin.particle] = pin.all();
    for (int i = 0; i < n; ++i) {
      Row k_i(ode.stiffness, i), d_i(ode.damping, i);
      for (int own = i;;) {
        const int j = std::min({own, k_i.column(n), d_i.column(n)});
        if (j == n) break;
        const double k_ij = k_i.take(j), d_ij = d_i.take(j);
        if (j == own) own = n;
        if (j == i || (!gone[i] && !gone[j])) add(j, j == i ? ode.mass[i] : 0, k_ij, d_ij);
      }
      start.push_back(static_cast<int>(column.size()));
    }
  }

  void add(int j, double m_ij, double k_ij, double d_ij) {
    column.push_back(j);
    m.push_back(m_ij);
    k.push_back(k_ij);
    d.push_back(d_ij);
  }

  SparseMatrix pattern() const {
    return Eigen::Map<const SparseMatrix>(n, n, start.back(), start.data(), column.data(), m.data());
  }

  int n;
  std::vector<int> start{0}, column;
  std::vector<double> m, k, d;  // aligned with the columns
};

StageSystem::StageSystem(const SplitOde& ode, const Options& options, ContactResponse* contacts)
    : StageSystem(ode, Merged(ode), options, contacts) {}

StageSystem::StageSystem(const SplitOde& ode, const Merged& merged, const Options& options, ContactResponse* contacts)
    : ode_(ode),
      contacts_(contacts),
      pinned_(Filter::partial(ode.pins)),
      cg_(options.linear_solver->make(), options.max_cg_iterations, *ode.work),
      A_(merged.pattern()),
      mass_(array(merged.m)),
      stiffness_(array(merged.k)),
      damping_(array(merged.d)),
      momentum_(thrice(ode.mass)),
      spring_(thrice(ode.stiffness.diagonal())),
      work_(*ode.work) {
  cg_.analyse(A_);
  for (Vectors* field : {&r_, &d_, &q_}) field->setZero(ode.particles(), 3);
  work_.entries = A_.nonZeros();
}

Outcome StageSystem::prepare(double gamma, double inertia, double different) {
  const bool near = std::abs(gamma - gamma_) <= different * gamma_ && std::abs(inertia - inertia_) <= different * inertia_;
  return near ? Outcome::success : make(gamma, gamma * gamma, inertia);
}

void StageSystem::renew() {
  const Merged merged(ode_);
  stiffness_ = array(merged.k);
  damping_ = array(merged.d);
  spring_ = thrice(ode_.stiffness.diagonal());
  gamma_ = 0;
}

Outcome StageSystem::prepare_damping(double gamma) { return gamma == gamma_ ? Outcome::success : make(gamma, 0, 1); }

Outcome StageSystem::make(double gamma, double springs, double inertia) {
  gamma_ = gamma;
  inertia_ = inertia;
  ++work_.builds;
  Eigen::Map<Eigen::ArrayXd>(A_.valuePtr(), A_.nonZeros()) = inertia * mass_ - springs * stiffness_ - gamma * damping_;
  const Outcome outcome = cg_.factor(A_);
  if (outcome != Outcome::success) gamma_ = 0;
  return outcome;
}

double StageSystem::noise(const State& y, double gamma) const {
  const double underflow = std::sqrt(std::numeric_limits<double>::min());  // squares of smaller numbers vanish
  const auto [begin, count] = ode_.partition->own(y.x.size());
  const double squares = (spring_ * flat(y.x)).segment(begin, count).matrix().squaredNorm();
  return round_off(gamma * std::sqrt(ode_.partition->sum(squares))) + underflow;
}

/// At rest both b and r are round-off only, so that a relative test alone would never pass.
StageSystem::Scale StageSystem::scale(const Stage& stage, const State& y) {
  if (!stage.springs) return {size(r_), noise(y, stage.gamma)};
  multiply(A_, y.v, q_);
  ++work_.products;
  work_.bytes += multiply_bytes(A_) + vector_bytes(A_.rows(), 3);
  q_ += r_;
  filter(ode_.pins, q_);
  filtered()(q_);
  return {size(q_), noise(y, stage.gamma)};
}

void StageSystem::evaluate(const Stage& stage, const Vectors* f_explicit, State& y) {
  y.x = stage.ax + stage.gamma * y.v;
  if (touches()) contacts_->impose(stage, y);
  if (f_explicit == nullptr) {
    ode_.force(stage.t, y.x, y.v, r_);
    if (stage.start != nullptr && ode_.mean_excess) {
      q_ = 2 * y.x - *stage.start;
      ode_.mean_excess(stage.t, *stage.start, q_, r_);
    }
  } else {
    if (stage.springs) {
      multiply(ode_.stiffness, y.x, r_);
      ++work_.products;
      work_.bytes += multiply_bytes(ode_.stiffness) + vector_bytes(A_.rows(), 8);
    } else {
      r_.setZero();
    }
    if (ode_.damping.nonZeros() > 0) {
      multiply(ode_.damping, y.v, q_);
      r_ += q_;
      ++work_.products;
      work_.bytes += multiply_bytes(ode_.damping) + vector_bytes(A_.rows(), 3);
    }
    r_ += *f_explicit;
  }
  flat(r_) = stage.inertia * momentum_ * (flat(stage.av) - flat(y.v)) + stage.gamma * flat(r_);
}

bool StageSystem::adapt_contacts(const Stage& stage, const Vectors* f_explicit, State& y, double noise,
                                 ContactResponse::Changes changes) {
  // More than the eigenvalues of A, by Gershgorin: the rows of K and D sum to 0.
  if (contacts_->has_pairs()) bounds_ = 2 * Eigen::VectorXd(A_.diagonal()) - inertia_ * ode_.mass;
  const bool changed = contacts_->update(stage, y, r_, bounds_, noise, changes);
  if (changed) evaluate(stage, f_explicit, y);
  return changed;
}

LinearResult StageSystem::respond(const Vectors& r, double tolerance, double noise) {
  r_ = r;
  filter(ode_.pins, r_);
  filtered()(r_);
  return correct(std::max(tolerance * size(r_), noise));
}

LinearResult StageSystem::respond(const State& r, double tolerance, double noise) {
  multiply(ode_.stiffness, r.x, q_);
  ++work_.products;
  work_.bytes += multiply_bytes(ode_.stiffness) + vector_bytes(A_.rows(), 4);
  q_ = gamma_ * q_ + ode_.mass.asDiagonal() * r.v;
  return respond(q_, tolerance, noise);
}

void StageSystem::filter_residual(double gamma) {
  if (touches()) contacts_->add_friction(gamma, r_);
  filter(ode_.pins, r_);
  filtered()(r_);
}

}  // namespace drape::solver
