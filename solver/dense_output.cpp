#include "solver/dense_output.hpp"

#include <utility>

namespace drape::solver {

State state_within(double t, double t0, const State& y0, double t1, const State& y1) {
  const double h = t1 - t0, s = (t - t0) / h, r = 1 - s;
  State y{r * r * (1 + 2 * s) * y0.x + s * s * (1 + 2 * r) * y1.x + h * s * r * (r * y0.v - s * y1.v),
          6 * s * r / h * (y1.x - y0.x) + r * (1 - 3 * s) * y0.v + s * (1 - 3 * r) * y1.v};
  if (y0.z.size() == y1.z.size()) y.z = r * y0.z + s * y1.z;
  return y;
}

DenseOutput::DenseOutput(std::span<const double> times, double t0, State y0) : times_(times), t_(t0), before_(std::move(y0)) {}

void DenseOutput::observe(double t, const State& y) {
  const double same = 1e-9 * (t - t_);  // round-off, not intention
  while (states.size() < times_.size() && times_[states.size()] <= t + same) {
    const double at = times_[states.size()];
    states.push_back(at >= t - same ? y : state_within(at, t_, before_, t, y));
  }
  t_ = t;
  before_ = y;
}

void SmoothOutput::observe(double t, const State& y) {
  const double same = 1e-9 * (t - last_.back().t);
  if (last_.size() == 3) last_.erase(last_.begin());
  last_.push_back({t, y});
  while (positions.size() < times_.size() && times_[positions.size()] <= t + same)
    positions.push_back(positions_at(times_[positions.size()]));
}

/// Divided differences; every end is a double node   [Hairer, Nørsett, Wanner 1993, II.1]
Vectors SmoothOutput::positions_at(double t) const {
  const auto node = [&](std::size_t k) { return last_[k / 2].t; };
  std::vector<Vectors> divided;
  for (std::size_t k = 0; k < 2 * last_.size(); ++k) divided.push_back(last_[k / 2].y.x);
  for (std::size_t j = 1; j < divided.size(); ++j)
    for (std::size_t k = divided.size(); k-- > j;)
      if (k / 2 == (k - j) / 2)
        divided[k] = last_[k / 2].y.v;
      else
        divided[k] = (divided[k] - divided[k - 1]) / (node(k) - node(k - j));
  Vectors x = divided.back();
  for (std::size_t k = divided.size() - 1; k-- > 0;) x = x * (t - node(k)) + divided[k];
  return x;
}

}  // namespace drape::solver
