// Shear of the models that the thesis surveys: their energies as their sources have them, and the moduli they come to.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "verify/support/model_fixtures.hpp"

namespace drape::verify::survey_shear_test {
namespace {

using namespace sheets;

constexpr double G = 1.5;  ///< that of the force cases [N/m]

Eigen::Vector3d between(const Vectors& x, int i, int j) { return x.row(j) - x.row(i); }

double spring(const Grid& grid, const Vectors& x, int i, int j) {
  const double change = between(x, i, j).norm() - between(grid.parameters(), i, j).norm();
  return change * change / 2;
}

/// ½ (φ − π/2)² of the angle at particle i.
double hinge(const Vectors& x, int i, int j, int k) {
  const double c = between(x, i, j).normalized().dot(between(x, i, k).normalized());
  const double change = std::acos(c) - std::numbers::pi / 2;
  return change * change / 2;
}

/// ½ A² <w_u, w_v>² of the triangle whose right angle is at i.
double triangle(const Grid& grid, const Vectors& x, int i, int j, int k) {
  const double area = grid.spacing_u() * grid.spacing_v() / 2;
  const double shear = between(x, i, j).dot(between(x, i, k)) / (2 * area);
  return area * area * shear * shear / 2;
}

/// The sum over the cells (a, b) with the corners 00, 10, 01, 11.
template <class OfCell>
double sum(const Grid& grid, const OfCell& of_cell) {
  double energy = 0;
  for (int b = 0; b + 1 < grid.nv; ++b)
    for (int a = 0; a + 1 < grid.nu; ++a)
      energy += of_cell(grid.index(a, b), grid.index(a + 1, b), grid.index(a, b + 1), grid.index(a + 1, b + 1));
  return energy;
}

double energy_of(const char* force, const Grid& grid, const Vectors& x) {
  return ode_of(force_case(force), grid).potential_energy(0, x);
}

TEST(SurveyShear, HasTheEnergiesOfItsSources) {
  const Grid grid = five_by_four();
  const double area = grid.spacing_u() * grid.spacing_v();
  const double diagonal = std::pow(grid.spacing_u(), 2) + std::pow(grid.spacing_v(), 2);
  for (const unsigned seed : {1U, 2U}) {
    const Vectors x = deformed(grid, seed).x;
    const double both = sum(grid, [&](int i, int j, int k, int l) { return spring(grid, x, i, l) + spring(grid, x, j, k); });
    const double one = sum(grid, [&](int, int j, int k, int) { return spring(grid, x, j, k); });
    const double angles = sum(grid, [&](int i, int j, int k, int l) {
      return hinge(x, i, j, k) + hinge(x, j, i, l) + hinge(x, k, i, l) + hinge(x, l, j, k);
    });
    const double triangles =
        sum(grid, [&](int i, int j, int k, int l) { return triangle(grid, x, i, j, k) + triangle(grid, x, l, j, k); });
    EXPECT_NEAR(energy_of("diagonals", grid, x), G * diagonal / (2 * area) * both, 1e-12 * both);
    EXPECT_NEAR(energy_of("triangles", grid, x), G * diagonal / area * one, 1e-12 * one);
    EXPECT_NEAR(energy_of("hinges", grid, x), G * area / 4 * angles, 1e-12 * angles);
    EXPECT_NEAR(energy_of("baraff_witkin", grid, x), 2 * G / area * triangles, 1e-12 * triangles);
  }
}

/// ∂²W/∂ε∂ε' of two homogeneous strains of a flat sheet, by area, by differences.
double modulus(const char* force, const Grid& grid, const Eigen::Matrix2d& first, const Eigen::Matrix2d& second) {
  constexpr double e = 1e-4;
  const Vectors flat = grid.parameters();
  const auto energy = [&](double s, double t) {
    const Eigen::Matrix2d F = Eigen::Matrix2d::Identity() + s * e * first + t * e * second;
    Vectors x = flat;
    x.leftCols<2>() = flat.leftCols<2>() * F.transpose();
    return energy_of(force, grid, x);
  };
  return (energy(1, 1) - energy(1, -1) - energy(-1, 1) + energy(-1, -1)) / (4 * e * e * grid.size_u * grid.size_v);
}

/// Shear is half of 2 ε12 = γ on each side, so that no edge turns against the others.
TEST(SurveyShear, HasTheModulusOfShearOnAllMeshes) {
  const Eigen::Matrix2d weft{{1, 0}, {0, 0}}, warp{{0, 0}, {0, 1}}, shear{{0, 0.5}, {0.5, 0}};
  for (const Grid& grid : {Grid{4, 5, 1, 0.6}, Grid{7, 9, 1, 0.6}}) {
    const double aspect = grid.spacing_u() / grid.spacing_v();
    for (const char* force : {"shear", "diagonals", "triangles", "hinges", "baraff_witkin"}) {
      EXPECT_NEAR(modulus(force, grid, shear, shear), G, 1e-6) << force;
      const bool springs = std::string(force) == "diagonals" || std::string(force) == "triangles";
      EXPECT_NEAR(modulus(force, grid, weft, warp), springs ? G : 0, 1e-6) << force << ": C12 = G of springs";
      EXPECT_NEAR(modulus(force, grid, weft, weft), springs ? G * aspect * aspect : 0, 1e-6) << force;
      EXPECT_NEAR(std::abs(modulus(force, grid, weft, shear)), std::string(force) == "triangles" ? G * aspect : 0, 1e-6)
          << force;
    }
  }
}

}  // namespace
}  // namespace drape::verify::survey_shear_test
