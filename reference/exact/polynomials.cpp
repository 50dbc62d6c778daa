#include "reference/exact/polynomials.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/base/decompositions.hpp"

namespace drape::reference {
namespace {

/// Barycentric weights 1/Π(x_j − x_k), the differences scaled by the capacity ¼ of [0, 1] against underflow.
Eigen::ArrayXd barycentric_weights(const Eigen::VectorXd& nodes) {
  Eigen::ArrayXd w = Eigen::ArrayXd::Ones(nodes.size());
  for (Eigen::Index j = 0; j < nodes.size(); ++j)
    for (Eigen::Index k = 0; k < nodes.size(); ++k)
      if (k != j) w[j] /= 4 * (nodes[j] - nodes[k]);
  return w;
}

}  // namespace

Quadrature gauss(int n) {
  Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(n, n);
  for (int k = 1; k < n; ++k) jacobi(k, k - 1) = k / std::sqrt(4.0 * k * k - 1);
  const auto [values, vectors] = base::symmetric_eigen(jacobi);
  return {(values.array() + 1) / 2, vectors.row(0).array().square().transpose()};
}

Eigen::VectorXd chebyshev(int degree) {
  const Eigen::ArrayXd angles = Eigen::ArrayXd::LinSpaced(degree + 1, 0, std::numbers::pi / 2);
  return angles.sin().square();
}

Eigen::MatrixXd interpolation(const Eigen::VectorXd& nodes, const Eigen::VectorXd& points) {
  const Eigen::ArrayXd w = barycentric_weights(nodes);
  Eigen::MatrixXd P(points.size(), nodes.size());
  for (Eigen::Index i = 0; i < points.size(); ++i) {
    const Eigen::ArrayXd distance = points[i] - nodes.array();
    Eigen::Index nearest;
    const bool at_node = distance.abs().minCoeff(&nearest) == 0;
    if (at_node) {
      P.row(i) = Eigen::RowVectorXd::Unit(nodes.size(), nearest);
    } else {
      P.row(i) = (w / distance / (w / distance).sum()).transpose();
    }
  }
  return P;
}

Eigen::MatrixXd differentiation(const Eigen::VectorXd& nodes) {
  const Eigen::ArrayXd w = barycentric_weights(nodes);
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(nodes.size(), nodes.size());
  for (Eigen::Index i = 0; i < nodes.size(); ++i) {
    for (Eigen::Index j = 0; j < nodes.size(); ++j)
      if (j != i) D(i, j) = w[j] / w[i] / (nodes[i] - nodes[j]);
    D(i, i) = -D.row(i).sum();
  }
  return D;
}

Eigen::VectorXd graded_breaks(int levels, double ratio, int parts) {
  Eigen::VectorXd ends(2 * levels + 1);
  ends[0] = 0;
  for (int k = 1; k <= levels; ++k) ends[k] = 0.5 * std::pow(ratio, levels - k);
  for (int k = 0; k < levels; ++k) ends[2 * levels - k] = 1 - ends[k];
  Eigen::VectorXd breaks(2 * levels * parts + 1);
  for (int k = 0; k < breaks.size() - 1; ++k) {
    const double part = static_cast<double>(k % parts) / parts;
    breaks[k] = (1 - part) * ends[k / parts] + part * ends[k / parts + 1];
  }
  breaks[breaks.size() - 1] = 1;
  return breaks;
}

Place place(const Eigen::VectorXd& breaks, double X) {
  const auto pieces = static_cast<int>(breaks.size()) - 1;
  const auto above = std::upper_bound(breaks.begin(), breaks.end(), X);
  const int piece = std::clamp(static_cast<int>(above - breaks.begin()) - 1, 0, pieces - 1);
  return {piece, (X - breaks[piece]) / (breaks[piece + 1] - breaks[piece])};
}

}  // namespace drape::reference
