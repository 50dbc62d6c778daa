#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "solver/contact/contact_response.hpp"
#include "solver/linear/conjugate_gradients.hpp"
#include "solver/options.hpp"
#include "solver/stage.hpp"

namespace drape::solver {

struct StageResult {
  Outcome outcome = Outcome::success;
  int updates = 0;  ///< linear systems solved
  int cg_iterations = 0;
};

/// The equation of a stage as r(v) = μ M (av − v) + γ f = 0, with the constant matrix A = μ M − γ² K − γ D for corrections of
/// v. A is assembled again only when γ or μ changes.
///
/// Particles that are pinned in all three directions have only their diagonal in A. Only the constructor allocates.
class StageSystem {
 public:
  StageSystem(const SplitOde& ode, const Options& options, ContactResponse* contacts);

  /// Assembles and factors A for this γ and μ, unless its own γ differs by less than `different`, relatively.
  Outcome prepare(double gamma, double inertia, double different = 1e-12);

  /// Assembles and factors the matrix of a linear stage: A, or M − γ D if its springs are explicit.
  Outcome prepare(const Stage& stage) {
    return stage.springs ? prepare(stage.gamma, stage.inertia) : prepare_damping(stage.gamma);
  }

  /// Assembles and factors M − γ D in place of A, for methods whose springs are explicit.
  Outcome prepare_damping(double gamma);

  /// K or D has changed: A is assembled again before the next stage.
  void renew();

  /// γ of A [s].
  double gamma() const { return gamma_; }

  /// Sets x = ax + γ v, imposes contacts and sets r in all coordinates; f = K x + D v + f̂ if f̂ is given, and without K x if
  /// springs are explicit.
  void evaluate(const Stage& stage, const Vectors* f_explicit, State& y);

  /// Adapts the contacts to y and r; true if they changed, with y and r evaluated again. `noise`, `changes`: as
  /// in ContactResponse::update.
  bool adapt_contacts(const Stage& stage, const Vectors* f_explicit, State& y, double noise, ContactResponse::Changes changes);

  /// Adds friction to r and removes the directions of pins and constraints.
  void filter_residual(double gamma);

  /// A d = r, to |A d − r| ≤ target; r is lost.
  LinearResult correct(double target) { return cg_.solve(A_, filtered(), r_, d_, target); }

  /// z ≈ A⁻¹ r in the directions that pins leave free, for an r that lies in them. Returns <r, z>.
  double precondition(const Vectors& r, Vectors& z) { return cg_.precondition(pinned_, r, z); }

  /// Scale of |r|: |b| = |r + A v|, and the round-off below which no residual falls. If springs are explicit, steps are so
  /// short that |b| would be all momentum: there it is the |r| of the guess.
  struct Scale {
    double b, round_off;
    double target(double tolerance) const { return std::max(tolerance * b, round_off); }
  };
  Scale scale(const Stage& stage, const State& y);

  /// Round-off of |r| [N s], from differences of positions times spring constants.
  double noise(const State& y, double gamma) const;

  /// Round-off of a sum of terms of this size.
  static double round_off(double size) { return 8 * std::numeric_limits<double>::epsilon() * size; }

  /// Error of v [m/s] that may be left in a stage that began with this guess: a part of the error of the time step, which the
  /// distance between the two indicates, and at least round-off.
  double allowed_error(const Stage& stage, const Vectors& guess, const State& y) const {
    const auto [begin, count] = ode_.partition->own(y.x.size());
    const auto change = (Eigen::VectorXd::Map(y.v.data(), y.v.size()) - Eigen::VectorXd::Map(guess.data(), guess.size()));
    std::array squares{ode_.partition->own(y.x).squaredNorm(), change.segment(begin, count).squaredNorm()};
    ode_.partition->add_up(squares);
    return std::max(round_off(std::sqrt(squares[0])) / stage.gamma, stage.accuracy * std::sqrt(squares[1]));
  }

  /// A d = r for another r, without its components along pins and constraints.
  LinearResult respond(const Vectors& r, double tolerance, double noise = 0);

  /// A d = M r_v + γ K r_x for the A that was prepared last.
  LinearResult respond(const State& r, double tolerance, double noise);

  bool touches() const { return contacts_ != nullptr && !contacts_->empty(); }

  /// Finds where the cloth meets itself on the way to a solution; true if that adds constraints.
  bool finds_pairs(const Stage& stage, const State& y) { return contacts_ != nullptr && contacts_->find_pairs(stage, y); }
  const Vectors& residual() const { return r_; }

  /// |a| over all particles.
  double size(const Vectors& a) const { return ode_.partition->norm(a); }
  Vectors& correction() { return d_; }

 private:
  struct Merged;
  StageSystem(const SplitOde& ode, const Merged& merged, const Options& options, ContactResponse* contacts);

  Outcome make(double gamma, double springs, double inertia);
  const Filter& filtered() const { return touches() ? contacts_->filter() : pinned_; }

  const SplitOde& ode_;
  ContactResponse* const contacts_;
  const Filter pinned_;  ///< partially pinned particles
  ConjugateGradients cg_;
  SparseMatrix A_;
  Eigen::ArrayXd mass_, stiffness_, damping_;  // each aligned with the entries of A
  Eigen::ArrayXd momentum_, spring_;           // mass and diagonal of K, three times each, as coordinates lie in memory
  double gamma_ = 0, inertia_ = 1;
  Vectors r_, d_, q_;
  Eigen::VectorXd bounds_;
  LinearCounters work_;
};

}  // namespace drape::solver
