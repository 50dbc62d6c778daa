#include "reference/linear_motion.hpp"

#include <fmt/format.h>

#include <utility>

namespace drape::reference {
namespace {

using solver::SparseMatrix;
using solver::SplitOde;
using solver::State;
using solver::Vectors;

/// A vector field as one vector, as for the Jacobians: 3N.
auto flat(const Vectors& field) { return Eigen::VectorXd::Map(field.data(), field.size()); }

Eigen::VectorXd product(const SparseMatrix& matrix, const Vectors& field, bool transposed) {
  if (transposed) return matrix.transpose() * flat(field);
  return matrix * flat(field);
}

solver::Options options() {
  solver::Options options;
  options.stage = &solver::stage_kind("anderson");
  options.linear_solver = &solver::linear_solver("cholesky");
  options.max_updates = 500;
  return options;
}

/// The split of the equation of motion, with the same pins at rest and work of its own.
SplitOde at_rest(const SplitOde& ode) {
  SplitOde result;
  result.mass = ode.mass;
  result.stiffness = ode.stiffness;
  result.damping = ode.damping;
  for (SparseMatrix* part : {&result.stiffness, &result.damping})
    if (part->rows() == 0) part->resize(ode.particles(), ode.particles());
  result.pins = ode.pins;
  for (solver::Pin& pin : result.pins) pin.velocity.setZero();
  return result;
}

}  // namespace

LinearMotion::LinearMotion(const SplitOde& ode, Trajectory middles, double h)
    : ode_(ode),
      middles_(std::move(middles)),
      h_(h),
      stage_ode_(at_rest(ode)),
      stage_(stage_ode_, options()),
      y_{Vectors::Zero(ode.particles(), 3), Vectors::Zero(ode.particles(), 3)} {
  stage_ode_.force = [this](double, const Vectors&, const Vectors& v, Vectors& f) {
    f.resize(v.rows(), 3);
    Eigen::VectorXd::Map(f.data(), f.size()) = product(steep_, v, transposed_);
  };
}

void LinearMotion::linearise(std::size_t step) {
  const State& y = middles_.states[step];
  if (ode_.memory) ode_.memory->begin(1, middles_.times[step], y);
  ode_.jacobian(middles_.times[step], y.x, y.v, dx_, dv_);
  steep_ = h_ / 2 * dx_ + dv_;
}

Vectors LinearMotion::filtered(const Eigen::VectorXd& product) const {
  Vectors field = Vectors::Map(product.data(), ode_.particles(), 3);
  solver::filter(ode_.pins, field);
  return field;
}

const Vectors& LinearMotion::solve(const Vectors& right) {
  const Vectors nowhere = Vectors::Zero(right.rows(), 3);
  y_.v = right;
  const solver::StageResult result = stage_.solve({.gamma = h_ / 2, .t = 0, .ax = nowhere, .av = right}, y_);
  if (result.outcome != solver::Outcome::success)
    throw NotSolved(fmt::format("the linearised motion: {}", to_string(result.outcome)));
  return y_.v;
}

std::vector<Vectors> LinearMotion::forward(State y) {
  transposed_ = false;
  std::vector<Vectors> positions;
  for (std::size_t k = 0; k < middles_.states.size(); ++k) {
    linearise(k);
    const Vectors& w = solve(y.v + h_ / 2 * ode_.mass.cwiseInverse().asDiagonal() * filtered(product(dx_, y.x, false)));
    y.x += h_ * w;
    y.v = 2 * w - y.v;
    positions.push_back(y.x);
  }
  return positions;
}

State LinearMotion::transposed(const std::vector<Vectors>& weights) {
  transposed_ = true;
  // The transpose of v is M μ: so its steps have the matrix of the forward ones, transposed.
  State y{Vectors::Zero(ode_.particles(), 3), Vectors::Zero(ode_.particles(), 3)};
  Vectors &a = y.x, &mu = y.v;
  for (std::size_t k = middles_.states.size(); k-- > 0;) {
    linearise(k);
    a += weights[k];
    const Vectors& w = solve(mu + h_ / 2 * ode_.mass.cwiseInverse().asDiagonal() * filtered(flat(a)));
    a += h_ * filtered(product(dx_, w, true));
    mu = 2 * w - mu;
  }
  return {std::move(a), ode_.mass.asDiagonal() * mu};
}

}  // namespace drape::reference
