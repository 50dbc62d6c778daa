#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/stage/loop_tolerance.hpp"
#include "solver/stage/stage_solver.hpp"

namespace drape::solver {
namespace {

constexpr double worse = 4;  ///< growth of the residual, over the least one, that restarts an acceleration

/// Updates in which contacts have not changed before acceleration begins. An accelerated iterate goes beyond the solution,
/// where a pair may hold at a border of cells that the solution passes.
constexpr int quiet_updates = 1, quiet_pair_updates = 3;

}  // namespace

StageResult StageSolver::fixed_point(const Stage& stage, const Vectors* f_explicit, State& y) {
  StageResult result;
  result.outcome = system_.prepare(stage);
  if (result.outcome != Outcome::success) return result;
  prescribe(ode_.pins, y.v);
  const auto ended = [&](Outcome outcome) { return StageResult{outcome, result.updates, result.cg_iterations}; };

  const bool linear = f_explicit != nullptr, contacts = system_.touches();
  const int passes = linear ? 0 : options_.accepted_passes();
  const double tolerance = linear ? options_.cg_tolerance : loop_tolerance(options_, stage);
  const double cg_tolerance = linear || passes > 0
                                  ? options_.cg_tolerance
                                  : std::min(options_.cg_tolerance, tolerance / 2);  // else the loop could not end
  const int changing_updates = !linear ? 50 : ode_.pairs ? 30 : 10;
  Anderson* const anderson = !linear && contacts && in_contact_ ? &*in_contact_ : nullptr;
  if (anderson != nullptr) anderson->restart();
  double least = std::numeric_limits<double>::infinity();
  StageSystem::Scale size{};
  bool coarse = false;
  int quiet = 0;
  for (;; ++result.updates, ++work_.updates) {
    const bool accepted = passes > 0 && result.updates >= passes;
    if (accepted && !contacts) return y.x = stage.ax + stage.gamma * y.v, ended(Outcome::success);
    system_.evaluate(stage, f_explicit, y);
    const bool solved = result.updates > 0;
    using Changes = ContactResponse::Changes;
    const Changes may_change = result.updates >= changing_updates ? Changes::captures
                               : coarse                           ? Changes::constraints
                                                                  : Changes::all;
    const bool changed = contacts && solved && system_.adapt_contacts(stage, f_explicit, y, size.target(tolerance), may_change);
    const double whole = contacts ? system_.size(system_.residual()) : 0;
    system_.filter_residual(stage.gamma);
    if (!solved) size = system_.scale(stage, y);
    size.round_off = std::max(size.round_off, StageSystem::round_off(whole));

    const double residual = system_.size(system_.residual());
    if (!std::isfinite(residual)) return ended(Outcome::not_finite);
    const double solved_to = stage.residual > 0 ? stage.residual / 2 : size.target(cg_tolerance);
    const bool guessed = !linear && !contacts && passes == 0 && residual <= solved_to;
    const bool enough = passes > 0 ? accepted : residual <= (stage.residual > 0 ? stage.residual : size.target(tolerance));
    if (solved ? !changed && !coarse && enough : guessed) return ended(Outcome::success);
    if (result.updates == options_.max_updates) return ended(Outcome::not_converged);

    // While constraints change, a solution only tells which ones hold: a residual of a tenth does, at a third of the
    // iterations.
    coarse = contacts && (changed || !solved) && residual > 10 * solved_to;
    const LinearResult system = system_.correct(coarse ? residual / 10 : solved_to);
    result.cg_iterations += system.iterations;
    if (anderson != nullptr) {
      quiet = changed ? 0 : quiet + 1;
      const bool restarts = quiet < (ode_.pairs ? quiet_pair_updates : quiet_updates) || residual > worse * least;
      if (restarts) anderson->restart();
      least = restarts ? residual : std::min(least, residual);
      anderson->advance(y.v, system_.correction());
    } else {
      y.v += system_.correction();
    }
    if (system.outcome != Outcome::success) return ended(system.outcome);
  }
}

}  // namespace drape::solver
