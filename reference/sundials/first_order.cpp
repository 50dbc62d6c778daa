#include "reference/sundials/first_order.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "reference/sundials/sparse_rows.hpp"
#include "solver/linear/kernels.hpp"

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
      inverse_mass_(ode.mass.cwiseInverse().replicate(1, 3)),
      oblique_(ode.pins),
      scratch_{.damping = Vectors::Zero(ode.particles(), 3)} {
  for (const int i : coordinates_.pinned) inverse_mass_.data()[i] = 0;
  if (!oblique_.empty()) free_ = oblique_.matrix(ode.particles());
}

State FirstOrderOde::output(double t, State y) const {
  for (const int i : coordinates_.pinned) {
    y.x.data()[i] = start_.x.data()[i] + start_.v.data()[i] * (t - t0_);
    y.v.data()[i] = start_.v.data()[i];
  }
  return y;
}

Eigen::VectorXd FirstOrderOde::gather(const State& y) const {
  Eigen::VectorXd unknowns(size());
  for (int r = 0; r < size() / 2; ++r) {
    unknowns[r] = y.x.data()[coordinates_.free[r]];
    unknowns[size() / 2 + r] = y.v.data()[coordinates_.free[r]];
  }
  return unknowns;
}

void FirstOrderOde::scatter(const Eigen::VectorXd& unknowns, State& y) const {
  for (int r = 0; r < size() / 2; ++r) {
    y.x.data()[coordinates_.free[r]] = unknowns[r];
    y.v.data()[coordinates_.free[r]] = unknowns[size() / 2 + r];
  }
}

const SparseMatrix& FirstOrderOde::stiffness() const { return ode_.memory ? ode_.memory->stiffness() : ode_.stiffness; }

void FirstOrderOde::evaluate(double t, const State& y, Part part, Vectors& f) const {
  if (part != Part::linear) return (part == Part::whole ? ode_.force : ode_.explicit_force)(t, y.x, y.v, f);
  solver::multiply(stiffness(), y.x, f);
  if (ode_.damping.nonZeros() == 0) return;
  solver::multiply(ode_.damping, y.v, scratch_.damping);
  f += scratch_.damping;
}

/// Where it begins, forces are those of the state's own internal variables.
void FirstOrderOde::derive_memory(double t, const State& y, Part part, Eigen::VectorXd& dz) const {
  constexpr int any_order = 1;
  ode_.memory->begin(any_order, t, y);
  if (part == Part::linear)
    dz.setZero(y.z.size());
  else
    ode_.memory->rate(y, dz);
}

void FirstOrderOde::derivative(double t, const State& y, State& dy, Part part) const {
  if (part == Part::remainder)
    dy.x.setZero();
  else
    dy.x = y.v;
  if (ode_.memory) derive_memory(t, y, part, dy.z);
  evaluate(t, y, part, dy.v);
  dy.v.array() *= inverse_mass_.array();
  oblique_(dy.v);
  if (std::isfinite(dy.v.sum())) return;
  for (int i = 0; i < ode_.particles(); ++i)
    if (!dy.v.row(i).allFinite())
      throw std::runtime_error(fmt::format("the force on particle {} is not finite at t = {} s", i, t));
}

void FirstOrderOde::update_derivatives(double t, const State& y, Part part) const {
  if (ode_.memory) ode_.memory->begin(1, t, y);
  if (part == Part::whole) {
    ode_.jacobian(t, y.x, y.v, scratch_.df_dx, scratch_.df_dv);
  } else {
    scratch_.df_dx = threefold(stiffness());
    scratch_.df_dv = threefold(ode_.damping);
  }
  if (oblique_.empty()) return;
  for (SparseMatrix* derivative : {&scratch_.df_dx, &scratch_.df_dv}) *derivative = SparseMatrix(free_ * *derivative);
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
      if (const int c = coordinates_.unknown[entry.col()]; c >= 0) add(n + r, c, inverse_mass_.data()[i] * entry.value());
    for_row_with_diagonal(scratch_.df_dv, i, [&](int column, double value) {
      if (const int c = coordinates_.unknown[column]; c >= 0) add(n + r, n + c, inverse_mass_.data()[i] * value);
    });
  }
}

const WideSparseMatrix& FirstOrderOde::jacobian(double t, const State& y, Part part) const {
  update_derivatives(t, y, part);
  fill(scratch_.jacobian, size(), [&](const auto& add) { for_entries(add); });
  if (!std::isfinite(scratch_.jacobian.coeffs().sum()))
    throw std::runtime_error(fmt::format("the Jacobian is not finite at t = {} s", t));
  return scratch_.jacobian;
}

}  // namespace drape::reference
