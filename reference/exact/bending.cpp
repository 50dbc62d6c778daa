#include "reference/exact/bending.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "reference/exact/polynomials.hpp"
#include "solver/base/largest.hpp"

namespace drape::reference {
namespace {

using Complex = std::complex<double>;
using Vector = BoundaryValueProblem::Vector;

/// y = (x, z, θ, κ, τ, p = τ', c). The force through a cross-section is (0, f (X − c)): its horizontal part vanishes at the
/// free end and nothing adds to it. Then B s''' = τ t − (0, f (X − c)), split along t and N.
BoundaryValueProblem whole(const BentSheet& sheet) {
  const auto [k, B, f, force] = sheet;
  const auto derivative = [k = k, B = B, f = f](double X, const Vector& y) -> Vector {
    const Complex theta = y[2], kappa = y[3], tau = y[4], p = y[5], V = f * (X - y[6]);
    const Complex lambda = 1.0 + tau / k, sine = std::sin(theta), cosine = std::cos(theta);
    Vector dy(7);
    dy << lambda * cosine, lambda * sine, kappa, (-V * cosine / B - 2.0 * p / k * kappa) / lambda, p,
        k / B * (tau - V * sine + B * lambda * kappa * kappa), 0;
    return dy;
  };
  const auto conditions = [](const Vector& left, const Vector& right) -> Vector {
    Vector zero(7);
    zero << left[0], left[1], left[3], left[5], right[1], right[3], right[5];
    return zero;
  };
  return {derivative, conditions};
}

/// y = (x, z, θ, κ, μ = κ', τ). Along t: τ' = f sin θ; along N: B <N, s''''> = τ κ − f cos θ, where
/// <N, s''''> = λ κ'' + 3 λ' κ' + 3 λ'' κ − λ κ³.
BoundaryValueProblem along_normal(const BentSheet& sheet) {
  const auto [k, B, f, force] = sheet;
  const auto derivative = [k = k, B = B, f = f](double, const Vector& y) -> Vector {
    const Complex theta = y[2], kappa = y[3], mu = y[4], tau = y[5];
    const Complex lambda = 1.0 + tau / k, sine = std::sin(theta), cosine = std::cos(theta);
    const Complex d_lambda = f * sine / k, dd_lambda = f * cosine * kappa / k;
    Vector dy(6);
    dy << lambda * cosine, lambda * sine, kappa, mu,
        ((tau * kappa - f * cosine) / B - 3.0 * d_lambda * mu - 3.0 * dd_lambda * kappa) / lambda + kappa * kappa * kappa,
        f * sine;
    return dy;
  };
  const auto conditions = [k = k, B = B, f = f](const Vector& left, const Vector& right) -> Vector {
    const Complex theta = right[2], tau = right[5], sine = std::sin(theta);
    const Complex Q = B * (2.0 * f * sine / k * right[3] + (1.0 + tau / k) * right[4]);  // <N, B s'''>
    Vector zero(6);
    zero << left[0], left[1], left[3], right[1], right[3], tau * std::cos(theta) + Q * sine;
    return zero;
  };
  return {derivative, conditions};
}

BoundaryValueProblem problem(const BentSheet& sheet) {
  return sheet.force == BendingForce::whole ? whole(sheet) : along_normal(sheet);
}

/// With polynomials of the lowest sufficient degree, from the flat strip, stiff enough to stay nearly flat, down to the
/// requested bending modulus.
PiecewisePolynomial roughly(const BentSheet& sheet) {
  const auto flat = [&](double X) -> Eigen::VectorXd {
    Eigen::VectorXd y = Eigen::VectorXd::Zero(sheet.force == BendingForce::whole ? 7 : 6);
    y[0] = X;
    if (sheet.force == BendingForce::whole) y[6] = 0.5;
    return y;
  };
  PiecewisePolynomial y(graded_breaks(8, 0.25, 2), 6, flat);
  BentSheet stage = sheet;
  for (stage.bend = std::max(sheet.bend, sheet.body_force);; stage.bend = std::max(stage.bend / 3, sheet.bend)) {
    collocate(problem(stage), y);
    if (stage.bend == sheet.bend) return y;
  }
}

/// The solution with polynomials of another degree, from one that is near.
PiecewisePolynomial refined(const BentSheet& sheet, const PiecewisePolynomial& near, int degree) {
  PiecewisePolynomial y(near.breaks(), degree, near);
  collocate(problem(sheet), y);
  return y;
}

}  // namespace

BentStrip::BentStrip(const BentSheet& sheet) : BentStrip(sheet, refined(sheet, roughly(sheet), 12)) {}

BentStrip::BentStrip(const BentSheet& sheet, const PiecewisePolynomial& coarser)
    : solution_(refined(sheet, coarser, 16)), error_(0) {
  for (const double X : Eigen::VectorXd::LinSpaced(201, 0, 1))
    error_ = base::larger(error_, (solution_(X) - coarser(X)).head<2>().norm());
}

Eigen::Vector3d BentStrip::slope_curvature_tension(double X) const {
  const Eigen::VectorXd y = solution_(X);
  return {y[2], y[3], y[y.size() == 7 ? 4 : 5]};
}

}  // namespace drape::reference
