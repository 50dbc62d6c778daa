#include "reference/sundials/ida.hpp"

#include <fmt/format.h>
#include <ida/ida.h>

#include <cmath>

#include "reference/sundials/reduced_newton.hpp"
#include "reference/sundials/session.hpp"
#include "reference/sundials/sparse_rows.hpp"
#include "solver/filter.hpp"
#include "solver/linear/klu_factor.hpp"

namespace drape::reference {
namespace {

using namespace sundials_tools;
using solver::SparseMatrix;
using solver::State;
using solver::Vectors;

/// F(t, y, y') = 0 with y = (x, v, λ): 3N + 3N + p numbers.
class ResidualForm {
 public:
  ResidualForm(const solver::SplitOde& ode, const State& start, double t0)
      : ode_(ode),
        coordinates_(ode),
        start_(prescribed_start(ode, start)),
        t0_(t0),
        n_(3 * ode.particles()),
        oblique_(ode.pins) {
    if (!oblique_.empty()) free_ = oblique_.matrix(ode.particles());
    force_ = right_ = Vectors::Zero(ode.particles(), 3);
  }

  int size() const { return 2 * n_ + static_cast<int>(coordinates_.pinned.size()); }

  /// N × 3, zero in the free coordinates, those of oblique pins among them.
  Vectors reactions(const StateVector& y) const {
    Vectors all = Vectors::Zero(n_ / 3, 3);
    for (std::size_t k = 0; k < coordinates_.pinned.size(); ++k)
      all.data()[coordinates_.pinned[k]] = y.reactions[Eigen::Index(k)];
    return all;
  }

  /// y and y' at t0, which fulfil all equations.
  StateVector initial();
  StateVector initial_derivative();

  /// 1 where y' appears, 0 for algebraic unknowns.
  StateVector differential() const;

  void residual(double t, const StateVector& y, const StateVector& dy, StateVector& r);

  /// ∂F/∂y + c ∂F/∂y', valid until the next call.
  const WideSparseMatrix& jacobian(double t, double c, const State& y);

  /// z with (∂F/∂y + c ∂F/∂y') z ≈ r, where 1/c is the γ of the reduced matrix.
  void solve_reduced(ReducedNewton& newton, double t, const State& y, const StateVector& r, StateVector& z);

 private:
  StateVector zero() const;
  const Vectors& force(double t, const State& y);

  /// Hands all entries of the Jacobian to add(row, column, value), in the order in which they are stored.
  template <class Add>
  void for_entries(double c, const Add& add) const;

  const solver::SplitOde& ode_;
  Coordinates coordinates_;
  State start_;
  double t0_;
  int n_;
  solver::ObliquePins oblique_;
  SparseMatrix free_;                     ///< their projector; empty without any
  SparseMatrix df_dx_, df_dv_;            // kept for their memory
  SparseMatrix free_df_dx_, free_df_dv_;  ///< of what the equation of motion has of the forces
  WideSparseMatrix jacobian_;
  Vectors force_, free_force_, right_;
};

const Vectors& ResidualForm::force(double t, const State& y) {
  ode_.force(t, y.x, y.v, force_);
  if (!std::isfinite(force_.sum())) throw std::runtime_error(fmt::format("the force is not finite at t = {} s", t));
  return force_;
}

StateVector ResidualForm::zero() const {
  const Vectors none = Vectors::Zero(n_ / 3, 3);
  return {{none, none}, Eigen::VectorXd::Zero(std::ssize(coordinates_.pinned)), 2 * std::ssize(coordinates_.free)};
}

StateVector ResidualForm::initial() {
  StateVector y = zero();
  y.state = start_;
  const Vectors& f = force(t0_, start_);
  for (std::size_t k = 0; k < coordinates_.pinned.size(); ++k) y.reactions[Eigen::Index(k)] = -f.data()[coordinates_.pinned[k]];
  return y;
}

StateVector ResidualForm::initial_derivative() {
  StateVector dy = zero();
  dy.state.x = start_.v;
  dy.state.v = ode_.mass.cwiseInverse().asDiagonal() * force(t0_, start_);
  solver::filter(ode_.pins, dy.state.v);
  return dy;
}

StateVector ResidualForm::differential() const {
  StateVector id = zero();
  id.state.x.setOnes();
  for (const int i : coordinates_.pinned) id.state.x.data()[i] = 0;
  id.state.v = id.state.x;
  return id;
}

void ResidualForm::residual(double t, const StateVector& y, const StateVector& dy, StateVector& r) {
  const Vectors& f = force(t, y.state);
  r.state.x = dy.state.x - y.state.v;
  if (oblique_.empty()) {
    r.state.v = ode_.mass.asDiagonal() * dy.state.v - f;
  } else {
    free_force_ = f;
    oblique_(free_force_);
    r.state.v = ode_.mass.asDiagonal() * dy.state.v - free_force_;
  }
  for (std::size_t k = 0; k < coordinates_.pinned.size(); ++k) {
    const int i = coordinates_.pinned[k];
    const double w = start_.v.data()[i];
    r.state.x.data()[i] = y.state.x.data()[i] - start_.x.data()[i] - w * (t - t0_);
    r.state.v.data()[i] = y.state.v.data()[i] - w;
    r.reactions[Eigen::Index(k)] = f.data()[i] + y.reactions[Eigen::Index(k)];
  }
}

template <class Add>
void ResidualForm::for_entries(double c, const Add& add) const {
  const auto add_force_row = [&](const SparseMatrix& dx, const SparseMatrix& dv, int row, int i, double sign, double inertia) {
    for (SparseMatrix::InnerIterator entry(dx, i); entry; ++entry)
      add(row, static_cast<int>(entry.col()), sign * entry.value());
    for_row_with_diagonal(dv, i, [&](int j, double value) { add(row, n_ + j, sign * value + (j == i ? inertia : 0)); });
  };
  const SparseMatrix &free_dx = oblique_.empty() ? df_dx_ : free_df_dx_, &free_dv = oblique_.empty() ? df_dv_ : free_df_dv_;
  for (int i = 0; i < n_; ++i) {
    const bool is_free = coordinates_.unknown[i] >= 0;
    add(i, i, is_free ? c : 1.0);
    if (is_free) add(i, n_ + i, -1.0);
  }
  for (int i = 0; i < n_; ++i) {
    if (coordinates_.unknown[i] >= 0)
      add_force_row(free_dx, free_dv, n_ + i, i, -1, c * ode_.mass[i / 3]);
    else
      add(n_ + i, n_ + i, 1.0);
  }
  for (int row = 2 * n_; row < size(); ++row) {
    add_force_row(df_dx_, df_dv_, row, coordinates_.pinned[static_cast<std::size_t>(row - 2 * n_)], 1, 0);
    add(row, row, 1.0);
  }
}

const WideSparseMatrix& ResidualForm::jacobian(double t, double c, const State& y) {
  ode_.jacobian(t, y.x, y.v, df_dx_, df_dv_);
  if (!oblique_.empty()) free_df_dx_ = free_ * df_dx_, free_df_dv_ = free_ * df_dv_;
  fill(jacobian_, size(), [&](const auto& add) { for_entries(c, add); });
  if (!std::isfinite(jacobian_.coeffs().sum()))
    throw std::runtime_error(fmt::format("the Jacobian is not finite at t = {} s", t));
  return jacobian_;
}

void ResidualForm::solve_reduced(ReducedNewton& newton, double t, const State& y, const StateVector& r, StateVector& z) {
  const double gamma = newton.gamma();
  const auto f = [&]() -> const Vectors& { return force(t, y); };
  State& d = z.state;  // c dx - dv = r_x, c M dv - df = r_v in the free coordinates, dx = r_x, dv = r_v in the pinned ones
  d.x = gamma * r.state.x;
  d.v.setZero();
  for (const int i : coordinates_.pinned) {
    d.x.data()[i] = r.state.x.data()[i];
    d.v.data()[i] = r.state.v.data()[i];
  }
  Vectors& df = right_;
  newton.derivative(t, y, f, d.x, &d.v, df);
  df = gamma * (r.state.v + df);
  const Vectors& dv = newton.solve(df);
  d.x += gamma * dv;
  d.v += dv;
  if (coordinates_.pinned.empty()) return;
  newton.derivative(t, y, f, d.x, &d.v, df);
  for (std::size_t k = 0; k < coordinates_.pinned.size(); ++k)
    z.reactions[Eigen::Index(k)] = r.reactions[Eigen::Index(k)] - df.data()[coordinates_.pinned[k]];
}

/// All numbers one after another, as in the Jacobian.
Eigen::VectorXd joined(const StateVector& y) {
  Eigen::VectorXd all(y.state.x.size() + y.state.v.size() + y.reactions.size());
  all << y.state.x.reshaped<Eigen::RowMajor>(), y.state.v.reshaped<Eigen::RowMajor>(), y.reactions;
  return all;
}

void separate(const Eigen::VectorXd& all, StateVector& y) {
  const auto n = y.state.x.size();
  y.state.x.reshaped<Eigen::RowMajor>() = all.head(n);
  y.state.v.reshaped<Eigen::RowMajor>() = all.segment(n, n);
  y.reactions = all.tail(y.reactions.size());
}

/// One integration from t0 to the end. IDA keeps the address of this object.
class Ida {
 public:
  Ida(ResidualForm& form, const solver::SplitOde& ode, double t0, double end, const SolveOptions& options);

  /// y at time t, which must not be before that of the last call.
  const StateVector& advance(double t) {
    double reached;
    require(IDASolve(memory_.get(), t, &reached, y_.get(), dy_.get(), IDA_NORMAL));
    return content(y_.get());
  }

  const StateVector& initial() { return content(y_.get()); }

  void count_work(solver::Counters& work) const {
    add_counts({{IDAGetNumSteps, "ida/steps", "steps of IDA"},
                {IDAGetNumLinSolvSetups, "ida/factorisations", "factorisations of the Newton matrix"}},
               memory_.get(), work);
  }

 private:
  Owned<N_Vector> vector(StateVector content) {
    return Owned<N_Vector>(require_created(make_state_vector(std::move(content), session_.context())));
  }

  Owned<N_Vector> absolute_tolerances(double duration, const SolveOptions& options) {
    StateVector atol = content(y_.get());
    const double largest_force = std::max(1.0, atol.reactions.norm());
    atol.state.x.setConstant(options.rtol * options.size);
    atol.state.v.setConstant(options.rtol * options.size / duration * options.tuning.velocity_weight);
    atol.reactions.setConstant(options.rtol * largest_force);
    return vector(std::move(atol));
  }

  bool prepare(double t, double c, const State& y) {
    if (reduced_) return reduced_->prepare(t, y, 1 / c);
    ++jacobians_;
    prepared_for_ = c;
    return klu_->factor(form_.jacobian(t, c, y));
  }

  void solve(double t, double c, const State& y, const StateVector& r, StateVector& z) {
    if (reduced_) return form_.solve_reduced(*reduced_, t, y, r, z);
    Eigen::VectorXd all = joined(r);
    klu_->solve(all);
    separate(2 / (1 + c / prepared_for_) * all, z);  // as IDA does for a matrix that was factored for another c
  }

  void require(int flag, FlagName flag_name = IDAGetReturnFlagName) const {
    double reached = 0;
    IDAGetCurrentTime(memory_.get(), &reached);
    session_.require(flag, flag_name, reached);
  }

  static int residual(realtype t, N_Vector y, N_Vector dy, N_Vector r, void* self) {
    auto& ida = *static_cast<Ida*>(self);
    return ida.session_.guarded([&] { ida.form_.residual(t, content(y), content(dy), content(r)); });
  }
  static int prepare(realtype t, N_Vector y, N_Vector, N_Vector, realtype c, void* self) {
    auto& ida = *static_cast<Ida*>(self);
    return ida.session_.guarded([&] { return ida.prepare(t, c, state(y)); });
  }
  static int precondition(realtype t, N_Vector y, N_Vector, N_Vector, N_Vector r, N_Vector z, realtype c, realtype,
                          void* self) {
    auto& ida = *static_cast<Ida*>(self);
    return ida.session_.guarded([&] { ida.solve(t, c, state(y), content(r), content(z)); });
  }

  ResidualForm& form_;
  std::optional<ReducedNewton> reduced_;
  std::optional<solver::KluFactor> klu_;
  std::int64_t& jacobians_;
  double prepared_for_ = 1;
  Session session_;
  Owned<N_Vector> y_, dy_;
  Owned<SUNLinearSolver> linear_solver_;
  Memory memory_;
};

Ida::Ida(ResidualForm& form, const solver::SplitOde& ode, double t0, double end, const SolveOptions& options)
    : form_(form),
      jacobians_(ode.work->counter("ida/jacobians", "exact Jacobians evaluated")),
      session_("IDA"),
      y_(vector(form.initial())),
      dy_(vector(form.initial_derivative())),
      linear_solver_(make_linear_solver(*options.newton, y_.get(), session_.context())),
      memory_(require_created(IDACreate(session_.context())), [](void* memory) { IDAFree(&memory); }) {
  auto& analyses = ode.work->counter("ida/analyses", "symbolic analyses of the Newton matrix by KLU");
  if (options.newton->reduced())
    reduced_.emplace(ode, options.newton->matrix, options.tuning.kept_factor);
  else
    klu_.emplace(analyses);
  const auto atol = absolute_tolerances(end - t0, options), differential = vector(form.differential());

  void* const ida = memory_.get();
  require(IDASetErrHandlerFn(ida, Session::on_error, &session_));
  require(IDAInit(ida, residual, t0, y_.get(), dy_.get()));
  require(IDASetUserData(ida, this));
  require(IDASVtolerances(ida, options.rtol, atol.get()));
  require(IDASetMaxNumSteps(ida, options.max_steps));
  require(IDASetId(ida, differential.get()));
  require(IDASetSuppressAlg(ida, SUNTRUE));
  require(IDASetStopTime(ida, end));
  require(IDASetMaxOrd(ida, options.max_order));
  if (options.tuning.nonlinear > 0) require(IDASetNonlinConvCoef(ida, options.tuning.nonlinear));
  if (options.tuning.max_iterations > 0) require(IDASetMaxNonlinIters(ida, options.tuning.max_iterations));
  require(IDASetLinearSolver(ida, linear_solver_.get(), nullptr), IDAGetLinReturnFlagName);
  require(IDASetPreconditioner(ida, prepare, precondition), IDAGetLinReturnFlagName);
}

}  // namespace

ConstrainedTrajectory ida(const solver::SplitOde& ode, const State& y0, double t0, std::span<const double> times,
                          const SolveOptions& options) {
  check(times, t0, options);
  if (ode.memory) throw ReferenceError("IDA: expected forces without internal variables", "memory", t0);
  ResidualForm form(ode, y0, t0);
  Ida solver(form, ode, t0, times.back(), options);
  ConstrainedTrajectory result{{{times.begin(), times.end()}, {}}, {}};
  for (double t : times) {
    const StateVector& y = t == t0 ? solver.initial() : solver.advance(t);
    result.trajectory.states.push_back(y.state);
    result.reactions.push_back(form.reactions(y));
  }
  solver.count_work(*ode.work);
  return result;
}

}  // namespace drape::reference
