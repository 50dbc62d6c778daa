#pragma once

#include <functional>
#include <string>
#include <vector>

#include "solver/split_ode.hpp"

/// Small equations of motion whose solutions are known exactly.
namespace drape::verify::known_motions {

using solver::Pin;
using solver::SparseMatrix;
using solver::SplitOde;
using solver::State;
using solver::Vectors;

/// An equation of motion with its exact solution.
struct Problem {
  std::string name;
  SplitOde ode;
  State start;
  std::function<State(double t)> exact;
};

/// A scalar matrix for all three coordinates: 3N × 3N.
SparseMatrix threefold(const SparseMatrix& scalar);

/// m dv/dt = K x + D v.
SplitOde linear_ode(const Eigen::VectorXd& mass, const SparseMatrix& K, const SparseMatrix& D);

/// K of `particles` in a row, neighbours joined by springs of stiffness k.
SparseMatrix row_of_springs(int particles, double k);

State single(const Eigen::RowVector3d& x, const Eigen::RowVector3d& v);

/// x(t) = a e^(-ct) (cos wt + c/w sin wt), released at rest.
Problem damped_oscillator();

/// A mass whirling round the origin on a spring with a rest length: f = -k (1 - l/|x|) x, a circle if m w² r = k (r - l).
Problem whirling_spring();

/// Ten particles between two fixed ones: two modes sin(p π i/11) with w² = 4k/m sin²(p π/22).
Problem chain();

/// A particle at rest, towed along x by a spring whose other end moves with the velocity u from t0 = 0; it may not move
/// along y, and along z it has the prescribed velocity w.
Problem towed_particle();

}  // namespace drape::verify::known_motions
