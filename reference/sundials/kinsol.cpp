#include "reference/sundials/kinsol.hpp"

#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <algorithm>
#include <limits>

#include "reference/sundials/coordinates.hpp"
#include "reference/sundials/session.hpp"
#include "solver/filter.hpp"

namespace drape::reference {
namespace {

using namespace sundials_tools;
using solver::SparseMatrix;
using solver::Vectors;

auto values(N_Vector vector) { return Eigen::Map<Eigen::VectorXd>(N_VGetArrayPointer(vector), N_VGetLength(vector)); }

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

  /// Error of the forces by rounding of the positions [N], the lower limit of tolerances.
  double round_off() {
    const WideSparseMatrix J = jacobian(y_.get()).cwiseAbs();
    const Eigen::VectorXd row_sums = J * Eigen::VectorXd::Ones(J.cols());
    return std::numeric_limits<double>::epsilon() * row_sums.maxCoeff() * guess_.cwiseAbs().maxCoeff();
  }

  void force(N_Vector u, N_Vector f) const;
  WideSparseMatrix jacobian(N_Vector u) const;

  /// Fills a matrix of KINSOL, whose indices it has cleared; has KLU analyse it if its pattern is new.
  void copy(const WideSparseMatrix& from, SUNMatrix to);

  static int force(N_Vector u, N_Vector f, void* self) {
    auto& kinsol = *static_cast<Kinsol*>(self);
    return kinsol.session_.guarded([&] { kinsol.force(u, f); });
  }
  static int jacobian(N_Vector u, N_Vector, SUNMatrix J, void* self, N_Vector, N_Vector) {
    auto& kinsol = *static_cast<Kinsol*>(self);
    return kinsol.session_.guarded([&] { kinsol.copy(kinsol.jacobian(u), J); });
  }

  const solver::SplitOde& ode_;
  const Vectors& guess_;
  const Vectors at_rest_;
  Coordinates coordinates_;
  const int strategy_;
  Session session_;
  Owned<N_Vector> y_;
  Owned<SUNMatrix> matrix_;
  Owned<SUNLinearSolver> linear_solver_;
  WideSparseMatrix pattern_;  ///< what KLU has analysed; only its pattern is used
  Memory memory_;
};

Kinsol::Kinsol(const solver::SplitOde& ode, const Vectors& guess, const EquilibriumOptions& options)
    : ode_(ode),
      guess_(guess),
      at_rest_(Vectors::Zero(ode.particles(), 3)),
      coordinates_(ode),
      strategy_(options.line_search ? KIN_LINESEARCH : KIN_NONE),
      session_("KINSOL"),
      y_(require_created(N_VNew_Serial(std::ssize(coordinates_.free), session_.context()))),
      matrix_(require_created(SUNSparseMatrix(N_VGetLength(y_.get()), N_VGetLength(y_.get()), N_VGetLength(y_.get()), CSR_MAT,
                                              session_.context()))),
      linear_solver_(require_created(SUNLinSol_KLU(y_.get(), matrix_.get(), session_.context()))),
      memory_(require_created(KINCreate(session_.context())), [](void* memory) { KINFree(&memory); }) {
  if (!solver::ObliquePins(ode.pins).empty())
    throw std::invalid_argument("an equilibrium: expected pins along axes, not along a direction of their own");
  for (std::size_t r = 0; r < coordinates_.free.size(); ++r)
    values(y_.get())[Eigen::Index(r)] = guess.data()[coordinates_.free[r]];
  void* const kinsol = memory_.get();
  require(KINSetErrHandlerFn(kinsol, Session::on_error, &session_));
  require(KINInit(kinsol, force, y_.get()));
  require(KINSetUserData(kinsol, this));
  require(KINSetFuncNormTol(kinsol, std::max(options.force, round_off())));
  require(KINSetScaledStepTol(kinsol, options.step));
  require(KINSetNumMaxIters(kinsol, options.max_iterations));
  require(KINSetMaxSetupCalls(kinsol, 1));  // Newton, not a chord method
  require(KINSetLinearSolver(kinsol, linear_solver_.get(), matrix_.get()), KINGetLinReturnFlagName);
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

void Kinsol::copy(const WideSparseMatrix& from, SUNMatrix to) {
  const auto n = from.rows(), entries = from.nonZeros();
  const bool known = pattern_.nonZeros() == entries &&
                     std::equal(from.outerIndexPtr(), from.outerIndexPtr() + n + 1, pattern_.outerIndexPtr()) &&
                     std::equal(from.innerIndexPtr(), from.innerIndexPtr() + entries, pattern_.innerIndexPtr());
  if (!known) {
    if (SUNSparseMatrix_Reallocate(to, entries) != 0) throw std::bad_alloc();
    SUNLinSol_KLUReInit(linear_solver_.get(), to, entries, SUNKLU_REINIT_PARTIAL);
    pattern_ = from;
  }
  std::copy_n(from.outerIndexPtr(), n + 1, SUNSparseMatrix_IndexPointers(to));
  std::copy_n(from.innerIndexPtr(), entries, SUNSparseMatrix_IndexValues(to));
  std::copy_n(from.valuePtr(), entries, SUNSparseMatrix_Data(to));
}

Equilibrium Kinsol::solve() {
  const auto ones = clone(y_);
  values(ones.get()).setOnes();
  require(KINSol(memory_.get(), y_.get(), strategy_, ones.get(), ones.get()));
  long iterations = 0;
  require(KINGetNumNonlinSolvIters(memory_.get(), &iterations));
  ode_.work->counter("kinsol/iterations", "Newton iterations of KINSOL") += iterations;
  const auto f = clone(y_);
  force(y_.get(), f.get());
  return {positions(y_.get()), values(f.get()).cwiseAbs().maxCoeff(), static_cast<int>(iterations)};
}

}  // namespace

Equilibrium equilibrium(const solver::SplitOde& ode, const Vectors& guess, const EquilibriumOptions& options) {
  return Kinsol(ode, guess, options).solve();
}

}  // namespace drape::reference
