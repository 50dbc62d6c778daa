// Forces against the continuum they stand for: on smooth surfaces, borders and corners included, the error is of second order.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "verify/support/model_fixtures.hpp"

namespace drape::verify::force_continuum_test {
namespace {

using namespace sheets;
using Eigen::Vector3d;
using model::WeftWarp;
using testing::Each;
using testing::Lt;
using testing::TestWithParam;
using testing::ValuesIn;

/// s(u, v) on the unit square, made of 1, u, sin πu times 1, v, sin πv. Its curvature across every border is zero there,
/// as a plate with free edges wants it; nothing else is special about it.
struct Surface {
  Vector3d c[3][3];

  /// ∂^(i + j) s/∂u^i ∂v^j
  Vector3d operator()(double u, double v, int i = 0, int j = 0) const {
    Vector3d s = Vector3d::Zero();
    for (int p = 0; p < 3; ++p)
      for (int q = 0; q < 3; ++q) s += basis(p, u, i) * basis(q, v, j) * c[p][q];
    return s;
  }

  Vectors at_nodes(const Grid& grid) const {
    Vectors x = grid.parameters();
    for (auto row : x.rowwise()) row = (*this)(row[0], row[1]).transpose().eval();
    return x;
  }

 private:
  static double basis(int k, double u, int order) {
    if (k == 2) return std::pow(std::numbers::pi, order) * std::sin(std::numbers::pi * (u + 0.5 * order));
    return k < order ? 0 : k == order ? 1 : u;
  }
};

const Surface position{{{{0, 0, 0}, {0.1, 0.95, -0.05}, {0.03, 0.02, 0.06}},
                        {{1.1, 0.05, 0.1}, {0.02, 0.03, 0.15}, {-0.02, 0.04, 0.05}},
                        {{0.04, -0.03, 0.08}, {0.03, 0.02, -0.06}, {0.05, -0.04, 0.1}}}};
const Surface velocity{{{{0.3, 0.2, 0.1}, {-0.2, 0.3, 0.4}, {0.1, -0.2, 0.3}},
                        {{0.5, -0.4, 0.2}, {0.3, 0.1, -0.3}, {0.2, 0.3, -0.1}},
                        {{-0.1, 0.2, 0.3}, {0.2, -0.3, 0.1}, {0.3, 0.2, -0.2}}}};

Vector3d unit(const Vector3d& a) { return a.normalized(); }

/// ∫ over the unit square by Simpson's rule, to about 1e-8.
template <class Integrand>
double integral(const Integrand& f) {
  constexpr int n = 64;
  const auto weight = [](int k) { return (k == 0 || k == n ? 1 : k % 2 ? 4 : 2) / (3.0 * n); };
  double sum = 0;
  for (int a = 0; a <= n; ++a)
    for (int b = 0; b <= n; ++b) sum += weight(a) * weight(b) * f(a / double(n), b / double(n));
  return sum;
}

/// Three grids of the unit square, each with half the spacings of the one before.
std::vector<Grid> refinements() { return {{9, 7, 1, 1}, {17, 13, 1, 1}, {33, 25, 1, 1}}; }

/// The orders at which errors fall when spacings are halved, measured between neighbouring refinements.
template <class Error>
std::vector<double> orders(const Error& error) {
  std::vector<double> found, errors;
  for (const Grid& grid : refinements()) errors.push_back(error(grid));
  for (std::size_t k = 1; k < errors.size(); ++k) found.push_back(std::log2(errors[k - 1] / errors[k]));
  return found;
}

testing::Matcher<double> about(double order) { return testing::DoubleNear(order, 0.15); }

// --- Energies and dissipation: half weights on borders and all -------------------------------------------------------------

/// Densities of energy and of dissipated power of one force, as section 2 of the thesis has them; s: surface, w: its velocity.
struct Densities {
  std::string force;
  double (*energy)(const Material&, const Surface& s, double u, double v);
  double (*dissipation)(const Material&, const Surface& s, const Surface& w, double u, double v);
};

double no_energy(const Material&, const Surface&, double, double) { return 0; }
double no_dissipation(const Material&, const Surface&, const Surface&, double, double) { return 0; }

/// Quadratic form of plates, ½ of which is the energy.
double plate_density(const WeftWarp& B, const Surface& s, double u, double v) {
  return B.weft * s(u, v, 2, 0).squaredNorm() + B.warp * s(u, v, 0, 2).squaredNorm() +
         (B.weft + B.warp) * s(u, v, 1, 1).squaredNorm();
}

std::array<double, 2> strains(const Surface& s, double u, double v) {
  return {s(u, v, 1, 0).norm() - 1, s(u, v, 0, 1).norm() - 1};
}

/// ν11, ν22 of (2.28).
std::array<double, 2> rates(const Surface& s, const Surface& w, double u, double v) {
  return {unit(s(u, v, 1, 0)).dot(w(u, v, 1, 0)), unit(s(u, v, 0, 1)).dot(w(u, v, 0, 1))};
}

std::vector<Densities> densities() {
  return {{"tension",
           [](const Material& m, const Surface& s, double u, double v) {
             const auto [e11, e22] = strains(s, u, v);
             return 0.5 * (m.tension.weft * e11 * e11 + m.tension.warp * e22 * e22);
           },
           no_dissipation},
          {"linear_damping", no_energy,
           [](const Material& m, const Surface&, const Surface& w, double u, double v) {
             return m.damping.weft * w(u, v, 1, 0).squaredNorm() + m.damping.warp * w(u, v, 0, 1).squaredNorm();
           }},
          {"projected_damping", no_energy,
           [](const Material& m, const Surface& s, const Surface& w, double u, double v) {
             const auto [n11, n22] = rates(s, w, u, v);
             return m.damping.weft * n11 * n11 + m.damping.warp * n22 * n22;
           }},
          {"shear",
           [](const Material& m, const Surface& s, double u, double v) {
             return 0.5 * m.shear * std::pow(s(u, v, 1, 0).dot(s(u, v, 0, 1)), 2);
           },
           [](const Material& m, const Surface& s, const Surface& w, double u, double v) {
             return m.shear_damping * std::pow(w(u, v, 1, 0).dot(s(u, v, 0, 1)) + s(u, v, 1, 0).dot(w(u, v, 0, 1)), 2);
           }},
          {"contraction",
           [](const Material& m, const Surface& s, double u, double v) {
             const auto [e11, e22] = strains(s, u, v);
             return m.contraction * e11 * e22;
           },
           [](const Material& m, const Surface& s, const Surface& w, double u, double v) {
             const auto [n11, n22] = rates(s, w, u, v);
             return 2 * m.contraction_damping * n11 * n22;
           }},
          {"unprojected_plate",
           [](const Material& m, const Surface& s, double u, double v) { return 0.5 * plate_density(m.bend, s, u, v); },
           [](const Material& m, const Surface&, const Surface& w, double u, double v) {
             return plate_density(m.bend_damping, w, u, v);
           }}};
}

class ContinuumOf : public TestWithParam<Densities> {
 protected:
  const Densities& density = GetParam();
  const ForceCase force = force_case(density.force);
};
INSTANTIATE_TEST_SUITE_P(, ContinuumOf, ValuesIn(densities()), [](const auto& test) { return test.param.force; });

TEST_P(ContinuumOf, EnergyOfASmoothSurfaceConvergesAtSecondOrder) {
  const double exact = integral([&](double u, double v) { return density.energy(force.material, position, u, v); });
  const auto error = [&](const Grid& grid) {
    return std::abs(ode_of(force, grid).potential_energy(0, position.at_nodes(grid)) - exact);
  };
  if (density.energy == no_energy)
    EXPECT_EQ(error(refinements()[0]), 0);
  else
    EXPECT_THAT(orders(error), Each(about(2)));
}

TEST_P(ContinuumOf, DissipatedPowerOfASmoothMotionConvergesAtSecondOrder) {
  const double exact =
      integral([&](double u, double v) { return density.dissipation(force.material, position, velocity, u, v); });
  const auto error = [&](const Grid& grid) {
    const SplitOde ode = ode_of(force, grid);
    const State y{position.at_nodes(grid), velocity.at_nodes(grid)};
    const Vectors viscous = evaluate(ode.force, y) - evaluate(ode.force, {y.x, at_rest(y.x)});
    return std::abs(-viscous.cwiseProduct(y.v).sum() - exact);
  };
  if (density.dissipation == no_dissipation)
    EXPECT_EQ(error(refinements()[0]), 0);
  else
    EXPECT_THAT(orders(error), Each(about(2)));
}

// --- Forces that have no energy, from node to node -------------------------------------------------------------------------

/// Greatest difference of force densities from those of the continuum at the nodes that are at least `margin` from the border.
template <class Density>
double worst(const std::string& name, const Grid& grid, const Density& density, double margin = 0.24) {
  const Vectors f = evaluate(ode_of(force_case(name), grid).force, {position.at_nodes(grid), at_rest(grid.parameters())});
  double error = 0;
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a) {
      const double u = a * grid.spacing_u(), v = b * grid.spacing_v();
      if (std::min({u, v, 1 - u, 1 - v}) < margin) continue;
      error =
          std::max(error, largest(f.row(grid.index(a, b)).transpose() / grid.cell_areas()[grid.index(a, b)] - density(u, v)));
    }
  return error;
}

Vector3d along_normal(const Vector3d& a, double u, double v) {
  const Vector3d N = unit(position(u, v, 1, 0).cross(position(u, v, 0, 1)));
  return N.dot(a) * N;
}

/// −(B1 s_uuuu + (B1 + B2) s_uuvv + B2 s_vvvv)   (2.26) with the sign that removes energy
Vector3d plate_force(double u, double v) {
  const auto [B1, B2] = force_case("plate").material.bend;
  return -(B1 * position(u, v, 4, 0) + (B1 + B2) * position(u, v, 2, 2) + B2 * position(u, v, 0, 4));
}

/// <N, B1 s_uu + B2 s_vv> N   (2.24)
Vector3d membrane_force(double u, double v) {
  const auto [B1, B2] = force_case("membrane").material.bend;
  return along_normal(B1 * position(u, v, 2, 0) + B2 * position(u, v, 0, 2), u, v);
}

/// σ12 = G <s_u, s_v>   (2.18)
double shear_stress(double u, double v) {
  return force_case("printed_shear").material.shear * position(u, v, 1, 0).dot(position(u, v, 0, 1));
}

/// ∂u(σ12 r_v) + ∂v(σ12 r_u)   (2.19), by differences with an error of 1e-10
Vector3d printed_shear_force(double u, double v) {
  const double h = 1e-3;
  const auto along_u = [&](double d) -> Vector3d { return shear_stress(u + d, v) * unit(position(u + d, v, 0, 1)); };
  const auto along_v = [&](double d) -> Vector3d { return shear_stress(u, v + d) * unit(position(u, v + d, 1, 0)); };
  const auto derivative = [&](const auto& f) -> Vector3d { return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h); };
  return derivative(along_u) + derivative(along_v);
}

TEST(Continuum, PlatesActLikeTheBilaplacianInsideAtSecondOrder) {
  EXPECT_THAT(orders([](const Grid& grid) { return worst("unprojected_plate", grid, plate_force); }), Each(about(2)));
}

TEST(Continuum, ProjectedPlatesActLikeTheBilaplacianAlongTheNormalInsideAtSecondOrder) {
  const auto projected = [](double u, double v) { return along_normal(plate_force(u, v), u, v); };
  EXPECT_THAT(orders([&](const Grid& grid) { return worst("plate", grid, projected); }), Each(about(2)));
}

TEST(Continuum, MembranesAreOfSecondOrderInsideAndOfFirstOrderOnBorders) {
  EXPECT_THAT(orders([](const Grid& grid) { return worst("membrane", grid, membrane_force); }), Each(about(2)));
  EXPECT_THAT(orders([](const Grid& grid) { return worst("membrane", grid, membrane_force, 0); }), Each(about(1)));
}

TEST(Continuum, PrintedShearIsOfSecondOrderInside) {
  EXPECT_THAT(orders([](const Grid& grid) { return worst("printed_shear", grid, printed_shear_force); }), Each(about(2)));
}

TEST(Continuum, PrintedShearIsNotConsistentOnBorders) {
  // Virtual work of a smooth field φ: Σ f φ must tend to −∫ σ12 (<r_v, φ_u> + <r_u, φ_v>).
  const Surface& phi = velocity;
  const double exact = -integral([&](double u, double v) {
    return shear_stress(u, v) *
           (unit(position(u, v, 0, 1)).dot(phi(u, v, 1, 0)) + unit(position(u, v, 1, 0)).dot(phi(u, v, 0, 1)));
  });
  const auto error = [&](const Grid& grid) {
    const State y{position.at_nodes(grid), at_rest(grid.parameters())};
    const Vectors f = evaluate(ode_of(force_case("printed_shear"), grid).force, y);
    return std::abs(f.cwiseProduct(phi.at_nodes(grid)).sum() - exact);
  };
  EXPECT_THAT(orders(error), Each(Lt(0.1)));
}

}  // namespace
}  // namespace drape::verify::force_continuum_test
