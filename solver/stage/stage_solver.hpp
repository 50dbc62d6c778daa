#pragma once

#include <memory>
#include <optional>

#include "solver/stage/anderson.hpp"
#include "solver/stage/stage_system.hpp"

namespace drape::solver {

class AcceleratedStage;
class StageIteration;

/// Solves stages as the options say. All calls take the state with a first guess of v; they set its prescribed velocities.
class StageSolver {
 public:
  /// `contacts`: the response to contacts, null if there are no obstacles.
  StageSolver(const SplitOde& ode, const Options& options, ContactResponse* contacts = nullptr);
  ~StageSolver();

  /// The stage with f = K x + D v + f̂ and given f̂: one linear system   [Etzmuß 2002, (3.23), (3.30)], and one more
  /// whenever contacts change.
  StageResult solve_linear(const Stage& stage, const Vectors& f_explicit, State& y);

  /// The whole stage, as its kind says, or by the fixed-point loop where something is touched: a simplified Newton method
  /// with A for the Jacobian [Etzmuß 2002, (3.33)–(3.36), Alg. 6]. There the guess counts as a solution only if its own
  /// residual passes the test of CG. If the options accept a number of passes, no residual is tested; in contact the stage
  /// ends after these when its contacts do not change any more.
  StageResult solve(const Stage& stage, State& y);

  /// The d of (M − γ D) d = r in the directions that pins leave free: one linear system, for methods whose springs are
  /// explicit.
  const Vectors& solve_damping(double gamma, const Vectors& r, StageResult& result);

  /// K has changed.
  void renew() { system_.renew(); }

  /// Whether the next stage is accelerated.
  bool accelerates() const { return accelerated_ && !system_.touches(); }

  /// The change of v [m/s], N × 3, that a change `r` of γ f would have made in the last linear stage; its linear system counts.
  const Vectors& respond(const Vectors& r, StageResult& result);

  /// (1 − γ J) k = r with J the Jacobian of (v, M⁻¹ (K x + D v)): A k_v = M r_v + γ K r_x,   k_x = r_x + γ k_v; no contacts.
  /// y: a state nearby, whose round-off is left.
  StageResult solve_increment(double gamma, const State& y, const State& r, State& k);

 private:
  StageResult solve_once(const Stage& stage, State& y);
  StageResult meet_pairs(const Stage& stage, const Vectors* f_explicit, State& y, StageResult result);
  StageResult one_system(const Stage& stage, const Vectors& f_explicit, State& y);

  /// Algorithm 6, with the response to contacts, accelerated while these do not change if the stage's kind is. f̂ is given for
  /// linear stages with contacts.
  StageResult fixed_point(const Stage& stage, const Vectors* f_explicit, State& y);

  /// Algorithm 6 to the letter, without contacts.
  StageResult printed_loop(const Stage& stage, State& y);

  const SplitOde& ode_;
  const Options options_;
  StageSystem system_;
  std::unique_ptr<AcceleratedStage> accelerated_;  ///< if the options ask for it
  std::unique_ptr<StageIteration> iteration_;      ///< if the options ask for one
  std::optional<Anderson> in_contact_;             ///< of the loop, where stages are accelerated and contacts possible
  LinearCounters work_;
};

}  // namespace drape::solver
