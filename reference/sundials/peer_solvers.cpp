#include "reference/sundials/peer_solvers.hpp"

#include "reference/sundials/arkode.hpp"
#include "reference/sundials/cvode.hpp"
#include "reference/sundials/ida.hpp"
#include "reference/sundials/multirate.hpp"
#include "solver/base/registry.hpp"

namespace drape::reference {
namespace {

Trajectory ida_trajectory(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                          const SolveOptions& options) {
  return ida(ode, y0, t0, times, options).trajectory;
}

}  // namespace

std::span<const PeerSolver> peer_solvers() {
  static constexpr PeerSolver table[] = {
      {"cvode-bdf", "CVODE: BDF of orders 1 to 5 with stability limit detection", cvode},
      {"arkode-esdirk", "ARKODE: ESDIRK method of order 5, everything implicit", arkode_esdirk},
      {"arkode-imex", "ARKODE: additive Runge-Kutta pair of order 5 on the split of the thesis", arkode_imex},
      {"ida-bdf", "IDA: BDF of orders 1 to 5 on the residual form, pins as algebraic equations", ida_trajectory},
      {"cvode-adams", "CVODE: Adams-Moulton formulas with functional iteration", cvode_adams, false},
      {"arkode-erk", "ARKODE: explicit Runge-Kutta method of order 5", arkode_erk, false},
      {"arkode-multirate", "ARKODE: multirate method of order 4, K x + D v fast", arkode_multirate, false},
  };
  return table;
}

const PeerSolver& peer_solver(std::string_view name) { return base::find_named(peer_solvers(), "family of solvers", name); }

Trajectory solve_by_either(const PeerSolver& solver, const solver::SplitOde& ode, const solver::State& y0, double t0,
                           std::span<const double> times, SolveOptions options) {
  std::int64_t& fallbacks = ode.work->counter("reference/klu_fallbacks", "motions for which only the exact Jacobian would do");
  try {
    options.newton = &newton_solve("constant-gmres");
    return solver.solve(ode, y0, t0, times, options);
  } catch (const ReferenceError&) {
    ++fallbacks;
    options.newton = &newton_solve("klu");
    return solver.solve(ode, y0, t0, times, options);
  }
}

}  // namespace drape::reference
