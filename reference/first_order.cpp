#include "reference/first_order.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace drape::reference {

using solver::SparseMatrix;
using solver::State;
using solver::Vectors;

FirstOrderOde::FirstOrderOde(const solver::SplitOde& ode, const State& start, double t0)
    : ode_(ode), start_(start), t0_(t0), unknown_(3 * ode.mass.size(), -1) {
  if (start.x.rows() != ode.particles() || start.v.rows() != ode.particles())
    throw std::invalid_argument(fmt::format("the start has {} positions and {} velocities, the equation of motion {} particles",
                                            start.x.rows(), start.v.rows(), ode.particles()));
  solver::prescribe(ode.pins, start_.v);
  Vectors moves = Vectors::Ones(ode.particles(), 3);
  solver::filter(ode.pins, moves);
  for (int i = 0; i < moves.size(); ++i) {
    if (moves.data()[i] != 0) unknown_[i] = static_cast<int>(free_.size());
    (moves.data()[i] != 0 ? free_ : pinned_).push_back(i);
  }
  if (free_.empty()) throw std::invalid_argument("every coordinate is pinned: there is no equation of motion to integrate");
  inverse_mass_.resize(free_.size());
  for (std::size_t r = 0; r < free_.size(); ++r) inverse_mass_[r] = 1 / ode.mass[free_[r] / 3];
}

Eigen::VectorXd FirstOrderOde::initial() const {
  const int n = size() / 2;
  Eigen::VectorXd y(size());
  for (int r = 0; r < n; ++r) {
    y[r] = start_.x.data()[free_[r]];
    y[n + r] = start_.v.data()[free_[r]];
  }
  return y;
}

State FirstOrderOde::state(double t, const Eigen::Ref<const Eigen::VectorXd>& y) const {
  const int n = size() / 2;
  State s = start_;
  for (int i : pinned_) s.x.data()[i] += start_.v.data()[i] * (t - t0_);
  for (int r = 0; r < n; ++r) {
    s.x.data()[free_[r]] = y[r];
    s.v.data()[free_[r]] = y[n + r];
  }
  return s;
}

void FirstOrderOde::derivative(double t, const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Ref<Eigen::VectorXd> dy) const {
  const int n = size() / 2;
  const State s = state(t, y);
  Vectors f(ode_.particles(), 3);
  ode_.force(t, s.x, s.v, f);
  dy.head(n) = y.tail(n);
  for (int r = 0; r < n; ++r) {
    dy[n + r] = inverse_mass_[r] * f.data()[free_[r]];
    if (!std::isfinite(dy[n + r]))
      throw std::runtime_error(fmt::format("the force on particle {} is not finite at t = {} s", free_[r] / 3, t));
  }
}

WideSparseMatrix FirstOrderOde::jacobian(double t, const Eigen::Ref<const Eigen::VectorXd>& y) const {
  const int n = size() / 2;
  const State s = state(t, y);
  SparseMatrix df_dx, df_dv, identity(3 * ode_.particles(), 3 * ode_.particles());
  ode_.jacobian(t, s.x, s.v, df_dx, df_dv);
  identity.setIdentity();
  df_dv += 0 * identity;  // the diagonal becomes part of the pattern

  WideSparseMatrix J(2 * n, 2 * n);
  J.reserve(2 * n + df_dx.nonZeros() + df_dv.nonZeros());
  for (int r = 0; r < n; ++r) {
    J.startVec(r);
    J.insertBack(r, r) = 0;
    J.insertBack(r, n + r) = 1;
  }
  const auto append_row = [&](int r, const SparseMatrix& block, int first_column) {
    for (SparseMatrix::InnerIterator entry(block, free_[r]); entry; ++entry)
      if (const int c = unknown_[entry.col()]; c >= 0) J.insertBack(n + r, first_column + c) = inverse_mass_[r] * entry.value();
  };
  for (int r = 0; r < n; ++r) {
    J.startVec(n + r);
    append_row(r, df_dx, 0);
    append_row(r, df_dv, n);
  }
  J.finalize();
  if (!J.coeffs().allFinite()) throw std::runtime_error(fmt::format("the Jacobian is not finite at t = {} s", t));
  return J;
}

}  // namespace drape::reference
