#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "bench/studies/claims/claim.hpp"
#include "model/cloth.hpp"

/// Claims about panels that are no rectangles, from energies of homogeneous strains.
namespace drape::bench {
namespace {

using model::CurvePiece;

constexpr double poisson = 0.3;
constexpr double fairly_good = 0.1;  ///< error of a modulus

/// Energies of the strains ε11, ε22 and 2 ε12 of an isotropic sheet with k = 1 N/m, by area.
Eigen::Matrix3d isotropic() {
  Eigen::Matrix3d C;
  C << 1, poisson, 0, poisson, 1, 0, 0, 0, (1 - poisson) / 2;
  return C;
}

/// The same of a panel whose threads have these moduli, by differences of a strain e.
Eigen::Matrix3d stiffness_of(const model::Grid& grid, double area, double e) {
  model::Scene scene;
  scene.sheet.grid = grid;
  scene.sheet.material.tension = {1, 1};
  scene.sheet.material.contraction = poisson;
  scene.sheet.material.shear = (1 - poisson) / 2;
  const model::Cloth cloth = model::compile(scene);
  const auto energy = [&](const Eigen::Vector3d& strain) {
    solver::Vectors x = cloth.start.x;
    const Eigen::Matrix2d E{{strain[0], strain[2] / 2}, {strain[2] / 2, strain[1]}};
    x.leftCols<2>() += (cloth.start.x.leftCols<2>() * E).eval();
    return cloth.ode.potential_energy(0, x);
  };
  const Eigen::Matrix3d unit = e * Eigen::Matrix3d::Identity();
  Eigen::Matrix3d C;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      C(i, j) = (energy(unit.col(i) + unit.col(j)) - energy(unit.col(i) - unit.col(j)) - energy(unit.col(j) - unit.col(i)) +
                 energy(-unit.col(i) - unit.col(j))) /
                (4 * e * e * area);
  return C;
}

/// The largest relative error of the energy of any strain.
ClaimCase error_of(const std::string& where, const model::Grid& grid, double area) {
  const auto error = [&](double e) {
    const Eigen::Matrix3d C = stiffness_of(grid, area, e);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> ratios((C + C.transpose()) / 2, isotropic());
    return (ratios.eigenvalues().array() - 1).abs().maxCoeff();
  };
  constexpr double e = 1e-4;
  const double value = error(e);
  return {where, value, std::abs(value - error(2 * e)), -fairly_good, fairly_good};
}

/// Rhombi of unit sides whose angles are off by some degrees from right ones.
ClaimCase slanted(double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  model::Grid grid{5, 5, 1, 1};
  grid.outline = model::parallelogram({1, 0}, {std::sin(angle), std::cos(angle)});
  return error_of(fmt::format("{:g}° off right angles", degrees), grid, std::cos(angle));
}

ClaimCase graded() {
  model::Grid grid{9, 9, 1, 1};
  grid.grading_u = grid.grading_v = 3;
  return error_of("spacings that grow threefold", grid, 1);
}

/// A quarter of an annulus, along rays and circles.
ClaimCase curved() {
  constexpr double inner = 0.2, outer = 0.5;
  const auto quarter = [](double r) -> std::vector<CurvePiece> {
    const double c = r * std::numbers::sqrt2 / 2;
    return {{CurvePiece::Kind::arc, {{r, 0}, {c, c}, {0, r}}}};
  };
  const auto ray = [](double x, double y) -> std::vector<CurvePiece> {
    return {{CurvePiece::Kind::line, {{inner * x, inner * y}, {outer * x, outer * y}}}};
  };
  model::Grid grid{21, 21, outer, outer};
  grid.outline = {.lower = ray(1, 0), .upper = ray(0, 1), .left = quarter(inner), .right = quarter(outer)};
  return error_of("circles and rays, 20 × 20 faces", grid, std::numbers::pi / 4 * (outer * outer - inner * inner));
}

std::vector<ClaimCase> faces_close_to_rectangles_suffice() {
  return {graded(), curved(), slanted(1), slanted(2), slanted(5), slanted(10), slanted(20)};
}

constexpr Claim of_panels[] = {
    {"C-34", "Etzmuß 2002", "2.7", "faces close to rectangles approximate the physical properties fairly well",
     "largest error of an isotropic sheet's energy", "1", faces_close_to_rectangles_suffice},
};

}  // namespace

std::span<const Claim> panel_claims() { return of_panels; }

}  // namespace drape::bench
