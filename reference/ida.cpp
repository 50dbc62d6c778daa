#include "reference/ida.hpp"

#include <fmt/format.h>
#include <ida/ida.h>

#include <cmath>

#include "reference/reduced_newton.hpp"
#include "reference/sparse_rows.hpp"
#include "reference/sundials.hpp"

namespace drape::reference {
namespace {

using namespace sundials_tools;
using solver::SparseMatrix;
using solver::State;
using solver::Vectors;
using ConstVector = Eigen::Ref<const Eigen::VectorXd>;

/// F(t, y, y') = 0 with y = (x, v, λ): 3N + 3N + p numbers.
class ResidualForm {
 public:
  ResidualForm(const solver::SplitOde& ode, const State& start, double t0)
      : ode_(ode), coordinates_(ode), start_(prescribed_start(ode, start)), t0_(t0), n_(3 * ode.particles()) {}

  int size() const { return 2 * n_ + static_cast<int>(coordinates_.pinned.size()); }
  int coordinates() const { return n_; }

  State state(const ConstVector& y) const {
    const auto vectors = [&](int first) { return Eigen::Map<const Vectors>(y.data() + first, n_ / 3, 3); };
    return {vectors(0), vectors(n_)};
  }

  /// N × 3, zero in the free coordinates.
  Vectors reactions(const ConstVector& y) const {
    Vectors all = Vectors::Zero(n_ / 3, 3);
    for (std::size_t k = 0; k < coordinates_.pinned.size(); ++k)
      all.data()[coordinates_.pinned[k]] = y[2 * n_ + Eigen::Index(k)];
    return all;
  }

  /// y and y' at t0, which fulfil all equations.
  void initial(Eigen::Ref<Eigen::VectorXd> y, Eigen::Ref<Eigen::VectorXd> dy) const;

  /// 1 where y' appears, 0 for algebraic unknowns.
  Eigen::VectorXd differential() const;

  void residual(double t, const ConstVector& y, const ConstVector& dy, Eigen::Ref<Eigen::VectorXd> r) const;

  /// ∂F/∂y + c ∂F/∂y', valid until the next call.
  const WideSparseMatrix& jacobian(double t, double c, const ConstVector& y);

  /// z with (∂F/∂y + c ∂F/∂y') z ≈ r, where 1/c is what the reduced matrix was prepared for.
  void solve_reduced(ReducedNewton& newton, double t, const ConstVector& y, const ConstVector& r,
                     Eigen::Ref<Eigen::VectorXd> z) const;

 private:
  Vectors force(double t, const State& s) const;

  /// Hands all entries of the Jacobian to add(row, column, value), in the order in which they are stored.
  template <class Add>
  void for_entries(double c, const Add& add) const;

  const solver::SplitOde& ode_;
  Coordinates coordinates_;
  State start_;
  double t0_;
  int n_;
  SparseMatrix df_dx_, df_dv_;  // kept for their memory
  WideSparseMatrix jacobian_;
};

Vectors ResidualForm::force(double t, const State& s) const {
  Vectors f(n_ / 3, 3);
  ode_.force(t, s.x, s.v, f);
  if (!f.allFinite()) throw std::runtime_error(fmt::format("the force is not finite at t = {} s", t));
  return f;
}

void ResidualForm::initial(Eigen::Ref<Eigen::VectorXd> y, Eigen::Ref<Eigen::VectorXd> dy) const {
  const Vectors f = force(t0_, start_);
  y.head(n_) = start_.x.reshaped<Eigen::RowMajor>();
  y.segment(n_, n_) = dy.head(n_) = start_.v.reshaped<Eigen::RowMajor>();
  dy.tail(size() - n_).setZero();
  for (int i : coordinates_.free) dy[n_ + i] = f.data()[i] / ode_.mass[i / 3];
  for (std::size_t k = 0; k < coordinates_.pinned.size(); ++k) y[2 * n_ + Eigen::Index(k)] = -f.data()[coordinates_.pinned[k]];
}

Eigen::VectorXd ResidualForm::differential() const {
  Eigen::VectorXd id = Eigen::VectorXd::Zero(size());
  for (int i : coordinates_.free) id[i] = id[n_ + i] = 1;
  return id;
}

void ResidualForm::residual(double t, const ConstVector& y, const ConstVector& dy, Eigen::Ref<Eigen::VectorXd> r) const {
  const Vectors f = force(t, state(y));
  for (int i : coordinates_.free) {
    r[i] = dy[i] - y[n_ + i];
    r[n_ + i] = ode_.mass[i / 3] * dy[n_ + i] - f.data()[i];
  }
  for (std::size_t k = 0; k < coordinates_.pinned.size(); ++k) {
    const int i = coordinates_.pinned[k];
    const double w = start_.v.data()[i];
    r[i] = y[i] - start_.x.data()[i] - w * (t - t0_);
    r[n_ + i] = y[n_ + i] - w;
    r[2 * n_ + Eigen::Index(k)] = f.data()[i] + y[2 * n_ + Eigen::Index(k)];
  }
}

template <class Add>
void ResidualForm::for_entries(double c, const Add& add) const {
  const auto add_force_row = [&](int row, int i, double sign, double inertia) {
    for (SparseMatrix::InnerIterator entry(df_dx_, i); entry; ++entry)
      add(row, static_cast<int>(entry.col()), sign * entry.value());
    for_row_with_diagonal(df_dv_, i, [&](int j, double value) { add(row, n_ + j, sign * value + (j == i ? inertia : 0)); });
  };
  for (int i = 0; i < n_; ++i) {
    const bool is_free = coordinates_.unknown[i] >= 0;
    add(i, i, is_free ? c : 1.0);
    if (is_free) add(i, n_ + i, -1.0);
  }
  for (int i = 0; i < n_; ++i) {
    if (coordinates_.unknown[i] >= 0)
      add_force_row(n_ + i, i, -1, c * ode_.mass[i / 3]);
    else
      add(n_ + i, n_ + i, 1.0);
  }
  for (int row = 2 * n_; row < size(); ++row) {
    add_force_row(row, coordinates_.pinned[static_cast<std::size_t>(row - 2 * n_)], 1, 0);
    add(row, row, 1.0);
  }
}

const WideSparseMatrix& ResidualForm::jacobian(double t, double c, const ConstVector& y) {
  const State s = state(y);
  ode_.jacobian(t, s.x, s.v, df_dx_, df_dv_);
  fill(jacobian_, size(), [&](const auto& add) { for_entries(c, add); });
  if (!std::isfinite(jacobian_.coeffs().sum()))
    throw std::runtime_error(fmt::format("the Jacobian is not finite at t = {} s", t));
  return jacobian_;
}

void ResidualForm::solve_reduced(ReducedNewton& newton, double t, const ConstVector& y, const ConstVector& r,
                                 Eigen::Ref<Eigen::VectorXd> z) const {
  const double gamma = newton.gamma();
  const State at = state(y);
  State d = state(r);  // c dx - dv = r_x, c M dv - df = r_v in the free coordinates, dx = r_x, dv = r_v in the pinned ones
  const Vectors rv = d.v;
  for (int i : coordinates_.free) {
    d.x.data()[i] *= gamma;
    d.v.data()[i] = 0;
  }
  const Vectors dv = newton.solve(gamma * (rv + newton.derivative(t, at, d)));
  d.x += gamma * dv;
  d.v += dv;
  z.head(n_) = d.x.reshaped<Eigen::RowMajor>();
  z.segment(n_, n_) = d.v.reshaped<Eigen::RowMajor>();
  if (coordinates_.pinned.empty()) return;
  const Vectors df = newton.derivative(t, at, d);
  for (std::size_t k = 0; k < coordinates_.pinned.size(); ++k)
    z[2 * n_ + Eigen::Index(k)] = r[2 * n_ + Eigen::Index(k)] - df.data()[coordinates_.pinned[k]];
}

/// One integration from t0 to the end. IDA keeps the address of this object.
class Ida {
 public:
  Ida(ResidualForm& form, const solver::SplitOde& ode, double t0, double end, const SolveOptions& options);

  /// y at time t, which must not be before the last one asked for.
  Eigen::VectorXd advance(double t) {
    double reached;
    require(IDASolve(memory_.get(), t, &reached, session_.y(), dy_.get(), IDA_NORMAL));
    return values(session_.y());
  }

  Eigen::VectorXd initial() { return values(session_.y()); }

  void count_work(solver::Work& work) const {
    add_counts({{IDAGetNumSteps, "ida/steps", "steps of IDA"},
                {IDAGetNumJacEvals, "ida/jacobians", "Jacobians evaluated by IDA"},
                {IDAGetNumLinSolvSetups, "ida/factorisations", "factorisations of the Newton matrix"}},
               memory_.get(), work);
  }

 private:
  void require(int flag, FlagName flag_name = IDAGetReturnFlagName) const {
    double reached = 0;
    IDAGetCurrentTime(memory_.get(), &reached);
    session_.require(flag, flag_name, reached);
  }

  static int residual(realtype t, N_Vector y, N_Vector dy, N_Vector r, void* self) {
    auto& ida = *static_cast<Ida*>(self);
    return ida.session_.guarded([&] { ida.form_.residual(t, values(y), values(dy), values(r)); });
  }
  static int jacobian(realtype t, realtype c, N_Vector y, N_Vector, N_Vector, SUNMatrix J, void* self, N_Vector, N_Vector,
                      N_Vector) {
    auto& ida = *static_cast<Ida*>(self);
    return ida.session_.guarded([&] { ida.session_.copy(ida.form_.jacobian(t, c, values(y)), J); });
  }
  static int prepare(realtype t, N_Vector y, N_Vector, N_Vector, realtype c, void* self) {
    auto& ida = *static_cast<Ida*>(self);
    return ida.session_.guarded([&] { return ida.reduced_->prepare(t, ida.form_.state(values(y)), 1 / c); });
  }
  static int precondition(realtype t, N_Vector y, N_Vector, N_Vector, N_Vector r, N_Vector z, realtype, realtype, void* self) {
    auto& ida = *static_cast<Ida*>(self);
    return ida.session_.guarded([&] { ida.form_.solve_reduced(*ida.reduced_, t, values(y), values(r), values(z)); });
  }

  ResidualForm& form_;
  std::optional<ReducedNewton> reduced_;
  Session session_;
  Owned<N_Vector> dy_;
  Memory memory_;
};

Ida::Ida(ResidualForm& form, const solver::SplitOde& ode, double t0, double end, const SolveOptions& options)
    : form_(form),
      session_("IDA", "ida", form.size(), *ode.work, *options.newton),
      dy_(session_.new_vector()),
      memory_(require_created(IDACreate(session_.context())), [](void* memory) { IDAFree(&memory); }) {
  const int n = form.coordinates();
  auto y = values(session_.y());
  form.initial(y, values(dy_.get()));
  const auto atol = session_.new_vector(), differential = session_.new_vector();
  values(atol.get()).head(n).setConstant(options.rtol * options.size);
  values(atol.get()).segment(n, n).setConstant(options.rtol * options.size / (end - t0));
  values(atol.get()).tail(form.size() - 2 * n).setConstant(options.rtol * std::max(1.0, y.tail(form.size() - 2 * n).norm()));
  values(differential.get()) = form.differential();

  void* const ida = memory_.get();
  require(IDASetErrHandlerFn(ida, Session::on_error, &session_));
  require(IDAInit(ida, residual, t0, session_.y(), dy_.get()));
  require(IDASetUserData(ida, this));
  require(IDASVtolerances(ida, options.rtol, atol.get()));
  require(IDASetMaxNumSteps(ida, options.max_steps));
  require(IDASetId(ida, differential.get()));
  require(IDASetSuppressAlg(ida, SUNTRUE));
  require(IDASetStopTime(ida, end));
  require(IDASetMaxOrd(ida, options.max_order));
  require(IDASetLinearSolver(ida, session_.linear_solver(), session_.matrix()), IDAGetLinReturnFlagName);
  if (options.newton->reduced()) {
    reduced_.emplace(ode, options.newton->matrix);
    require(IDASetPreconditioner(ida, prepare, precondition), IDAGetLinReturnFlagName);
  } else {
    require(IDASetJacFn(ida, jacobian), IDAGetLinReturnFlagName);
  }
}

}  // namespace

ConstrainedTrajectory ida(const solver::SplitOde& ode, const State& y0, double t0, std::span<const double> times,
                          const SolveOptions& options) {
  check(times, t0, options);
  ResidualForm form(ode, y0, t0);
  Ida solver(form, ode, t0, times.back(), options);
  ConstrainedTrajectory result{{{times.begin(), times.end()}, {}}, {}};
  for (double t : times) {
    const Eigen::VectorXd y = t == t0 ? solver.initial() : solver.advance(t);
    result.trajectory.states.push_back(form.state(y));
    result.reactions.push_back(form.reactions(y));
  }
  solver.count_work(*ode.work);
  return result;
}

}  // namespace drape::reference
