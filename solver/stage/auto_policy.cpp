#include "solver/stage/auto_policy.hpp"

#include <algorithm>

namespace drape::solver {

void AutoPolicy::switched() {
  ++switches_;
  newton_stages_ = next_stay_;
  mean_cost_ = most_constant_updates;
  next_stay_ = std::min(2 * next_stay_, longest_stay);
}

void AutoPolicy::ended(int updates, int renewals) {
  if (newton_stages_ == 0) return;
  const int cost = update_cost * updates + renewal_cost * renewals;
  mean_cost_ += 0.2 * (cost - mean_cost_);
  if (--newton_stages_ == 0 && mean_cost_ < cheap) newton_stages_ = next_stay_;
}

}  // namespace drape::solver
