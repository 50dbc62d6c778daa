#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "model/forces/term.hpp"
#include "model/sheet/cells.hpp"
#include "model/sheet/strain.hpp"

namespace drape::model {
namespace {

using Green = Eigen::Vector3d;  ///< ε11, ε22, ε12

/// The piece between five places 0 to 4 that holds a place, the last beyond them; motions that explode come to places that are
/// not finite.
int piece(double place) { return place < 4 ? static_cast<int>(place) : 3; }

/// C11, C12, C22, C33 of a state of strain; their derivatives by it, 0 unless they are asked for.
struct MeasuredModuli {
  Eigen::Vector4d C;
  Eigen::Matrix<double, 4, 3> by_strain;
};

/// Between the rows of the table, linear in the larger principal stretch and in the angle of its direction; what is negative
/// counts as 0, beyond the measured stretch moduli are constant, and all are doubled.
MeasuredModuli moduli(const FabricTables& tables, const Green& e, bool derivatives) {
  constexpr double measured_stretch = 1.0 / 6, between_angles = std::numbers::pi / 8;
  const double mean = 1 + e[0] + e[1], half = e[0] - e[1], across = 2 * e[2];  // of 1 + 2 ε
  const double radius = std::hypot(half, across), stretch = std::sqrt(mean + radius);
  const double weight = std::clamp((stretch - 1) / measured_stretch, 0.0, 1.0);
  const double turn = std::atan2(across, half) / 2;
  const double place = std::abs(turn) / between_angles;
  const int k = piece(place);
  const auto row = [&](int i) { return Eigen::Map<const Eigen::Vector4d>(tables.stretching[i].data()); };
  const Eigen::Vector4d stretched = row(k + 1) + (place - k) * (row(k + 2) - row(k + 1));

  MeasuredModuli found{2 * (row(0) + weight * (stretched - row(0))), Eigen::Matrix<double, 4, 3>::Zero()};
  if (derivatives && weight > 0 && radius > 0) {
    const Eigen::RowVector3d turn_by = Eigen::RowVector3d(-across, across, 2 * half) / (2 * radius * radius);
    found.by_strain = 2 * weight * std::copysign(1 / between_angles, turn) * (row(k + 2) - row(k + 1)) * turn_by;
    if (weight < 1) {
      const Eigen::RowVector3d radius_by = Eigen::RowVector3d(half, -half, 2 * across) / radius;
      const Eigen::RowVector3d stretch_by = (Eigen::RowVector3d(1, 1, 0) + radius_by) / (2 * stretch);
      found.by_strain += 2 / measured_stretch * (stretched - row(0)) * stretch_by;
    }
  }
  for (int i = 0; i < 4; ++i)
    if (found.C[i] < 0) found.C[i] = 0, found.by_strain.row(i).setZero();
  return found;
}

/// Stresses σ11, σ22 and that of ε12, with their derivatives by the strains. The moduli count as constant in a virtual
/// displacement, as published, so that no energy has these stresses.
struct Stresses {
  Eigen::Vector3d value;
  Eigen::Matrix3d by_strain;
};

Stresses stresses(const FabricTables& tables, const Green& e, bool exact) {
  const auto [C, by] = moduli(tables, e, exact);
  Stresses found{{C[0] * e[0] + C[1] * e[1], C[2] * e[1] + C[1] * e[0], C[3] * e[2]}, Eigen::Matrix3d::Zero()};
  found.by_strain.diagonal() << C[0], C[2], C[3];
  if (!exact) return found;  // a symmetric positive part
  found.by_strain(0, 1) = found.by_strain(1, 0) = C[1];
  found.by_strain.row(0) += e[0] * by.row(0) + e[1] * by.row(1);
  found.by_strain.row(1) += e[1] * by.row(2) + e[0] * by.row(1);
  found.by_strain.row(2) += e[2] * by.row(3);
  return found;
}

/// The forces of a fabric's tables on a grid.
class TableForces {
 public:
  explicit TableForces(const Sheet& sheet);

  void add_rest(const Vectors& x, Vectors& f) const;
  void add_jacobian(const Vectors& x, const JacobianEntries& entries) const;

 private:
  double moment(bool weft, double curvature, double& slope) const;
  Green strain(const Eigen::Vector3d& s_u, const Eigen::Vector3d& s_v) const {
    return {(s_u.squaredNorm() - 1) / 2, (s_v.squaredNorm() - 1) / 2, s_u.dot(s_v) / 2};
  }

  FabricTables tables_;
  WeftWarp spring_, bend_;
  double lu_, lv_;
  std::vector<Edge> edges_;
  std::vector<Cell> cells_;
  std::vector<LineCurvature> bendings_;  ///< beside the plate, whose B is that of no curvature
};

TableForces::TableForces(const Sheet& sheet)
    : tables_(sheet.material.tables),
      spring_(sheet.material.tension),
      bend_(sheet.material.bend),
      lu_(sheet.grid.spacing_u()),
      lv_(sheet.grid.spacing_v()),
      edges_(edges(sheet.grid)),
      cells_(cells(sheet.grid)) {
  if (sheet.material.bend_form != BendForm::plate) return;
  bendings_ = line_curvatures(sheet.grid);
}

/// (B(κ) − B) κ with its derivative: B(κ) is linear between the curvatures of the table and constant beyond.
double TableForces::moment(bool weft, double curvature, double& slope) const {
  constexpr double between_curvatures = 10;  // [1/m]
  const double place = std::abs(curvature) / between_curvatures;
  const auto& B = tables_.bending[weft ? 0 : 2];
  const int k = piece(place);
  const bool beyond = place >= 4;
  double now = beyond ? B[4] : B[k] + (place - k) * (B[k + 1] - B[k]);
  double rise = beyond ? 0 : (B[k + 1] - B[k]) / between_curvatures;
  if (now < 0) now = rise = 0;
  const double more = now - (weft ? bend_.weft : bend_.warp);
  slope = more + rise * std::abs(curvature);
  return more * curvature;
}

void TableForces::add_rest(const Vectors& x, Vectors& f) const {
  const double area = lu_ * lv_ / 4;
  for (const Cell& cell : cells_)
    for (const auto& [p, q] : quadrants(cell)) {
      const Eigen::Vector3d s_u = difference(x, p) / lu_, s_v = difference(x, q) / lv_;
      const Eigen::Vector3d sigma = stresses(tables_, strain(s_u, s_v), false).value;
      add_pull(f, p, area / lu_ * (sigma[0] * s_u + sigma[2] / 2 * s_v));
      add_pull(f, q, area / lv_ * (sigma[1] * s_v + sigma[2] / 2 * s_u));
    }
  for (const Edge& edge : edges_)
    add_pull(f, {edge.i, edge.j}, -along(spring_, edge) * edge.width / edge.length * difference(x, {edge.i, edge.j}));
  Strain::Gradient by;
  double slope = 0;
  for (const auto& [curvature, weft] : bendings_) curvature.add_force(moment(weft, curvature.value(x, by), slope), by, f);
}

void TableForces::add_jacobian(const Vectors& x, const JacobianEntries& entries) const {
  const double area = lu_ * lv_ / 4;
  const auto& dx = entries.add_dx;
  const bool exact = entries.exact(), shear = entries.curvature != Curvature::tension;
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  for (const Cell& cell : cells_)
    for (const auto& [p, q] : quadrants(cell)) {
      const Eigen::Vector3d s_u = difference(x, p) / lu_, s_v = difference(x, q) / lv_;
      auto [sigma, D] = stresses(tables_, strain(s_u, s_v), exact);
      if (!exact) sigma = {std::max(sigma[0], 0.0), std::max(sigma[1], 0.0), 0};
      if (!shear) D(2, 2) = 0;
      Eigen::Matrix3d U, V;  // of the strains by s_u and s_v, a strain a row
      U << s_u.transpose(), Eigen::RowVector3d::Zero(), s_v.transpose() / 2;
      V << Eigen::RowVector3d::Zero(), s_v.transpose(), s_u.transpose() / 2;
      add_edge_pair(dx, p, p, area / (lu_ * lu_) * (U.transpose() * D * U + sigma[0] * I));
      add_edge_pair(dx, q, q, area / (lv_ * lv_) * (V.transpose() * D * V + sigma[1] * I));
      if (!shear) continue;
      add_edge_pair(dx, p, q, area / (lu_ * lv_) * (U.transpose() * D * V + sigma[2] / 2 * I));
      add_edge_pair(dx, q, p, area / (lu_ * lv_) * (V.transpose() * D * U + sigma[2] / 2 * I));
    }
  if (!shear) return;
  Strain::Gradient by;
  double slope = 0;
  for (const auto& [curvature, weft] : bendings_) {
    const double M = moment(weft, curvature.value(x, by), slope);
    curvature.add_jacobian(x, exact ? M : 0, exact ? slope : std::max(slope, 0.0), by, dx);
  }
}

}  // namespace

/// Stretch and shear of a fabric as Wang, O'Brien and Ramamoorthi [2011] publish it: Green's strain of every quadrant, moduli
/// that depend on the larger principal stretch and its direction, and a bending stiffness that depends on the curvature.
/// K takes k1 and k2.
std::optional<Term> make_tables(const Sheet& sheet) {
  if (!by_tables(sheet.material) || sheet.grid.nu < 2 || sheet.grid.nv < 2) return {};
  const auto forces = std::make_shared<const TableForces>(sheet);
  Term term;
  term.law.edge = {.spring = sheet.material.tension};
  term.without_energy = true;
  term.force = [=](const Configuration& c, Vectors& f) { forces->add_rest(c.x, f); };
  term.jacobian = [=](const Configuration& c, const JacobianEntries& entries) { forces->add_jacobian(c.x, entries); };
  return term;
}

}  // namespace drape::model
