#include "reference/first_order.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "reference/sparse_rows.hpp"

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
    : ode_(ode),
      coordinates_(ode),
      start_(prescribed_start(ode, start)),
      t0_(t0),
      inverse_mass_(size() / 2),
      scratch_{.state = start_, .force = Vectors::Zero(ode.particles(), 3)} {
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

State FirstOrderOde::state(double t, const Eigen::Ref<const Eigen::VectorXd>& y) const { return put_in(t, y); }

const State& FirstOrderOde::put_in(double t, const Eigen::Ref<const Eigen::VectorXd>& y) const {
  const int n = size() / 2;
  State& s = scratch_.state;
  for (int i : coordinates_.pinned) s.x.data()[i] = start_.x.data()[i] + start_.v.data()[i] * (t - t0_);
  for (int r = 0; r < n; ++r) {
    s.x.data()[coordinates_.free[r]] = y[r];
    s.v.data()[coordinates_.free[r]] = y[n + r];
  }
  return s;
}

Vectors FirstOrderOde::spread(const Eigen::Ref<const Eigen::VectorXd>& free) const {
  Vectors all = Vectors::Zero(ode_.particles(), 3);
  for (Eigen::Index r = 0; r < free.size(); ++r) all.data()[coordinates_.free[r]] = free[r];
  return all;
}

void FirstOrderOde::gather(const Vectors& all, Eigen::Ref<Eigen::VectorXd> free) const {
  for (Eigen::Index r = 0; r < free.size(); ++r) free[r] = all.data()[coordinates_.free[r]];
}

void FirstOrderOde::evaluate(double t, const State& s, Part part, Vectors& f) const {
  if (part != Part::linear) return (part == Part::whole ? ode_.force : ode_.explicit_force)(t, s.x, s.v, f);
  f.noalias() = ode_.stiffness * s.x;
  if (ode_.damping.nonZeros() > 0) f += ode_.damping * s.v;
}

void FirstOrderOde::derivative(double t, const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Ref<Eigen::VectorXd> dy,
                               Part part) const {
  const int n = size() / 2;
  evaluate(t, put_in(t, y), part, scratch_.force);
  if (part == Part::remainder)
    dy.head(n).setZero();
  else
    dy.head(n) = y.tail(n);
  gather(scratch_.force, dy.tail(n));
  dy.tail(n).array() *= inverse_mass_.array();
  if (std::isfinite(dy.sum())) return;
  for (int r = 0; r < n; ++r)
    if (!std::isfinite(dy[n + r]))
      throw std::runtime_error(fmt::format("the force on particle {} is not finite at t = {} s", coordinates_.free[r] / 3, t));
}

void FirstOrderOde::update_derivatives(double t, const Eigen::Ref<const Eigen::VectorXd>& y, Part part) const {
  if (part == Part::whole) {
    const State& s = put_in(t, y);
    ode_.jacobian(t, s.x, s.v, scratch_.df_dx, scratch_.df_dv);
  } else {
    scratch_.df_dx = threefold(ode_.stiffness);
    scratch_.df_dv = threefold(ode_.damping);
  }
}

template <class Add>
void FirstOrderOde::for_entries(const Add& add) const {
  const int n = size() / 2;
  for (int r = 0; r < n; ++r) {
    add(r, r, 0.0);
    add(r, n + r, 1.0);
  }
  for (int r = 0; r < n; ++r) {
    const int i = coordinates_.free[r];
    for (SparseMatrix::InnerIterator entry(scratch_.df_dx, i); entry; ++entry)
      if (const int c = coordinates_.unknown[entry.col()]; c >= 0) add(n + r, c, inverse_mass_[r] * entry.value());
    for_row_with_diagonal(scratch_.df_dv, i, [&](int column, double value) {
      if (const int c = coordinates_.unknown[column]; c >= 0) add(n + r, n + c, inverse_mass_[r] * value);
    });
  }
}

const WideSparseMatrix& FirstOrderOde::jacobian(double t, const Eigen::Ref<const Eigen::VectorXd>& y, Part part) const {
  update_derivatives(t, y, part);
  fill(scratch_.jacobian, size(), [&](const auto& add) { for_entries(add); });
  if (!std::isfinite(scratch_.jacobian.coeffs().sum()))
    throw std::runtime_error(fmt::format("the Jacobian is not finite at t = {} s", t));
  return scratch_.jacobian;
}

}  // namespace drape::reference
