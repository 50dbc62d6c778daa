#include "reference/exact/manufactured.hpp"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/AutoDiff>

namespace drape::reference {
namespace {

template <class Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
using Eigen::Vector3d;

/// A number with its derivative in one direction.
using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;

/// s_u, s_v and their rates.
template <class Scalar>
struct Gradients {
  Vector3<Scalar> s_u, s_v, w_u, w_v;
};

template <class Scalar>
struct StressOf {
  Vector3<Scalar> p_u, p_v;
};

/// The one place where the stress is written.
template <class Scalar>
StressOf<Scalar> stress_of(const ContinuumMaterial& m, const Gradients<Scalar>& g) {
  using std::sqrt;
  const auto& [s_u, s_v, w_u, w_v] = g;
  const Scalar length_u = sqrt(s_u.dot(s_u)), length_v = sqrt(s_v.dot(s_v));
  const Vector3<Scalar> r_u = s_u / length_u, r_v = s_v / length_v;
  const Scalar e11 = length_u - 1., e22 = length_v - 1., n11 = r_u.dot(w_u), n22 = r_v.dot(w_v);
  const Scalar s11 = m.tension.u * e11 + m.projected_damping.u * n11 + m.contraction * e22 + m.contraction_damping * n22;
  const Scalar s22 = m.tension.v * e22 + m.projected_damping.v * n22 + m.contraction * e11 + m.contraction_damping * n11;
  const Scalar s12 = m.shear * s_u.dot(s_v) + m.shear_damping * (w_u.dot(s_v) + s_u.dot(w_v));
  return {s11 * r_u + s12 * s_v + Scalar(m.linear_damping.u) * w_u, s22 * r_v + s12 * s_u + Scalar(m.linear_damping.v) * w_v};
}

/// A vector with its derivative.
Vector3<Dual> dual(const Vector3d& value, const Vector3d& derivative) {
  Vector3<Dual> a;
  for (int c = 0; c < 3; ++c) a[c] = Dual(value[c], Eigen::Matrix<double, 1, 1>(derivative[c]));
  return a;
}

/// Gradients with their derivatives along u (i = 1, j = 0) or v (i = 0, j = 1).
Gradients<Dual> gradients_along(const MovingJet& jet, int i, int j) {
  const auto& [s, w, acceleration] = jet;
  return {dual(s(1, 0), s(1 + i, j)), dual(s(0, 1), s(i, 1 + j)), dual(w(1, 0), w(1 + i, j)), dual(w(0, 1), w(i, 1 + j))};
}

Vector3d derivative(const Vector3<Dual>& a) { return {a[0].derivatives()[0], a[1].derivatives()[0], a[2].derivatives()[0]}; }

Vector3d divergence(const ContinuumMaterial& m, const MovingJet& jet) {
  return derivative(stress_of(m, gradients_along(jet, 1, 0)).p_u) + derivative(stress_of(m, gradients_along(jet, 0, 1)).p_v);
}

/// The linear operators of bending on a field, before the projection.
Vector3d bending_of(Bending bending, const Directional& B, const Jet& s) {
  if (bending == Bending::membrane) return B.u * s(2, 0) + B.v * s(0, 2);
  return -(B.u * s(4, 0) + (B.u + B.v) * s(2, 2) + B.v * s(0, 4));
}

Vector3d bending_force(const ContinuumMaterial& m, const MovingJet& jet) {
  Vector3d f = bending_of(m.bending, m.bend, jet.s) + bending_of(m.bending, m.bend_damping, jet.rate);
  if (m.bending == Bending::plate) return f;
  const Vector3d N = jet.s(1, 0).cross(jet.s(0, 1)).normalized();
  return N.dot(f) * N;
}

/// What the variation of ½ ∫ B1 |s_uu|² + (B1 + B2) |s_uv|² + B2 |s_vv|² leaves on borders and corners.
Vector3d plate_load(const Directional& B, const Jet& s, const DualCell& c) {
  const double twist = B.u + B.v;
  return -c.side_u * c.width_v * (B.u * s(3, 0) + twist * s(1, 2)) - c.side_v * c.width_u * (B.v * s(0, 3) + twist * s(2, 1)) +
         c.side_u * c.side_v * twist * s(1, 1);
}

}  // namespace

double Function::operator()(double x, int n) const {
  double sum = 0;
  if (amplitude != 0) sum = amplitude * std::pow(frequency, n) * std::sin(frequency * x + phase + n * std::numbers::pi / 2);
  double power = 1;
  for (int k = n; k < static_cast<int>(coefficients.size()); ++k, power *= x) {
    double factor = coefficients[k];
    for (int m = 0; m < n; ++m) factor *= k - m;
    sum += factor * power;
  }
  return sum;
}

SurfacePoint::SurfacePoint(const Surface& surface, double u, double v) {
  for (const SurfaceMode& mode : surface) {
    Jet& jet = jets_.emplace_back();
    for (const Product& p : mode.products) {
      const std::array of_v{p.v(v), p.v(v, 1), p.v(v, 2), p.v(v, 3), p.v(v, 4)};
      for (int i = 0; i <= 4; ++i) {
        const Vector3d along_u = p.u(u, i) * p.a;
        for (int j = 0; i + j <= 4; ++j) jet.derivatives.col(Jet::index(i, j)) += of_v[j] * along_u;
      }
    }
    times_.push_back(mode.time);
  }
}

MovingJet SurfacePoint::at(double t) const {
  MovingJet sum{{}, {}, Vector3d::Zero()};
  for (std::size_t k = 0; k < jets_.size(); ++k) {
    sum.s.derivatives += times_[k](t) * jets_[k].derivatives;
    sum.rate.derivatives += times_[k](t, 1) * jets_[k].derivatives;
    sum.acceleration += times_[k](t, 2) * jets_[k](0, 0);
  }
  return sum;
}

Stress stress(const ContinuumMaterial& material, const MovingJet& jet) {
  const auto [p_u, p_v] = stress_of<double>(material, {jet.s(1, 0), jet.s(0, 1), jet.rate(1, 0), jet.rate(0, 1)});
  return {p_u, p_v};
}

Vector3d body_force(const ContinuumMaterial& material, const MovingJet& jet) {
  return material.density * jet.acceleration - divergence(material, jet) - bending_force(material, jet);
}

NodeLoad node_load(const ContinuumMaterial& material, const MovingJet& jet, const DualCell& cell) {
  const auto [p_u, p_v] = stress(material, jet);
  NodeLoad load{cell.width_u * cell.width_v * body_force(material, jet) + cell.side_u * cell.width_v * p_u +
                    cell.side_v * cell.width_u * p_v,
                Vector3d::Zero()};
  if (material.bending != Bending::membrane)
    load.bending = plate_load(material.bend, jet.s, cell) + plate_load(material.bend_damping, jet.rate, cell);
  return load;
}

}  // namespace drape::reference
