#include <functional>

#include "bench/studies/claims/claim.hpp"
#include "bench/studies/claims/sheet_runs.hpp"
#include "model/cloth.hpp"

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

constexpr Claim of_forces[] = {
    {"C-21", "Etzmuß 2002", "2.3.5", "no forces due to the off-diagonal f are needed",
     "membrane forces over those of a cylinder", "1", no_twist_is_needed},
    {"C-23b", "Etzmuß 2002", "2.3.5", "the whole curvature would counteract shear, the normal curvature does not",
     "plate forces over those of the same curvature out of the plane", "1", normal_curvature_leaves_shear_alone},
};

}  // namespace

std::span<const Claim> force_claims() { return of_forces; }

}  // namespace drape::bench
