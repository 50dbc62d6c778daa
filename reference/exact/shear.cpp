#include "reference/exact/shear.hpp"

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "reference/exact/polynomials.hpp"
#include "solver/base/largest.hpp"

namespace drape::reference {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector4d;
using Eigen::VectorXd;
using Values = ShearedSheet::Surface;

/// The energy density W = ½ k (|p| − 1)² + ½ k (|q| − 1)² + ½ G <p, q>² derived by (p, q) = (s_u, s_v).
struct Density {
  Vector4d gradient;
  Matrix4d hessian;

  Density(double k, double G, const Vector2d& p, const Vector2d& q) {
    const Matrix2d I = Matrix2d::Identity();
    const auto tension = [&](const Vector2d& a) -> Vector2d { return k * (1 - 1 / a.norm()) * a; };
    const auto stiffness = [&](const Vector2d& a) -> Matrix2d {
      return k * ((1 - 1 / a.norm()) * I + a * a.transpose() / std::pow(a.norm(), 3));
    };
    const double sigma = G * p.dot(q);
    gradient << tension(p) + sigma * q, tension(q) + sigma * p;
    hessian << stiffness(p) + G * q * q.transpose(), sigma * I + G * q * p.transpose(),  //
        sigma * I + G * p * q.transpose(), stiffness(q) + G * p * p.transpose();
  }
};

/// The square element [0, 1]²: its quadrature, and the basis functions (columns) at the quadrature points (rows).
struct Element {
  VectorXd weights;
  MatrixXd value, du, dv;

  explicit Element(const VectorXd& nodes) {
    const Quadrature rule = gauss(static_cast<int>(nodes.size()) + 1);
    const MatrixXd P = interpolation(nodes, rule.points), D = P * differentiation(nodes);
    weights = product(rule.weights, rule.weights);
    value = product(P, P);
    du = product(D, P);
    dv = product(P, D);
  }

  /// Kronecker product; the index along u runs faster.
  static MatrixXd product(const MatrixXd& u, const MatrixXd& v) {
    MatrixXd uv(u.rows() * v.rows(), u.cols() * v.cols());
    for (Eigen::Index i = 0; i < v.rows(); ++i)
      for (Eigen::Index j = 0; j < v.cols(); ++j) uv.block(i * u.rows(), j * u.cols(), u.rows(), u.cols()) = v(i, j) * u;
    return uv;
  }
};

/// Gradient and lower half of the Hessian of the energy by the free coordinates, those of the nodes beyond u = 0.
struct System {
  VectorXd gradient;
  std::vector<Eigen::Triplet<double>> hessian;
};

/// The energy of one element by all of its coordinates, first all x, then all y.
struct ElementEnergy {
  VectorXd gradient;
  MatrixXd hessian;

  ElementEnergy(const SideloadedSheet& sheet, const Element& element, double lu, double lv, const Eigen::MatrixX2d& x) {
    const auto [L, k, G, f] = sheet;
    const MatrixXd d[] = {element.du / lu, element.dv / lv};
    const Eigen::MatrixX2d p = d[0] * x, q = d[1] * x;
    const VectorXd w = lu * lv * element.weights;
    Eigen::MatrixX4d stress(w.size(), 4);
    Eigen::Matrix<double, Eigen::Dynamic, 16> moduli(w.size(), 16);
    for (Eigen::Index i = 0; i < w.size(); ++i) {
      const Density W(k, G, p.row(i), q.row(i));
      stress.row(i) = w[i] * W.gradient;
      moduli.row(i) = w[i] * W.hessian.reshaped();
    }
    const Eigen::Index n = x.rows();
    gradient.setZero(2 * n);
    hessian.setZero(2 * n, 2 * n);
    gradient.tail(n) = -f * element.value.transpose() * w;
    for (int a = 0; a < 4; ++a) {
      gradient.segment(a % 2 * n, n) += d[a / 2].transpose() * stress.col(a);
      for (int b = 0; b < 4; ++b)
        hessian.block(a % 2 * n, b % 2 * n, n, n) += d[a / 2].transpose() * moduli.col(a + 4 * b).asDiagonal() * d[b / 2];
    }
  }
};

void add(const ElementEnergy& energy, const std::vector<int>& nodes, int lines, System& system) {
  const auto n = static_cast<int>(nodes.size());
  const auto index = [&](int r) {  // of a coordinate among the free ones; negative: it is fixed
    const int node = nodes[r % n], i = node % lines, j = node / lines;
    return i == 0 ? -1 : 2 * (i - 1 + (lines - 1) * j) + r / n;
  };
  for (int r = 0; r < 2 * n; ++r) {
    const int row = index(r);
    if (row < 0) continue;
    system.gradient[row] += energy.gradient[r];
    for (int c = 0; c < 2 * n; ++c)
      if (const int column = index(c); column >= 0 && column <= row)
        system.hessian.emplace_back(row, column, energy.hessian(r, c));
  }
}

System linearise(const SideloadedSheet& sheet, const Element& element, const Values& surface) {
  const int lines = surface.lines(), degree = static_cast<int>(surface.nodes.size()) - 1;
  System system{VectorXd::Zero(2 * (lines - 1) * lines), {}};
  const VectorXd lengths =
      sheet.side * (surface.breaks.tail(surface.breaks.size() - 1) - surface.breaks.head(surface.breaks.size() - 1));
  for (int b = 0; b < lengths.size(); ++b)
    for (int a = 0; a < lengths.size(); ++a) {
      std::vector<int> nodes;
      for (int j = 0; j <= degree; ++j)
        for (int i = 0; i <= degree; ++i) nodes.push_back(a * degree + i + lines * (b * degree + j));
      add({sheet, element, lengths[a], lengths[b], surface.values(nodes, Eigen::all)}, nodes, lines, system);
    }
  return system;
}

/// Newton's method.
void minimise(const SideloadedSheet& sheet, Values& surface) {
  const Element element(surface.nodes);
  const int lines = surface.lines();
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> cholesky;
  for (int iteration = 0; iteration < 20; ++iteration) {
    const System system = linearise(sheet, element, surface);
    Eigen::SparseMatrix<double> hessian(system.gradient.size(), system.gradient.size());
    hessian.setFromTriplets(system.hessian.begin(), system.hessian.end());
    if (iteration == 0) cholesky.analyzePattern(hessian);
    cholesky.factorize(hessian);
    if (cholesky.info() != Eigen::Success) {
      throw std::runtime_error(
          "The sheared sheet buckles in its plane where it is compressed: body force and modulus must be smaller.");
    }
    const VectorXd update = cholesky.solve(system.gradient);
    for (int j = 0; j < lines; ++j)
      surface.values.middleRows(1 + lines * j, lines - 1) -=
          update.segment(2 * (lines - 1) * j, 2 * (lines - 1)).reshaped<Eigen::RowMajor>(lines - 1, 2);
    // Convergence is quadratic: after an update so small nothing is left but rounding.
    if (update.lpNorm<Eigen::Infinity>() <= 1e-8 * sheet.side) return;
  }
  throw std::runtime_error("Newton's method for the sheared sheet did not converge: body force and modulus must be smaller.");
}

/// The surface with the values of another function of (u, v) at its nodes.
template <class Function>
void set_values(Values& surface, const Function& function) {
  const VectorXd at = surface.coordinates();
  for (Eigen::Index j = 0; j < at.size(); ++j)
    for (Eigen::Index i = 0; i < at.size(); ++i) surface.values.row(i + at.size() * j) = function(at[i], at[j]).transpose();
}

Values flat_minimised(const SideloadedSheet& sheet, int degree, int levels) {
  Values surface(degree, levels);
  set_values(surface, [&](double u, double v) -> Vector2d { return {sheet.side * u, sheet.side * v}; });
  minimise(sheet, surface);
  return surface;
}

}  // namespace

Vector2d inextensible_position(const SideloadedSheet& sheet, double X, double Y) {
  const auto [L, k, G, f] = sheet;
  const auto primitive = [](double slope) { return (slope * std::sqrt(1 - slope * slope) + std::asin(slope)) / 2; };
  return {G / f * (primitive(f / G * L) - primitive(f / G * (L - X))), Y + f / G * (L * X - X * X / 2)};
}

ShearedSheet::Surface::Surface(int degree, int levels) : breaks(graded_breaks(levels, 0.4)), nodes(chebyshev(degree)) {
  values.resize(lines() * lines(), 2);
}

VectorXd ShearedSheet::Surface::coordinates() const {
  const Eigen::Index degree = nodes.size() - 1;
  VectorXd at(lines());
  for (Eigen::Index piece = 0; piece + 1 < breaks.size(); ++piece)
    at.segment(piece * degree, degree + 1).array() = breaks[piece] + nodes.array() * (breaks[piece + 1] - breaks[piece]);
  return at;
}

Vector2d ShearedSheet::Surface::operator()(double u, double v) const {
  const Place a = place(breaks, u), b = place(breaks, v);
  const auto basis = [this](const Place& at) -> Eigen::RowVectorXd {
    return interpolation(nodes, VectorXd::Constant(1, at.point));
  };
  const Eigen::RowVectorXd Pu = basis(a), Pv = basis(b);
  const Eigen::Index degree = nodes.size() - 1;
  Vector2d s = Vector2d::Zero();
  for (Eigen::Index j = 0; j <= degree; ++j)
    s += Pv[j] * Pu * values.middleRows(a.piece * degree + lines() * (b.piece * degree + j), degree + 1);
  return s;
}

ShearedSheet::ShearedSheet(const SideloadedSheet& sheet, int degree, int levels)
    : ShearedSheet(sheet, Surface(degree, levels), flat_minimised(sheet, degree - 2, levels - 1)) {}

ShearedSheet::ShearedSheet(const SideloadedSheet& sheet, Surface surface, const Surface& coarser)
    : side_(sheet.side), surface_(std::move(surface)) {
  set_values(surface_, coarser);
  minimise(sheet, surface_);
  const VectorXd samples = VectorXd::LinSpaced(33, 0, 1);
  for (const double u : samples)
    for (const double v : samples) error_ = base::larger(error_, (surface_(u, v) - coarser(u, v)).norm());
}

}  // namespace drape::reference
