#include "solver/stage/auto_policy.hpp"

#include <algorithm>

namespace drape::solver {

std::optional<Jacobian> AutoPolicy::first_matrix() const {
  switch (matrix_) {
    case StageKind::Matrix::newton: return Jacobian::whole;
    case StageKind::Matrix::tension_newton: return Jacobian::tension;
    case StageKind::Matrix::chosen: return newton_stages_ > 0 ? std::optional(Jacobian::tension) : std::nullopt;
    case StageKind::Matrix::constant: break;
  }
  return {};
}

void AutoPolicy::switched() {
  ++switches_;
  newton_stages_ = next_stay_;
  mean_cost_ = most_constant_updates;
  next_stay_ = std::min(2 * next_stay_, longest_stay);
}

void AutoPolicy::ended(int updates, int renewals) {
  if (newton_stages_ == 0) return;
  const int cost = update_cost * updates + renewal_cost * renewals;
  mean_cost_ += newest_weight * (cost - mean_cost_);
  if (--newton_stages_ == 0 && mean_cost_ < cheap) newton_stages_ = next_stay_;
}

}  // namespace drape::solver
