#include "reference/exact/collocation.hpp"

#include <Eigen/Sparse>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "reference/exact/polynomials.hpp"
#include "solver/base/decompositions.hpp"

namespace drape::reference {
namespace {

using Vector = BoundaryValueProblem::Vector;

/// ∂F/∂y at a real y.
template <class Function>
Eigen::MatrixXd complex_step(const Function& F, Vector y, Eigen::Index rows) {
  constexpr double step = 1e-30;
  Eigen::MatrixXd jacobian(rows, y.size());
  for (Eigen::Index j = 0; j < y.size(); ++j) {
    const double value = y[j].real();
    y[j] = {value, step};
    jacobian.col(j) = F(y).imag() / step;
    y[j] = value;
  }
  return jacobian;
}

/// The equations that the values at the nodes obey, linearised.
struct Linearised {
  Eigen::VectorXd residual;
  std::vector<Eigen::Triplet<double>> jacobian;

  void add(Eigen::Index row, Eigen::Index column, const Eigen::MatrixXd& block) {
    for (Eigen::Index i = 0; i < block.rows(); ++i)
      for (Eigen::Index j = 0; j < block.cols(); ++j)
        if (block(i, j) != 0) jacobian.emplace_back(static_cast<int>(row + i), static_cast<int>(column + j), block(i, j));
  }
};

/// y' − g(X, y) at the Gauss points of every piece.
void add_pieces(const BoundaryValueProblem& problem, const PiecewisePolynomial& y, Linearised& system) {
  const Eigen::Index size = y.values().rows(), degree = y.nodes().size() - 1;
  const Eigen::VectorXd points = gauss(static_cast<int>(degree)).points;
  const Eigen::MatrixXd P = interpolation(y.nodes(), points), D = P * differentiation(y.nodes());
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(size, size);
  for (Eigen::Index piece = 0; piece + 1 < y.breaks().size(); ++piece) {
    const double begin = y.breaks()[piece], length = y.breaks()[piece + 1] - begin;
    const auto values = y.values().middleCols(piece * degree, degree + 1);
    for (Eigen::Index i = 0; i < degree; ++i) {
      const Vector at = (values * P.row(i).transpose()).cast<std::complex<double>>();
      const auto g = [&](const Vector& z) { return problem.derivative(begin + length * points[i], z); };
      const Eigen::MatrixXd dg = complex_step(g, at, size);
      const Eigen::Index row = size * (piece * degree + i);
      system.residual.segment(row, size) = values * D.row(i).transpose() - length * g(at).real();
      for (Eigen::Index j = 0; j <= degree; ++j)
        system.add(row, size * (piece * degree + j), D(i, j) * I - length * P(i, j) * dg);
    }
  }
}

void add_conditions(const BoundaryValueProblem& problem, const PiecewisePolynomial& y, Linearised& system) {
  const Eigen::Index size = y.values().rows(), last = y.values().size() - size;
  Vector ends(2 * size);
  ends << y.values().leftCols<1>().cast<std::complex<double>>(), y.values().rightCols<1>().cast<std::complex<double>>();
  const auto conditions = [&](const Vector& z) { return problem.conditions(z.head(size), z.tail(size)); };
  system.residual.segment(last, size) = conditions(ends).real();
  const Eigen::MatrixXd jacobian = complex_step(conditions, ends, size);
  system.add(last, 0, jacobian.leftCols(size));
  system.add(last, last, jacobian.rightCols(size));
}

}  // namespace

PiecewisePolynomial::PiecewisePolynomial(Eigen::VectorXd breaks, int degree,
                                         const std::function<Eigen::VectorXd(double X)>& values)
    : breaks_(std::move(breaks)), nodes_(chebyshev(degree)) {
  const Eigen::Index pieces = breaks_.size() - 1;
  values_.resize(values(0).size(), pieces * degree + 1);
  for (Eigen::Index piece = 0; piece < pieces; ++piece)
    for (int j = 0; j <= degree; ++j)
      values_.col(piece * degree + j) = values(breaks_[piece] + nodes_[j] * (breaks_[piece + 1] - breaks_[piece]));
}

Eigen::VectorXd PiecewisePolynomial::operator()(double X) const {
  const auto [piece, point] = place(breaks_, X);
  const Eigen::Index degree = nodes_.size() - 1;
  return values_.middleCols(piece * degree, degree + 1) *
         interpolation(nodes_, Eigen::VectorXd::Constant(1, point)).row(0).transpose();
}

void collocate(const BoundaryValueProblem& problem, PiecewisePolynomial& y) {
  Eigen::SparseMatrix<double> jacobian(y.values().size(), y.values().size());
  for (int iteration = 0; iteration < 30; ++iteration) {
    Linearised system{Eigen::VectorXd(y.values().size()), {}};
    add_pieces(problem, y, system);
    add_conditions(problem, y, system);
    jacobian.setFromTriplets(system.jacobian.begin(), system.jacobian.end());
    const auto inverse = base::lu_inverse(jacobian);
    if (!inverse) break;
    const Eigen::VectorXd update = inverse(system.residual);
    y.values().reshaped() -= update;
    // Convergence is quadratic: after an update so small nothing is left but rounding.
    const double size = update.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(size)) break;
    if (size <= 1e-8 * y.values().lpNorm<Eigen::Infinity>()) return;
  }
  throw std::runtime_error("Newton's method for a boundary-value problem did not converge: it needs a better first guess.");
}

}  // namespace drape::reference
