#include "reference/first_order.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace drape::reference {

using solver::SparseMatrix;
using solver::State;
using solver::Vectors;

namespace {

/// A scalar N × N matrix on all three coordinates: 3N × 3N.
SparseMatrix threefold(const SparseMatrix& scalar) {
  SparseMatrix result(3 * scalar.rows(), 3 * scalar.cols());
  result.reserve(Eigen::VectorXi::Constant(result.rows(), 8));
  for (int i = 0; i < scalar.outerSize(); ++i)
    for (SparseMatrix::InnerIterator entry(scalar, i); entry; ++entry)
      for (int c = 0; c < 3; ++c) result.insert(3 * i + c, 3 * static_cast<int>(entry.col()) + c) = entry.value();
  result.makeCompressed();
  return result;
}

}  // namespace

FirstOrderOde::FirstOrderOde(const solver::SplitOde& ode, const State& start, double t0)
    : ode_(ode), coordinates_(ode), start_(prescribed_start(ode, start)), t0_(t0), inverse_mass_(size() / 2) {
  for (Eigen::Index r = 0; r < inverse_mass_.size(); ++r) inverse_mass_[r] = 1 / ode.mass[coordinates_.free[r] / 3];
}

Eigen::VectorXd FirstOrderOde::initial() const {
  const int n = size() / 2;
  Eigen::VectorXd y(size());
  for (int r = 0; r < n; ++r) {
    y[r] = start_.x.data()[coordinates_.free[r]];
    y[n + r] = start_.v.data()[coordinates_.free[r]];
  }
  return y;
}

State FirstOrderOde::state(double t, const Eigen::Ref<const Eigen::VectorXd>& y) const {
  const int n = size() / 2;
  State s = start_;
  for (int i : coordinates_.pinned) s.x.data()[i] += start_.v.data()[i] * (t - t0_);
  for (int r = 0; r < n; ++r) {
    s.x.data()[coordinates_.free[r]] = y[r];
    s.v.data()[coordinates_.free[r]] = y[n + r];
  }
  return s;
}

Vectors FirstOrderOde::force(double t, const State& s, Part part) const {
  if (part == Part::linear) return ode_.stiffness * s.x + ode_.damping * s.v;
  Vectors f(ode_.particles(), 3);
  (part == Part::whole ? ode_.force : ode_.explicit_force)(t, s.x, s.v, f);
  return f;
}

void FirstOrderOde::derivative(double t, const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Ref<Eigen::VectorXd> dy,
                               Part part) const {
  const int n = size() / 2;
  const Vectors f = force(t, state(t, y), part);
  if (part == Part::remainder)
    dy.head(n).setZero();
  else
    dy.head(n) = y.tail(n);
  for (int r = 0; r < n; ++r) {
    dy[n + r] = inverse_mass_[r] * f.data()[coordinates_.free[r]];
    if (!std::isfinite(dy[n + r]))
      throw std::runtime_error(fmt::format("the force on particle {} is not finite at t = {} s", coordinates_.free[r] / 3, t));
  }
}

WideSparseMatrix FirstOrderOde::jacobian(double t, const Eigen::Ref<const Eigen::VectorXd>& y, Part part) const {
  const int n = size() / 2;
  SparseMatrix df_dx, df_dv, identity(3 * ode_.particles(), 3 * ode_.particles());
  if (part == Part::whole) {
    const State s = state(t, y);
    ode_.jacobian(t, s.x, s.v, df_dx, df_dv);
  } else {
    df_dx = threefold(ode_.stiffness);
    df_dv = threefold(ode_.damping);
  }
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
    for (SparseMatrix::InnerIterator entry(block, coordinates_.free[r]); entry; ++entry)
      if (const int c = coordinates_.unknown[entry.col()]; c >= 0)
        J.insertBack(n + r, first_column + c) = inverse_mass_[r] * entry.value();
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
