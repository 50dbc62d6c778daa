#pragma once

#include "solver/stage/anderson.hpp"
#include "solver/stage/newton_search.hpp"
#include "solver/stage/stage_system.hpp"

namespace drape::solver {

/// Solves stages without contacts by Anderson's method. What it accelerates is the iteration v ← v + P⁻¹ r(v), where P is the
/// constant matrix A or a Newton matrix, which is kept until convergence slows. An update that leads away is taken back and
/// tried with a smaller part, or with a new matrix; where that does not help, NewtonSearch goes on.
///
/// It ends when an estimate of the error of v is a small part of the error of the time step, which the distance between
/// solution and first guess tells (Stage::accuracy). There are two estimates: |P⁻¹ r| over the weakest response seen to a
/// change of v; and, since the error lies between |P⁻¹ r| and |M⁻¹ r|, their geometric mean. The first alone is too small where
/// A is so much stiffer than the cloth that no response is seen.
class AcceleratedLoop {
 public:
  AcceleratedLoop(const SplitOde& ode, const Options& options, StageSystem& system);

  /// y: with the first guess of v.
  StageResult solve(const Stage& stage, State& y);

 private:
  using Matrix = StageKind::Matrix;

  void begin(const Stage& stage, const State& y);
  void start_iteration();
  void forget();
  bool find_matrix(State& y);
  void recycle();
  void measure();
  bool use_newton(NewtonSystem* matrix, State& y);
  bool correct();
  bool retreat(State& y);
  bool search(State& y);
  bool escalate(State& y);
  void expect();
  void advance(State& y);
  bool close_enough(const State& y) const;
  bool may_escalate() const;
  bool blind() const;
  bool slow() const;
  NewtonSystem* preferred();
  void plan_next();
  StageResult ended(Outcome outcome);

  const SplitOde& ode_;
  const Options& options_;
  StageSystem& system_;
  const Eigen::ArrayXd mass_, drag_;   ///< M and the diagonal of D, each value three times, as coordinates lie in memory
  const Eigen::ArrayXd inverse_mass_;  ///< M⁻¹ in the same way
  Eigen::ArrayXd unsprung_inverse_;    ///< (M − γD)⁻¹, of which only the diagonal counts
  double unsprung_gamma_ = 0;          ///< its γ [s]
  Anderson anderson_;
  NewtonSystem newton_, lean_newton_;
  NewtonSearch search_;
  Vectors guess_;
  Vectors best_v_, best_d_;  ///< where |d| was smallest since the last renewal

  // Of the stage that is being solved.
  const Stage* stage_ = nullptr;
  StageResult result_;
  NewtonSystem* matrix_ = nullptr;  ///< P; null for A
  double residual_ = 0;             ///< |r|
  double noise_ = 0;                ///< what of it is round-off
  double size_ = 0;                 ///< |d|
  double bound_ = 0;                ///< |M⁻¹ r|
  double unsprung_ = 0;             ///< the same with M − γD, of which only the diagonal counts
  double best_ = 0;                 ///< smallest |d|
  double part_ = 1;                 ///< of an update that is made
  double last_ = 0;                 ///< |d| before the last update
  double rate_ = 0;                 ///< by which |d| changed last
  int since_renewal_ = 0, renewals_here_ = 0;
  bool made_here_ = false;  ///< P was made at best_v_; A is what it is everywhere
  bool searched_ = false;   ///< the stage was solved by line searches

  // What serves on in the next stage, if P is the same.
  NewtonSystem* recycled_matrix_ = nullptr;
  double recycled_gamma_ = 0;  ///< of A [s]
  double first_ = 0;
  double reduction_ = 1;  ///< by which an update reduces |d|, as seen last

  // What `auto` remembers.
  int newton_stages_ = 0;  ///< still to be solved with Newton's matrix
  int next_stay_ = 4;
  double mean_cost_ = 0;  ///< of a stage with Newton's matrix, in updates with A
  LinearCounters work_;
  std::int64_t& escalations_;
};

}  // namespace drape::solver
