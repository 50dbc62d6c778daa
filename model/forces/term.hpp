#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "model/forces/fused/law.hpp"
#include "model/sheet/sheet.hpp"

namespace drape::model {

/// What forces are functions of. Positions, velocities and unit normals are N × 3; normals are empty if no term asks.
struct Configuration {
  double t;
  const Vectors& x;
  const Vectors& v;
  const Vectors& normals;
};

/// Which derivatives a term hands out.
enum class Curvature {
  exact,  ///< all of them
  convex,  ///< only a symmetric negative semidefinite part of every element, so that M − γ² ∂f/∂x − γ ∂f/∂v can be factored
  tension,  ///< of that nothing that couples more than the ends of an edge
};

/// Takes 3 × 3 blocks of ∂f/∂x and ∂f/∂v: row particle i, column particle j. A term adds its blocks in an order that depends
/// on nothing but the grid and the kind of curvature.
struct JacobianEntries {
  using Add = std::function<void(int i, int j, const Eigen::Matrix3d& block)>;
  Curvature curvature;
  Add add_dx, add_dv;

  bool exact() const { return curvature == Curvature::exact; }
};

/// One force of a compiled sheet: what it adds to the law of the grid, which is evaluated for all terms together, or functions
/// that add to their result. Forces are in newtons.
struct Term {
  GridLaw law;           ///< the whole force
  GridLaw explicit_law;  ///< without K x + D v
  GridLaw active_law;    ///< what neither has an energy nor only takes some
  std::function<void(const Configuration&, Vectors& f)> force;
  std::function<void(const Configuration&, Vectors& f)> explicit_force;  ///< without K x + D v; absent: nothing is left
  std::function<void(const Configuration&, Vectors& f)> active_force;    ///< no energy, not only taking some; absent: none
  std::function<double(const Vectors& x)> energy;                        ///< [J]; absent if there is none
  std::function<void(const Configuration&, const JacobianEntries&)> jacobian;  ///< exact; absent: zero
  std::function<void(std::vector<Eigen::Triplet<double>>& K)> stiffness;       ///< its part of K; absent: none
  std::function<void(std::vector<Eigen::Triplet<double>>& D)> damping;         ///< its part of D; absent: none
  bool needs_normals = false;
};

/// A row of the table of forces. `make` returns nothing if the sheet does not have the force.
struct TermKind {
  std::string_view name;
  std::string_view description;
  std::optional<Term> (*make)(const Sheet&);
};

/// All forces that the model knows.
std::span<const TermKind> term_kinds();

std::optional<Term> make_tension(const Sheet& sheet);
std::optional<Term> make_linear_damping(const Sheet& sheet);
std::optional<Term> make_projected_damping(const Sheet& sheet);
std::optional<Term> make_shear(const Sheet& sheet);
std::optional<Term> make_printed_shear(const Sheet& sheet);
std::optional<Term> make_contraction(const Sheet& sheet);
std::optional<Term> make_membrane(const Sheet& sheet);
std::optional<Term> make_plate(const Sheet& sheet);
std::optional<Term> make_printed_plate(const Sheet& sheet);
std::optional<Term> make_gravity(const Sheet& sheet);
std::optional<Term> make_wind(const Sheet& sheet);
std::optional<Term> make_air(const Sheet& sheet);

}  // namespace drape::model
