#include "reference/kinsol.hpp"

#include <kinsol/kinsol.h>

#include <algorithm>
#include <limits>

#include "reference/sundials.hpp"

namespace drape::reference {
namespace {

using namespace sundials_tools;
using solver::SparseMatrix;
using solver::Vectors;

/// One search. KINSOL keeps the address of this object.
class Kinsol {
 public:
  Kinsol(const solver::SplitOde& ode, const Vectors& guess, const EquilibriumOptions& options);

  Equilibrium solve();

 private:
  void require(int flag, FlagName flag_name = KINGetReturnFlagName) const { session_.require(flag, flag_name); }

  /// All positions for a vector of the free ones.
  Vectors positions(N_Vector u) const {
    Vectors x = guess_;
    for (std::size_t r = 0; r < coordinates_.free.size(); ++r) x.data()[coordinates_.free[r]] = values(u)[Eigen::Index(r)];
    return x;
  }

  /// What rounding of the positions does to the forces [N]: smaller ones cannot be asked for.
  double round_off() {
    const WideSparseMatrix J = jacobian(session_.y()).cwiseAbs();
    const Eigen::VectorXd row_sums = J * Eigen::VectorXd::Ones(J.cols());
    return std::numeric_limits<double>::epsilon() * row_sums.maxCoeff() * guess_.cwiseAbs().maxCoeff();
  }

  void force(N_Vector u, N_Vector f) const;
  WideSparseMatrix jacobian(N_Vector u) const;

  static int force(N_Vector u, N_Vector f, void* self) {
    auto& kinsol = *static_cast<Kinsol*>(self);
    return kinsol.session_.guarded([&] { kinsol.force(u, f); });
  }
  static int jacobian(N_Vector u, N_Vector, SUNMatrix J, void* self, N_Vector, N_Vector) {
    auto& kinsol = *static_cast<Kinsol*>(self);
    return kinsol.session_.guarded([&] { kinsol.session_.copy(kinsol.jacobian(u), J); });
  }

  const solver::SplitOde& ode_;
  const Vectors& guess_;
  const Vectors at_rest_;
  Coordinates coordinates_;
  const int strategy_;
  Session session_;
  Memory memory_;
};

Kinsol::Kinsol(const solver::SplitOde& ode, const Vectors& guess, const EquilibriumOptions& options)
    : ode_(ode),
      guess_(guess),
      at_rest_(Vectors::Zero(ode.particles(), 3)),
      coordinates_(ode),
      strategy_(options.line_search ? KIN_LINESEARCH : KIN_NONE),
      session_("KINSOL", "kinsol", std::ssize(coordinates_.free), *ode.work),
      memory_(require_created(KINCreate(session_.context())), [](void* memory) { KINFree(&memory); }) {
  for (std::size_t r = 0; r < coordinates_.free.size(); ++r)
    values(session_.y())[Eigen::Index(r)] = guess.data()[coordinates_.free[r]];
  void* const kinsol = memory_.get();
  require(KINSetErrHandlerFn(kinsol, Session::on_error, &session_));
  require(KINInit(kinsol, force, session_.y()));
  require(KINSetUserData(kinsol, this));
  require(KINSetFuncNormTol(kinsol, std::max(options.force, round_off())));
  require(KINSetScaledStepTol(kinsol, options.step));
  require(KINSetNumMaxIters(kinsol, options.max_iterations));
  require(KINSetMaxSetupCalls(kinsol, 1));  // Newton, not a chord method
  require(KINSetLinearSolver(kinsol, session_.linear_solver(), session_.matrix()), KINGetLinReturnFlagName);
  require(KINSetJacFn(kinsol, jacobian), KINGetLinReturnFlagName);
}

void Kinsol::force(N_Vector u, N_Vector f) const {
  Vectors all(ode_.particles(), 3);
  ode_.force(0, positions(u), at_rest_, all);
  if (!all.allFinite()) throw std::runtime_error("the force is not finite");
  for (std::size_t r = 0; r < coordinates_.free.size(); ++r) values(f)[Eigen::Index(r)] = all.data()[coordinates_.free[r]];
}

WideSparseMatrix Kinsol::jacobian(N_Vector u) const {
  SparseMatrix df_dx, df_dv;
  ode_.jacobian(0, positions(u), at_rest_, df_dx, df_dv);
  const auto n = std::ssize(coordinates_.free);
  WideSparseMatrix J(n, n);
  J.reserve(df_dx.nonZeros());
  for (std::int64_t r = 0; r < n; ++r) {
    J.startVec(r);
    for (SparseMatrix::InnerIterator entry(df_dx, coordinates_.free[static_cast<std::size_t>(r)]); entry; ++entry)
      if (const int c = coordinates_.unknown[entry.col()]; c >= 0) J.insertBack(r, c) = entry.value();
  }
  J.finalize();
  if (!J.coeffs().allFinite()) throw std::runtime_error("the Jacobian is not finite");
  return J;
}

Equilibrium Kinsol::solve() {
  const auto ones = session_.new_vector();
  values(ones.get()).setOnes();
  require(KINSol(memory_.get(), session_.y(), strategy_, ones.get(), ones.get()));
  long iterations = 0;
  require(KINGetNumNonlinSolvIters(memory_.get(), &iterations));
  ode_.work->counter("kinsol/iterations", "Newton iterations of KINSOL") += iterations;
  const auto f = session_.new_vector();
  force(session_.y(), f.get());
  return {positions(session_.y()), values(f.get()).cwiseAbs().maxCoeff(), static_cast<int>(iterations)};
}

}  // namespace

Equilibrium equilibrium(const solver::SplitOde& ode, const Vectors& guess, const EquilibriumOptions& options) {
  return Kinsol(ode, guess, options).solve();
}

}  // namespace drape::reference
