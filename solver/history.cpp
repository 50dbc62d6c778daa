#include "solver/history.hpp"

#include <algorithm>

namespace drape::solver {

void History::push(double t, const State& y) {
  if (points_ == 0) return;
  if (kept_.empty()) kept_.assign(points_, {t, y});
  std::rotate(kept_.begin(), kept_.end() - 1, kept_.end());
  kept_.front().t = t;
  kept_.front().y = y;
  size_ = std::min(size_ + 1, points_);
}

void History::restart() { size_ = std::min(size_, 1); }

History::Weights History::weights(double t, int points) const {
  Weights all = Weights::Ones(points);
  for (int k = 0; k < points; ++k)
    for (int j = 0; j < points; ++j)
      if (j != k) all[k] *= (t - time(j)) / (time(k) - time(j));
  return all;
}

void History::extrapolate(double t, Vectors& v, Vectors* x) const {
  const Weights all = weights(t, size());
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
