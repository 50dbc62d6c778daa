#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "bench/studies/claims/claim.hpp"
#include "bench/studies/claims/sheet_runs.hpp"
#include "model/cloth.hpp"
#include "reference/exact/tension.hpp"
#include "reference/sundials/kinsol.hpp"

/// Claims about the forces of a sheet, from a single evaluation.
namespace drape::bench {
namespace {

constexpr double curvature = 0.1;  ///< [1/m], small on a sheet of 0.8 m
constexpr double round_off_of_forces = 1e-9;

/// Root of the sum of squares of the bending forces on a sheet with B = 1 that was moved out of its plane.
double bending_forces(const std::vector<model::Override>& form,
                      const std::function<Eigen::RowVector3d(double u, double v)>& displacement) {
  std::vector<model::Override> overrides{{"material.tension", "0"},
                                         {"material.damping", "0"},
                                         {"material.shear", "0"},
                                         {"material.bend", "1"},
                                         {"forces.gravity", "[0, 0, 0]"}};
  overrides.insert(overrides.end(), form.begin(), form.end());
  const model::Cloth cloth = model::compile(with("hung-edge", overrides));
  solver::Vectors x = cloth.start.x, f = x;
  for (Eigen::Index i = 0; i < x.rows(); ++i) x.row(i) += displacement(cloth.start.x(i, 0), cloth.start.x(i, 1));
  cloth.ode.force(0, x, cloth.start.v, f);
  return f.norm();
}

Eigen::RowVector3d cylinder(double u, double /*v*/) { return {0, 0, curvature * u * u / 2}; }
Eigen::RowVector3d slanted_cylinder(double u, double v) { return {0, 0, curvature * (u + v) * (u + v) / 4}; }
Eigen::RowVector3d saddle(double u, double v) { return {0, 0, curvature * u * v}; }
Eigen::RowVector3d bent_in_its_plane(double u, double /*v*/) { return {0, curvature * u * u / 2, 0}; }

/// Bending with the same largest curvature: along u, and with e, f and g of the second fundamental form, e g = f² and e = g =
/// 0.
std::vector<ClaimCase> no_twist_is_needed() {
  constexpr double noticeable = 0.1;
  const std::vector<model::Override> membrane{{"material.bend_form", "membrane"}};
  const double along_u = bending_forces(membrane, cylinder);
  return {
      {"slanted cylinder", bending_forces(membrane, slanted_cylinder) / along_u, round_off_of_forces, noticeable, unbounded},
      {"saddle z = κuv", bending_forces(membrane, saddle) / along_u, round_off_of_forces, noticeable, unbounded}};
}

/// A sheet that is sheared so that its lines along u are curved in its plane, over the same curvature out of it.
std::vector<ClaimCase> normal_curvature_leaves_shear_alone() {
  constexpr double noticeable = 0.1;
  const std::vector<model::Override> whole{{"material.bend_projected", "false"}};
  const double out_of_plane = bending_forces(whole, cylinder);
  return {
      {"whole curvature", bending_forces(whole, bent_in_its_plane) / out_of_plane, round_off_of_forces, noticeable, unbounded},
      {"normal curvature", bending_forces({}, bent_in_its_plane) / out_of_plane, round_off_of_forces, -2 * round_off_of_forces,
       2 * round_off_of_forces}};
}

// --- Algorithms 3 and 5 as they are printed, beside the forces that this program has in their place -----------------------

constexpr double side = 1;  ///< [m]
constexpr double amplitude = 0.2;

/// A flat sheet, n × n, of a material that has no forces except those in `material`.
model::Cloth sheet_of(int n, const std::vector<model::Override>& material) {
  std::vector<model::Override> overrides{{"grid.n", fmt::format("{}", n)}, {"grid.size", fmt::format("{}", side)},
                                         {"material.tension", "0"},        {"material.damping", "0"},
                                         {"material.shear", "0"},          {"material.density", "1"},
                                         {"forces.gravity", "[0, 0, 0]"}};
  overrides.insert(overrides.end(), material.begin(), material.end());
  model::Scene scene = with("hung-edge", overrides);
  scene.pins.clear();
  return model::compile(scene);
}

/// Forces per area at the particles of a square sheet, row by row.
using Densities = std::function<solver::Vectors(int n, const solver::Vectors& x)>;

Densities of_program(std::vector<model::Override> material) {
  return [material = std::move(material)](int n, const solver::Vectors& x) {
    const model::Cloth cloth = sheet_of(n, material);
    solver::Vectors f = x;
    cloth.ode.force(0, x, solver::Vectors::Zero(x.rows(), 3), f);
    return solver::Vectors(cloth.ode.mass.cwiseInverse().asDiagonal() * f);
  };
}

/// Algorithm 3 with B = 1, before its projection: Σ_edges (x_j − x_i)/l²; 6.2.1 leaves out edges across a border on it.
Densities algorithm_3(bool is_border) {
  return [is_border](int n, const solver::Vectors& x) {
    const double l = side / (n - 1);
    solver::Vectors R = solver::Vectors::Zero(x.rows(), 3);
    for (int b = 0; b < n; ++b)
      for (int a = 0; a < n; ++a)
        for (const auto& [da, db] : {std::pair(-1, 0), std::pair(1, 0), std::pair(0, -1), std::pair(0, 1)}) {
          const int c = a + da, d = b + db;
          if (c < 0 || c >= n || d < 0 || d >= n) continue;
          const int across = da != 0 ? a : b;
          if (is_border && (across == 0 || across == n - 1)) continue;
          R.row(a + n * b) += (x.row(c + n * d) - x.row(a + n * b)) / (l * l);
        }
    return R;
  };
}

/// Algorithm 5 with C12 = 1; the divergence divides by l once more.
solver::Vectors algorithm_5(int n, const solver::Vectors& x) {
  const double l = side / (n - 1);
  solver::Vectors F = solver::Vectors::Zero(x.rows(), 3);
  for (int b = 0; b < n; ++b)
    for (int a = 0; a < n; ++a) {
      const int i = a + n * b, j = (a > 0 ? a - 1 : a + 1) + n * b, k = a + n * (b > 0 ? b - 1 : b + 1);
      const Eigen::RowVector3d u = x.row(j) - x.row(i), v = x.row(k) - x.row(i);
      const Eigen::RowVector3d f_u = (v.norm() / l - 1) / l * u.normalized(), f_v = (u.norm() / l - 1) / l * v.normalized();
      F.row(i) += f_u + f_v;
      F.row(j) -= f_u;
      F.row(k) -= f_v;
    }
  return F;
}

/// A motion with the force per area that belongs to it.
struct Deformed {
  Eigen::RowVector3d (*position)(double u, double v);
  Eigen::RowVector3d (*density)(double u, double v);
};

/// z = α sin(2u + ½), curved on its borders too.
constexpr Deformed wave{
    [](double u, double v) { return Eigen::RowVector3d(u, v, amplitude * std::sin(2 * u + 0.5)); },
    [](double u, double /*v*/) { return Eigen::RowVector3d(0, 0, -4 * amplitude * std::sin(2 * u + 0.5)); }};

/// y = v (1 + α u²): ε22 = α u², ε11 = r − 1 with r = |s_u| = √(1 + (2 α u v)²).
constexpr Deformed fan{[](double u, double v) { return Eigen::RowVector3d(u, v * (1 + amplitude * u * u), 0); },
                       [](double u, double v) {
                         const double w = 2 * amplitude * u * v, r = std::sqrt(1 + w * w);
                         const double r_u = 2 * amplitude * v * w / r, r_v = 2 * amplitude * u * w / r;
                         const Eigen::RowVector3d t(1 / r, w / r, 0);
                         const Eigen::RowVector3d t_u(-r_u / (r * r), 2 * amplitude * v / r - w * r_u / (r * r), 0);
                         const Eigen::RowVector3d along_u = 2 * amplitude * u * t + amplitude * u * u * t_u;
                         return Eigen::RowVector3d(along_u + Eigen::RowVector3d(0, r_v, 0));
                       }};

enum class Place { inside, on_border };

/// Order of the largest error of a force per area, from `coarse` intervals a side to twice as many. Inside is further from a
/// border than a quarter of the side; on the borders the corners are left out.
double order_of_force(const Deformed& deformed, const Densities& densities, Place place, int coarse) {
  const auto error = [&](int intervals) {
    const int n = intervals + 1;
    solver::Vectors x(n * n, 3);
    const auto coordinate = [&](int a) { return side * a / intervals; };
    for (int b = 0; b < n; ++b)
      for (int a = 0; a < n; ++a) x.row(a + n * b) = deformed.position(coordinate(a), coordinate(b));
    const solver::Vectors f = densities(n, x);
    double largest = 0;
    for (int b = intervals / 4; b <= intervals - intervals / 4; ++b) {
      const int begin = place == Place::inside ? intervals / 4 : 0, end = intervals - begin;
      for (int a = begin; a <= end; a += place == Place::inside ? 1 : intervals)
        largest = std::max(largest, (f.row(a + n * b) - deformed.density(coordinate(a), coordinate(b))).norm());
    }
    return largest;
  };
  return std::log2(error(coarse) / error(2 * coarse));
}

/// A case with the orders of two refinements: their middle, and half their distance.
ClaimCase order_case(const char* where, const Deformed& deformed, const Densities& densities, Place place, double lower) {
  const double before = order_of_force(deformed, densities, place, 32), after = order_of_force(deformed, densities, place, 64);
  return {where, (before + after) / 2, std::abs(before - after) / 2, lower, unbounded};
}

/// The same wave with the force along the normal only, g'' (−g', 0, 1)/(1 + g'²).
constexpr Deformed wave_along_normal{wave.position, [](double u, double v) {
                                       const double slope = 2 * amplitude * std::cos(2 * u + 0.5);
                                       const double normal = wave.density(u, v)[2] / (1 + slope * slope);
                                       return Eigen::RowVector3d(-slope * normal, 0, normal);
                                     }};

std::vector<ClaimCase> algorithm_3_is_consistent() {
  const Densities ours = of_program({{"material.bend", "1"}, {"material.bend_form", "membrane"}});
  const double consistent = 0.9;
  return {order_case("inside", wave, algorithm_3(false), Place::inside, consistent),
          order_case("borders, as printed", wave, algorithm_3(false), Place::on_border, consistent),
          order_case("borders, is_border", wave, algorithm_3(true), Place::on_border, consistent),
          order_case("borders, as here", wave_along_normal, ours, Place::on_border, consistent)};
}

std::vector<ClaimCase> algorithm_5_is_of_second_order() {
  const double second = 1.9;
  const Densities tension = of_program({{"material.tension", "2"}});  // more than C12, or the material would gain energy
  const Densities with_contraction = of_program({{"material.tension", "2"}, {"material.contraction", "1"}});
  const auto contraction = [&](int n, const solver::Vectors& x) {
    return solver::Vectors(with_contraction(n, x) - tension(n, x));
  };
  return {order_case("as printed", fan, algorithm_5, Place::inside, second),
          order_case("in cells, as here", fan, contraction, Place::inside, second)};
}

// --- The models of the survey, and an objective continuum ------------------------------------------------------------------

/// Energy of a homogeneous strain of a flat sheet without tension.
double strained_energy(const model::Cloth& cloth, const Eigen::Matrix2d& strain) {
  solver::Vectors x = cloth.start.x;
  x.leftCols<2>() += (cloth.start.x.leftCols<2>() * strain.transpose()).eval();
  return cloth.ode.potential_energy(0, x);
}

/// C12 over G of a form of shear.
ClaimCase contraction_of(const char* form) {
  constexpr double e = 1e-4, equal = 0.01;
  const auto measured = [&](int n) {
    const model::Cloth cloth = sheet_of(n, {{"material.shear", "1"}, {"material.shear_form", form}});
    const auto energy = [&](double weft, double warp, double shear) {
      return strained_energy(cloth, e * Eigen::Matrix2d{{weft, shear / 2}, {shear / 2, warp}});
    };
    const double C12 = (energy(1, 1, 0) - energy(1, -1, 0) - energy(-1, 1, 0) + energy(-1, -1, 0)) / 4;
    return C12 / (energy(0, 0, 1) + energy(0, 0, -1));
  };
  const double value = measured(20);
  return {form, value, std::abs(value - measured(10)) + 1e-6, 1 - equal, 1 + equal};
}

std::vector<ClaimCase> springs_contract() {
  return {contraction_of("diagonals"), contraction_of("triangles"), contraction_of("conservative")};
}

/// How the shear modulus of a form grows with the spacing if the constant of its source stays: l to the power of this. The
/// constant over the modulus is that of forces/survey_shear.cpp, square cells.
ClaimCase growth_with_spacing(const char* form, double (*constant_by_modulus)(double l)) {
  const auto modulus = [&](int n) {
    const double l = side / (n - 1);
    const std::string G = fmt::format("{:.17g}", 1 / constant_by_modulus(l));
    const model::Cloth cloth = sheet_of(n, {{"material.shear", G}, {"material.shear_form", form}});
    constexpr double e = 1e-4;
    return 2 * strained_energy(cloth, e * Eigen::Matrix2d{{0, 0.5}, {0.5, 0}}) / (e * e * side * side);
  };
  const double coarse = modulus(11), middle = modulus(21), fine = modulus(41);
  return {form, std::log2(coarse / middle), std::abs(std::log2(coarse * fine / (middle * middle))), -0.1, 0.1};
}

std::vector<ClaimCase> constants_are_those_of_the_cloth() {
  return {growth_with_spacing("diagonals", [](double) { return 1.0; }),
          growth_with_spacing("hinges", [](double l) { return l * l / 4; }),
          growth_with_spacing("baraff-witkin", [](double l) { return 2 / (l * l); })};
}

/// Forces per area of a St. Venant-Kirchhoff continuum with k1 = k2 = 1 and G, and those of the particles, over the strains.
/// Displacements are of second degree, so that differences of what is linear are exact: what is left is the strains squared.
std::vector<ClaimCase> tension_differs_by_squares() {
  constexpr double G = 0.5;
  using Displacement = Eigen::Vector2d (*)(double u, double v);
  const auto order = [&](const char* where, Displacement displacement) {
    const auto difference = [&](double size) {
      constexpr double d = 1e-3;  // of the differences below, which are exact up to the fourth power of the strains
      const auto position = [&](double u, double v) {
        return Eigen::Vector2d(Eigen::Vector2d(u, v) + size * displacement(u, v));
      };
      const auto stress = [&](double u, double v) {
        Eigen::Matrix2d F;
        F.col(0) = (position(u + d, v) - position(u - d, v)) / (2 * d);
        F.col(1) = (position(u, v + d) - position(u, v - d)) / (2 * d);
        const Eigen::Matrix2d E = (F.transpose() * F - Eigen::Matrix2d::Identity()) / 2;
        return Eigen::Matrix2d(F * Eigen::Matrix2d{{E(0, 0), 2 * G * E(0, 1)}, {2 * G * E(0, 1), E(1, 1)}});
      };
      constexpr int n = 21, middle = n / 2;
      const model::Cloth cloth = sheet_of(n, {{"material.tension", "1"}, {"material.shear", fmt::format("{}", G)}});
      solver::Vectors x = cloth.start.x, f = x;
      for (Eigen::Index i = 0; i < x.rows(); ++i)
        x.row(i).head<2>() = position(cloth.start.x(i, 0), cloth.start.x(i, 1)).transpose();
      cloth.ode.force(0, x, cloth.start.v, f);
      const int i = middle + n * middle;
      const double u = cloth.start.x(i, 0), v = cloth.start.x(i, 1);
      const Eigen::Vector2d exact =
          (stress(u + d, v) - stress(u - d, v)).col(0) / (2 * d) + (stress(u, v + d) - stress(u, v - d)).col(1) / (2 * d);
      return (f.row(i).head<2>().transpose() / cloth.ode.mass[i] - exact).norm();
    };
    const double before = std::log2(difference(0.02) / difference(0.01)),
                 after = std::log2(difference(0.01) / difference(0.005));
    return ClaimCase{where, after, std::abs(after - before), 1.9, unbounded};
  };
  return {order("stretch", [](double u, double v) { return Eigen::Vector2d(u * u / 2 + u, v * v / 2 + v); }),
          order("shear", [](double u, double v) { return Eigen::Vector2d(v * v / 2 + v, u * u / 2); }),
          order("both", [](double u, double v) { return Eigen::Vector2d(u * u / 2 + u * v, v * v / 2 + u * v); })};
}

/// Where the free end of a pulled St. Venant-Kirchhoff sheet comes to rest, less its length: ∫ λ − 1 dX with
/// ½ k (λ² − 1) λ = f (L − X), by Simpson's rule.
double displacement_of_continuum(const reference::PulledSheet& sheet) {
  constexpr int pieces = 200;
  const auto stretch = [&](int place) {
    const double stress = sheet.body_force / sheet.modulus * sheet.length * (1 - static_cast<double>(place) / pieces);
    double e = stress;  // λ − 1
    for (int k = 0; k < 20; ++k) e -= (e * (1 + e) * (1 + e / 2) - stress) / (1 + 3 * e + 1.5 * e * e);
    return e;
  };
  double sum = 0;
  for (int place = 0; place < pieces; place += 2) sum += stretch(place) + 4 * stretch(place + 1) + stretch(place + 2);
  return sum * sheet.length / (3 * pieces);
}

/// Experiment (a) of figure 2.11, whose right edge is fixed, against such a sheet.
std::vector<ClaimCase> equilibrium_differs_by_squares() {
  const auto difference = [](double body_force) {
    const reference::PulledSheet pulled{.body_force = body_force};
    const std::string gravity = fmt::format("[{:.17g}, 0, 0]", -body_force);
    model::Cloth cloth =
        model::compile(with("tension", {{"forces.gravity", gravity}, {"material.tension", fmt::format("{}", pulled.modulus)}}));
    std::vector<solver::Pin> pins(cloth.start.x.rows());
    for (int i = 0; i < cloth.ode.particles(); ++i)
      pins[i] = {.particle = i, .held = solver::axes(false, false, true)};  // springs would buckle
    for (const solver::Pin& pin : cloth.ode.pins) pins[pin.particle] = pin;
    cloth.ode.pins = std::move(pins);
    solver::Vectors guess = cloth.start.x;
    guess.col(0) += body_force / pulled.modulus * (guess.col(0).array() - pulled.length).matrix();
    const reference::Equilibrium rest = reference::equilibrium(cloth.ode, guess, {.line_search = false});
    const double displacement = cloth.start.x(0, 0) - rest.x(0, 0);
    return displacement - displacement_of_continuum(pulled);
  };
  const double whole = difference(9.81), half = difference(9.81 / 2), quarter = difference(9.81 / 4);
  const reference::PulledSheet pulled;
  const double strain = pulled.body_force * pulled.length / pulled.modulus;
  return {{"power of the load", std::log2(half / quarter), std::abs(std::log2(whole * quarter / (half * half))), 1.9, 2.1},
          {"over ½ (fL/k)² L", whole / (0.5 * strain * strain * pulled.length), strain, 0.99, 1.01}};
}

constexpr Claim of_forces[] = {
    {"P-03", "Etzmuß 2002", "2.5", "Algorithm 3 discretises the membrane, borders included", "order of the force per area", "1",
     algorithm_3_is_consistent},
    {"P-05", "Etzmuß 2002", "2.5", "Algorithm 5 discretises (2.22), to second order as the other forces",
     "order of the force per area", "1", algorithm_5_is_of_second_order},
    {"C-18", "Etzmuß 2002", "2.3.3", "the error of div_γ is quadratic in the strains",
     "order of the difference from a continuum in the strains", "1", tension_differs_by_squares},
    {"C-18b", "Etzmuß 2002", "2.8", "so is that of an equilibrium in the load", "difference of the free end from a continuum",
     "1", equilibrium_differs_by_squares},
    {"C-20", "Etzmuß 2002", "2.1.2, 2.3.3", "diagonal springs couple shear and transverse contraction", "C12 over G", "1",
     springs_contract},
    {"C-20b", "Etzmuß 2002", "2.3.4", "constants of springs, hinges and triangles are those of the cloth on every mesh",
     "power of the spacing by which the shear modulus grows", "1", constants_are_those_of_the_cloth},
    {"C-21", "Etzmuß 2002", "2.3.5", "no forces due to the off-diagonal f are needed",
     "membrane forces over those of a cylinder", "1", no_twist_is_needed},
    {"C-23b", "Etzmuß 2002", "2.3.5", "the whole curvature would counteract shear, the normal curvature does not",
     "plate forces over those of the same curvature out of the plane", "1", normal_curvature_leaves_shear_alone},
};

}  // namespace

std::span<const Claim> force_claims() { return of_forces; }

}  // namespace drape::bench
