#pragma once

#include <Eigen/Dense>

namespace drape::reference {

/// A quadrature rule on [0, 1].
struct Quadrature {
  Eigen::VectorXd points, weights;
};

/// The Gauss rule with n points, exact up to degree 2n − 1; from the eigenvalues of the Jacobi matrix [Golub, Welsch 1969].
Quadrature gauss(int n);

/// The degree + 1 Chebyshev points on [0, 1], ends included, in which polynomials are represented by their values.
Eigen::VectorXd chebyshev(int degree);

/// Row i: the Lagrange polynomials of `nodes` at points[i]. Times values at the nodes: values at the points.
Eigen::MatrixXd interpolation(const Eigen::VectorXd& nodes, const Eigen::VectorXd& points);

/// Times values at the nodes: derivatives at the nodes [Berrut, Trefethen 2004, (9.4)].
Eigen::MatrixXd differentiation(const Eigen::VectorXd& nodes);

/// Ends of the pieces of [0, 1]: 2·`levels` pieces that shrink towards both ends by `ratio`, as layers and corners need it,
/// each cut in `parts`.
Eigen::VectorXd graded_breaks(int levels, double ratio, int parts = 1);

/// A place in a piecewise polynomial: the piece and the point in it, 0 … 1.
struct Place {
  int piece;
  double point;
};
Place place(const Eigen::VectorXd& breaks, double X);

}  // namespace drape::reference
