#include "solver/stage/lagged_newton.hpp"

#include <cmath>
#include <stdexcept>

namespace drape::solver {
namespace {

constexpr double slow_rate = 0.3;         ///< a matrix that converges slower than this is renewed,
constexpr int patience = 6;               ///< or after this number of updates,
constexpr int most_patience = 12;         ///< even if no update has improved on the first,
constexpr double different_gamma = 0.25;  ///< or if γ differs by more than this part
constexpr int most_renewals = 4;          ///< in a stage; then every update needs a matrix

}  // namespace

LaggedNewton::LaggedNewton(const SplitOde& ode, const Options& options, StageSystem& system)
    : whole_(ode, options, system, Jacobian::whole),
      tension_(ode, options, system, Jacobian::tension),
      search_(ode, options, system) {
  using Matrix = StageKind::Matrix;
  const bool wanted = options.stage->matrix == Matrix::newton || options.stage->matrix == Matrix::tension_newton;
  if (wanted && !ode.newton_matrix) throw std::invalid_argument("stage solver 'newton': expected an ODE with a newton_matrix");
}

void LaggedNewton::begin() {
  matrix_ = nullptr;
  updates_ = renewals_ = 0;
}

bool LaggedNewton::choose(Jacobian part, double gamma) {
  matrix_ = &system(part);
  return !matrix_->empty() && std::abs(matrix_->gamma() / gamma - 1) <= different_gamma;
}

Outcome LaggedNewton::renew(const Stage& stage, State& y) {
  updates_ = 0;
  ++renewals_;
  y.x = stage.ax + stage.gamma * y.v;
  return matrix_->renew(stage, y);
}

bool LaggedNewton::stagnates(double rate, bool improved) const {
  if (!in_use()) return false;
  const bool slow = improved && (updates_ >= patience || (updates_ > 2 && rate > slow_rate));
  return slow || updates_ > most_patience;
}

bool LaggedNewton::exhausted() const { return renewals_ >= most_renewals; }

void LaggedNewton::search(const Stage& stage, const Vectors& guess, State& y, StageResult& result) {
  const int updates = result.updates;
  search_.solve(stage, guess, whole_, y, result);
  renewals_ += result.updates - updates;
}

}  // namespace drape::solver
