// Small motions of a sheet in its plane are those of an orthotropic elastic continuum.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::verify::in_plane_modes_test {
namespace {

using solver::Vectors;

constexpr double k1 = 120, k2 = 60, G = 25, C12 = 30, density = 0.7;
constexpr double size_u = 0.6, size_v = 0.9;

model::Cloth sheet(int n) {
  return model::compile(
      model::parse_scene(fmt::format("name = 'plane'\ngrid = {{ n = [{}, {}], size = [{}, {}] }}\n"
                                     "material = {{ tension = [{}, {}], shear = {}, contraction = {}, density = {} }}\n",
                                     n, 3 * (n - 1) / 2 + 1, size_u, size_v, k1, k2, G, C12, density),
                         "test"));
}

/// Squares of the frequencies of m half waves along u and n along v: of the motions (cos βv sin αu, 0) and (0, cos αu sin βv),
/// of which the sheet makes two modes, between borders on which it slides.
Eigen::Vector2d continuum(int m, int n) {
  const double a = m * M_PI / size_u, b = n * M_PI / size_v;
  Eigen::Matrix2d A;
  A << k1 * a * a + G * b * b, (G + C12) * a * b, (G + C12) * a * b, k2 * b * b + G * a * a;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(A / density).eigenvalues();
}

/// The same by the Jacobian of the particles' forces, and how far the forces are from such motions, over their size.
struct Discrete {
  Eigen::Vector2d squares;
  double residual;
};

Discrete discrete(const model::Cloth& cloth, int m, int n) {
  const Vectors& x = cloth.start.x;
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(x.size(), 2);
  Eigen::VectorXd free = Eigen::VectorXd::Zero(x.size());
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double u = m * M_PI * x(i, 0) / size_u, v = n * M_PI * x(i, 1) / size_v;
    shapes(3 * i, 0) = std::sin(u) * std::cos(v);
    shapes(3 * i + 1, 1) = std::cos(u) * std::sin(v);
    free[3 * i] = x(i, 0) > 1e-9 && x(i, 0) < size_u - 1e-9;
    free[3 * i + 1] = x(i, 1) > 1e-9 && x(i, 1) < size_v - 1e-9;
  }
  solver::SparseMatrix by_x, by_v;
  cloth.ode.jacobian(0, x, cloth.start.v, by_x, by_v);
  const Eigen::VectorXd mass = solver::thrice(cloth.ode.mass);
  const Eigen::MatrixXd accelerations = -(mass.cwiseInverse().cwiseProduct(free).asDiagonal() * (by_x * shapes));
  const Eigen::Matrix2d reduced =
      (shapes.transpose() * mass.asDiagonal() * shapes).inverse() * (shapes.transpose() * mass.asDiagonal() * accelerations);
  return {Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>((reduced + reduced.transpose()) / 2).eigenvalues(),
          (accelerations - shapes * reduced).norm() / accelerations.norm()};
}

TEST(InPlaneModes, ConvergeToOrthotropicElasticity) {
  for (const auto& [m, n] : {std::pair{1, 1}, {2, 1}, {1, 2}}) {
    std::vector<Eigen::Vector2d> errors;
    for (const int size : {9, 17, 33}) {
      const Discrete found = discrete(sheet(size), m, n);
      EXPECT_LE(found.residual, 1e-10) << m << " " << n << ": these are also modes of the particles";
      errors.emplace_back((found.squares - continuum(m, n)).cwiseAbs().cwiseQuotient(continuum(m, n)));
    }
    for (int mode = 0; mode < 2; ++mode) {
      for (int k = 0; k < 2; ++k)
        EXPECT_NEAR(std::log2(errors[k][mode] / errors[k + 1][mode]), 2, 0.1) << m << " " << n << ", mode " << mode;
      EXPECT_LE(errors[2][mode], 0.01);
    }
  }
}

}  // namespace
}  // namespace drape::verify::in_plane_modes_test
