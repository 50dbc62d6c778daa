#pragma once

#include <Eigen/Dense>
#include <functional>

namespace drape::reference {

/// y' = g(X, y) on 0 ≤ X ≤ 1 with as many boundary conditions as components. The functions are written for complex numbers
/// and must be analytic in y: their derivatives are then exact (complex step).
struct BoundaryValueProblem {
  using Vector = Eigen::VectorXcd;
  std::function<Vector(double X, const Vector& y)> derivative;
  std::function<Vector(const Vector& left, const Vector& right)> conditions;  ///< zero if they hold
};

/// Continuous and polynomial of the same degree on every piece.
class PiecewisePolynomial {
 public:
  /// The polynomial with these values at the nodes of the pieces between `breaks`.
  PiecewisePolynomial(Eigen::VectorXd breaks, int degree, const std::function<Eigen::VectorXd(double X)>& values);

  Eigen::VectorXd operator()(double X) const;

  const Eigen::VectorXd& breaks() const { return breaks_; }
  const Eigen::VectorXd& nodes() const { return nodes_; }  ///< of a piece, 0 … 1; neighbours share one
  Eigen::MatrixXd& values() { return values_; }            ///< a column for every node of [0, 1]
  const Eigen::MatrixXd& values() const { return values_; }

 private:
  Eigen::VectorXd breaks_, nodes_;
  Eigen::MatrixXd values_;
};

/// Solves by collocation at the Gauss points of every piece, with Newton's method from y, which gives the pieces and the
/// degree. Where the solution is smooth the error is of order degree + 1 in the length of the pieces, 2·degree at their ends.
/// Throws std::runtime_error if Newton's method does not converge.
void collocate(const BoundaryValueProblem& problem, PiecewisePolynomial& y);

}  // namespace drape::reference
