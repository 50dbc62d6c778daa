#include "solver/history.hpp"

#include <algorithm>

namespace drape::solver {

void History::push(double t, const State& y) {
  if (points_ == 0) return;
  if (full())
    std::rotate(kept_.begin(), kept_.begin() + 1, kept_.end());
  else
    kept_.emplace_back();
  kept_.back().t = t;
  kept_.back().y = y;
}

void History::restart() {
  if (size() > 1) kept_.erase(kept_.begin(), kept_.end() - 1);
}

Eigen::VectorXd History::weights(double t, int points) const {
  Eigen::VectorXd all = Eigen::VectorXd::Ones(points);
  for (int k = 0; k < points; ++k)
    for (int j = 0; j < points; ++j)
      if (j != k) all[k] *= (t - time(j)) / (time(k) - time(j));
  return all;
}

void History::extrapolate(double t, Vectors& v, Vectors* x) const {
  const Eigen::VectorXd all = weights(t, size());
  v = all[0] * state(0).v;
  for (int k = 1; k < size(); ++k) v += all[k] * state(k).v;
  if (x == nullptr) return;
  *x = all[0] * state(0).x;
  for (int k = 1; k < size(); ++k) *x += all[k] * state(k).x;
}

double History::remainder(double t) const {
  double product = 1;
  for (int k = 0; k < size(); ++k) product *= (t - time(k)) / (k + 1);
  return product;
}

}  // namespace drape::solver
