#include "bench/strips/programs/cvode.hpp"

#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>
#include <nvector/nvector_parallel.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "bench/strips/programs/pfmg.hpp"
#include "bench/strips/programs/processes.hpp"
#include "reference/sundials/session.hpp"
#include "solver/stage/stage_system.hpp"

namespace drape::bench::strips {
namespace {

using reference::sundials_tools::Memory;
using reference::sundials_tools::Owned;
using reference::sundials_tools::require_created;
using reference::sundials_tools::Session;
using solver::State;
using solver::Vectors;

/// What CVODE asks of a strip. Its vectors hold own positions, then own velocities.
class Equation {
 public:
  explicit Equation(const Strip& strip)
      : strip_(strip), linear_solver_(pfmg(strip)), y_(strip.start()), a_(y_.x), system_(strip.ode(), options(), nullptr) {}

  Session& session() { return session_; }

  sunindextype unknowns() const { return 6 * strip_.rows(); }

  void put(const State& y, N_Vector vector) const {
    double* const data = N_VGetArrayPointer(vector);
    own(data) = y.x.middleRows(strip_.first_row(), strip_.rows());
    own(data + 3 * strip_.rows()) = y.v.middleRows(strip_.first_row(), strip_.rows());
  }

  void take(N_Vector vector, State& y) const {
    double* const data = N_VGetArrayPointer(vector);
    y.x.middleRows(strip_.first_row(), strip_.rows()) = own(data);
    y.v.middleRows(strip_.first_row(), strip_.rows()) = own(data + 3 * strip_.rows());
  }

  static int derivative(double t, N_Vector y, N_Vector dy, void* self) {
    const auto [equation, session] = parts(self);
    return session.guarded([&] {
      equation.take(y, equation.y_);
      equation.strip_.acceleration(t, equation.y_, equation.a_);
      equation.put({equation.y_.v, equation.a_}, dy);
    });
  }

  static int prepare(double, N_Vector, N_Vector, int, int* renewed, double gamma, void* self) {
    const auto [equation, session] = parts(self);
    *renewed = SUNTRUE;
    return session.guarded([&] { return equation.system_.prepare(gamma, 1) == solver::Outcome::success; });
  }

  /// A v = M r_v + γ K r_x,   x = r_x + γ v
  static int precondition(double, N_Vector, N_Vector, N_Vector r, N_Vector z, double gamma, double, int, void* self) {
    const auto [equation, session] = parts(self);
    return session.guarded([&] {
      State& y = equation.y_;
      equation.take(r, y);
      equation.strip_.exchange(y.x);
      const solver::LinearResult solved = equation.system_.respond(y, 0, 0);
      y.v = equation.system_.correction();
      y.x += gamma * y.v;
      equation.put(y, z);
      return solved.outcome == solver::Outcome::success;
    });
  }

 private:
  struct Parts {
    Equation& equation;
    Session& session;
  };
  static Parts parts(void* self) {
    auto& equation = *static_cast<Equation*>(self);
    return {equation, equation.session_};
  }

  Eigen::Map<Vectors> own(double* data) const { return {data, strip_.rows(), 3}; }

  solver::Options options() const {
    solver::Options options;
    options.linear_solver = &linear_solver_;
    return options;
  }

  const Strip& strip_;
  Session session_{"CVODE"};
  const solver::LinearSolver linear_solver_;
  State y_;
  Vectors a_;
  solver::StageSystem system_;
};

}  // namespace

State run_cvode(const Strip& strip, const Problem& problem, const std::function<void()>& between) {
  const bool stiff = problem.method == "cvode-bdf";
  Equation equation(strip);
  Session& session = equation.session();
  const Owned<N_Vector> y(require_created(N_VNew_Parallel(
      MPI_COMM_WORLD, equation.unknowns(), static_cast<sunindextype>(6) * strip.columns() * strip.lines(), session.context())));
  equation.put(strip.start(), y.get());
  Memory memory(require_created(CVodeCreate(stiff ? CV_BDF : CV_ADAMS, session.context())),
                [](void* cvode) { CVodeFree(&cvode); });
  const auto require = [&](int flag) { session.require(flag, CVodeGetReturnFlagName); };
  void* const cvode = memory.get();
  require(CVodeSetErrHandlerFn(cvode, Session::on_error, &session));
  require(CVodeInit(cvode, Equation::derivative, strip.begin(), y.get()));
  require(CVodeSetUserData(cvode, &equation));
  require(CVodeSStolerances(cvode, problem.tolerance, problem.tolerance));
  constexpr int most_steps = 1'000'000;
  require(CVodeSetMaxNumSteps(cvode, most_steps));
  Owned<SUNLinearSolver> gmres;
  Owned<SUNNonlinearSolver> functional;
  if (stiff) {
    constexpr int dimension = 10;
    gmres.reset(require_created(SUNLinSol_SPGMR(y.get(), SUN_PREC_LEFT, dimension, session.context())));
    require(CVodeSetLinearSolver(cvode, gmres.get(), nullptr));
    require(CVodeSetPreconditioner(cvode, Equation::prepare, Equation::precondition));
  } else {
    functional.reset(require_created(SUNNonlinSol_FixedPoint(y.get(), 0, session.context())));
    require(CVodeSetNonlinearSolver(cvode, functional.get()));
  }
  for (int k = 1; k <= problem.steps; ++k) {
    double reached = 0;
    require(CVode(cvode, strip.begin() + k * problem.step, y.get(), &reached, CV_NORMAL));
    between();
  }
  reference::sundials_tools::add_counts({{CVodeGetNumSteps, "cvode/steps", "steps of CVODE"}}, cvode, *strip.ode().work);
  State end = strip.start();
  equation.take(y.get(), end);
  return end;
}

}  // namespace drape::bench::strips
