#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "model/grid.hpp"
#include "model/material.hpp"

namespace drape::model {

using solver::SparseMatrix;
using solver::Vectors;

/// What forces are functions of. Positions, velocities and unit normals are N × 3; normals are empty if no term asks.
struct Configuration {
  double t;
  const Vectors& x;
  const Vectors& v;
  const Vectors& normals;
};

/// Collects 3 × 3 blocks of ∂f/∂x and ∂f/∂v: row particle i, column particle j.
struct JacobianEntries {
  std::vector<Eigen::Triplet<double>> dx, dv;

  void add_dx(int i, int j, const Eigen::Matrix3d& block) { add(dx, i, j, block); }
  void add_dv(int i, int j, const Eigen::Matrix3d& block) { add(dv, i, j, block); }

 private:
  static void add(std::vector<Eigen::Triplet<double>>& entries, int i, int j, const Eigen::Matrix3d& block);
};

/// A sheet before it is compiled: what every force is made from.
struct Sheet {
  Grid grid;
  Material material;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s²]
};

/// One force of a compiled sheet. All functions add to their result; forces are in newtons.
struct Term {
  std::function<void(const Configuration&, Vectors& f)> force;
  std::function<void(const Configuration&, Vectors& f)> explicit_force;   ///< without K x + D v; absent: nothing is left
  std::function<double(const Vectors& x)> energy;                         ///< [J]; absent if there is none
  std::function<void(const Configuration&, JacobianEntries&)> jacobian;   ///< exact; absent: zero
  std::function<void(std::vector<Eigen::Triplet<double>>& K)> stiffness;  ///< its part of K; absent: none
  std::function<void(std::vector<Eigen::Triplet<double>>& D)> damping;    ///< its part of D; absent: none
  Vectors constant;                                                       ///< a force that never changes; empty: none
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

}  // namespace drape::model
