#pragma once

#include <algorithm>

#include "solver/conjugate_gradients.hpp"
#include "solver/contact_response.hpp"
#include "solver/options.hpp"
#include "solver/stage.hpp"

namespace drape::solver {

struct StageResult {
  Outcome outcome = Outcome::success;
  int updates = 0;  ///< linear systems solved
  int cg_iterations = 0;
};

/// Solves stages with the constant matrix A = M − γ² K − γ D, rebuilt only when γ changes.
///
/// Particles that are pinned in all three directions have no entries in A but their diagonal. All calls take the state
/// with a first guess of v; its prescribed velocities are set here. No call but the constructor allocates.
class StageSolver {
 public:
  /// `contacts`: the response to contacts, null if there are no obstacles.
  StageSolver(const SplitOde& ode, const Options& options, ContactResponse* contacts = nullptr);

  /// The stage with f = K x + D v + f̂ and given f̂: one linear system   [Etzmuß 2002, (3.23), (3.30)], and one more
  /// whenever contacts change.
  StageResult solve_linear(const Stage& stage, const Vectors& f_explicit, State& y);

  /// The whole stage by the fixed-point loop: a simplified Newton method with A for the Jacobian
  /// [Etzmuß 2002, (3.33)–(3.36), Alg. 6]. The guess counts as a solution only if its own residual passes the test of CG.
  StageResult solve(const Stage& stage, State& y);

 private:
  /// What |residual| is compared with: |b|, and the round-off below which no residual falls.
  struct Scale {
    double b, round_off;
    double target(double tolerance) const { return std::max(tolerance * b, round_off); }
  };

  Outcome prepare(double gamma);
  StageResult solve(const Stage& stage, const Vectors* f_explicit, State& y);
  bool touches() const { return contacts_ != nullptr && !contacts_->empty(); }
  const Filter& filtered() const { return touches() ? contacts_->filter() : pinned_; }
  void evaluate(const Stage& stage, const Vectors* f_explicit, State& y);
  void filter_residual(double gamma);
  Scale scale(const Vectors& residual, const State& y, double gamma);

  const SplitOde& ode_;
  const Options options_;
  ContactResponse* const contacts_;
  const Filter pinned_;  ///< partially pinned particles
  ConjugateGradients cg_;
  SparseMatrix A_;
  Eigen::ArrayXd mass_, stiffness_, damping_;  // each aligned with the entries of A
  Eigen::ArrayXd momentum_, spring_;           // mass and diagonal of K, each thrice a particle, as coordinates lie in memory
  double gamma_ = 0;
  Vectors r_, d_, q_;
  LinearWork work_;
};

}  // namespace drape::solver
