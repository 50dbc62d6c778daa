#include "verify/support/known_motions.hpp"

#include <cmath>
#include <numbers>
#include <tuple>

namespace drape::verify::known_motions {

SparseMatrix threefold(const SparseMatrix& scalar) {
  SparseMatrix result(3 * scalar.rows(), 3 * scalar.cols());
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < scalar.rows(); ++i)
    for (SparseMatrix::InnerIterator a(scalar, i); a; ++a)
      for (int c = 0; c < 3; ++c) entries.emplace_back(3 * i + c, 3 * a.col() + c, a.value());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

SplitOde linear_ode(const Eigen::VectorXd& mass, const SparseMatrix& K, const SparseMatrix& D) {
  SplitOde ode;
  ode.mass = mass;
  ode.stiffness = K;
  ode.damping = D;
  ode.explicit_force = [](double, const Vectors& x, const Vectors&, Vectors& f) { f = 0 * x; };
  ode.force = [K, D](double, const Vectors& x, const Vectors& v, Vectors& f) { f = K * x + D * v; };
  ode.jacobian = [K = threefold(K), D = threefold(D)](double, const Vectors&, const Vectors&, SparseMatrix& df_dx,
                                                      SparseMatrix& df_dv) { df_dx = K, df_dv = D; };
  return ode;
}

SparseMatrix row_of_springs(int particles, double k) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i + 1 < particles; ++i)
    for (const auto& [row, col, sign] : {std::tuple(i, i, -1), {i, i + 1, 1}, {i + 1, i, 1}, {i + 1, i + 1, -1}})
      entries.emplace_back(row, col, sign * k);
  SparseMatrix K(particles, particles);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

State single(const Eigen::RowVector3d& x, const Eigen::RowVector3d& v) { return {Vectors(x), Vectors(v)}; }

Problem damped_oscillator() {
  const double m = 0.5, k = 20, d = 1, c = d / (2 * m), w = std::sqrt(k / m - c * c);
  const SparseMatrix one = Eigen::MatrixXd::Ones(1, 1).sparseView();
  const Eigen::RowVector3d a(0.4, -0.8, 0.1);
  return {"damped_oscillator", linear_ode(Eigen::VectorXd::Constant(1, m), -k * one, -d * one), single(a, a * 0),
          [=](double t) {
            const double decay = std::exp(-c * t), wave = std::sin(w * t);
            return single(a * decay * (std::cos(w * t) + c / w * wave), -a * decay * (w + c * c / w) * wave);
          }};
}

Problem whirling_spring() {
  const double m = 0.2, k = 50, l = 0.6, r = 1, w = std::sqrt(k * (r - l) / (m * r));
  SplitOde ode;
  ode.mass = Eigen::VectorXd::Constant(1, m);
  ode.force = [=](double, const Vectors& x, const Vectors&, Vectors& f) { f = -k * (1 - l / x.norm()) * x; };
  ode.jacobian = [=](double, const Vectors& x, const Vectors&, SparseMatrix& df_dx, SparseMatrix& df_dv) {
    const Eigen::RowVector3d e = x.row(0).normalized();
    const Eigen::Matrix3d along = e.transpose() * e, across = Eigen::Matrix3d::Identity() - along;
    df_dx = (-k * (along + (1 - l / x.norm()) * across)).sparseView();
    df_dv.resize(3, 3);
  };
  const auto exact = [=](double t) {
    const double c = std::cos(w * t), s = std::sin(w * t);
    return single({r * c, 0.6 * r * s, 0.8 * r * s}, {-r * w * s, 0.6 * r * w * c, 0.8 * r * w * c});
  };
  return {"whirling_spring", ode, exact(0), exact};
}

Problem chain() {
  const int N = 12;
  const double m = 0.01, k = 30;
  SplitOde ode = linear_ode(Eigen::VectorXd::Constant(N, m), row_of_springs(N, k), SparseMatrix(N, N));
  ode.pins = {Pin{.particle = 0}, Pin{.particle = N - 1}};
  const auto exact = [=](double t) {
    State s{Vectors::Zero(N, 3), Vectors::Zero(N, 3)};
    for (const auto& [p, coordinate, amplitude] : {std::tuple(1, 2, 0.3), {7, 0, 0.02}}) {
      const double angle = p * std::numbers::pi / (N - 1), w = 2 * std::sqrt(k / m) * std::sin(angle / 2);
      for (int i = 0; i < N; ++i) {
        s.x(i, coordinate) += amplitude * std::sin(angle * i) * std::cos(w * t);
        s.v(i, coordinate) -= amplitude * std::sin(angle * i) * w * std::sin(w * t);
      }
    }
    return s;
  };
  return {"chain", ode, exact(0), exact};
}

Problem towed_particle() {
  const double m = 0.1, k = 15, u = 0.5, w = -0.25, f = std::sqrt(k / m);
  SplitOde ode = linear_ode(Eigen::VectorXd::Constant(2, m), row_of_springs(2, k), SparseMatrix(2, 2));
  ode.pins = {Pin{.particle = 1, .velocity = {u, 0, 0}},
              Pin{.particle = 0, .held = solver::axes(false, true, true), .velocity = {99, 0, w}}};
  const auto exact = [=](double t) {
    State s{Vectors::Zero(2, 3), Vectors::Zero(2, 3)};
    s.x.row(0) << u * t - u / f * std::sin(f * t), 0.2, w * t;
    s.v.row(0) << u - u * std::cos(f * t), 0, w;
    s.x.row(1) << u * t, 0.3, 0.4;
    s.v.row(1) << u, 0, 0;
    s.x(0, 2) += 0.1;
    return s;
  };
  State start = exact(0);
  start.v.row(1).setConstant(7);  // prescribed velocities replace what the start says
  return {"towed_particle", ode, start, exact};
}

}  // namespace drape::verify::known_motions
