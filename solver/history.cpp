#include "solver/history.hpp"

#include <algorithm>
#include <utility>

namespace drape::solver {

History::History(int points, int forces, const Point& first) : points_(points), forces_(forces) {
  for (int k = 0; k < points; ++k) kept_.push_back(k < forces ? first : Point{first.t, first.y, {}, false});
}

void History::push(Point& next, double h) {
  std::rotate(kept_.begin(), kept_.end() - 1, kept_.end());
  std::swap(kept_.front(), next);
  if (forces_ < points_) {  // reuses the memory of the force that is not kept any longer
    std::swap(kept_[forces_].f, next.f);
    kept_[forces_].has_f = false;
  }
  last_step_ = h;
  size_ = std::min(size_ + 1, points_);
  smooth_ = std::min(smooth_ + 1, points_);
}

void History::restart() {
  size_ = smooth_ = 1;
  last_step_ = 0;
}

History::Weights History::weights(double t, int points) const {
  Weights all = Weights::Ones(points);
  for (int k = 0; k < points; ++k)
    for (int j = 0; j < points; ++j)
      if (j != k) all[k] *= (t - kept_[j].t) / (kept_[k].t - kept_[j].t);
  return all;
}

void History::extrapolate(double t, Vectors& v, Vectors* x) const {
  const Weights all = weights(t, smooth());
  v = all[0] * kept_[0].y.v;
  for (int k = 1; k < smooth(); ++k) v += all[k] * kept_[k].y.v;
  if (x == nullptr) return;
  *x = all[0] * kept_[0].y.x;
  for (int k = 1; k < smooth(); ++k) *x += all[k] * kept_[k].y.x;
}

double History::remainder(double t) const {
  double product = 1;
  for (int k = 0; k < smooth(); ++k) product *= (t - kept_[k].t) / (k + 1);
  return product;
}

}  // namespace drape::solver
