#pragma once

#include <cstdint>
#include <vector>

#include "solver/state.hpp"

namespace drape::solver {

/// What forces remember of the motion: internal variables z that belong to the state, dz/dt = g(x, v, z).
///
/// The variables are not unknowns of a stage. They change where a step is accepted; within a step forces at (t, x, v) are those
/// of a motion that goes from the last accepted state to (x, v) on a polynomial path, along which z is found exactly. So within
/// a step the force is a smooth function of t, x and v, and a method keeps its order if the path is as accurate as the method:
/// linear in time up to order 2, the cubic with the velocities of both ends up to order 4, and beyond the quintic with
/// the accepted state before as well.
class Memory {
 public:
  virtual ~Memory() = default;

  virtual int variables() const = 0;

  /// A motion begins here, by a method of this order. An empty z: nothing has happened yet.
  virtual void begin(int order, double t, const State& y) = 0;

  /// The motion has come to this state, or goes on from it again.
  virtual void pass(double t, const State& y) = 0;

  /// Sets z of a state at the end of a path.
  virtual void carry(double t, State& y) = 0;

  /// g, for solvers to which z are unknowns as others.
  virtual void rate(const State& y, Eigen::VectorXd& dz) const = 0;

  /// For such a solver's Newton method, at a state: d.z of (1 − γ ∂g/∂z) d.z = r.z + γ (∂g/∂x d.x + ∂g/∂v d.v), about.
  virtual void respond(double gamma, const State& y, const Eigen::VectorXd& r, State& d) const = 0;

  /// Branches of laws whose forces have kinks in between, each a number, at a state with its z; empty: all forces are smooth.
  virtual void branches(const State& y, std::vector<int>& now) const = 0;

  /// The part of a step of h [s] from y0, with its z, to y1 at which the first of those ends that are there at the part `from`,
  /// positions being cubic in time; 1 if none does.
  virtual double first_kink(double h, double from, const State& y0, const State& y1) const = 0;

  /// How often K has changed since the motion began, and K as it is now: SplitOde::stiffness follows at the beginnings of
  /// steps.
  virtual std::int64_t stiffness_changes() const = 0;
  virtual const SparseMatrix& stiffness() = 0;

  /// Energy that is stored beside that of the positions [J].
  virtual double energy(const State& y) const = 0;
};

}  // namespace drape::solver
