#include "solver/dense_output.hpp"

#include <utility>

namespace drape::solver {

State state_within(double t, double t0, const State& y0, double t1, const State& y1) {
  const double h = t1 - t0, s = (t - t0) / h, r = 1 - s;
  return {r * r * (1 + 2 * s) * y0.x + s * s * (1 + 2 * r) * y1.x + h * s * r * (r * y0.v - s * y1.v),
          6 * s * r / h * (y1.x - y0.x) + r * (1 - 3 * s) * y0.v + s * (1 - 3 * r) * y1.v};
}

DenseOutput::DenseOutput(std::span<const double> times, double t0, State y0) : times_(times), t_(t0), before_(std::move(y0)) {}

void DenseOutput::see(double t, const State& y) {
  const double same = 1e-9 * (t - t_);  // round-off, not intention
  while (states.size() < times_.size() && times_[states.size()] <= t + same) {
    const double at = times_[states.size()];
    states.push_back(at >= t - same ? y : state_within(at, t_, before_, t, y));
  }
  t_ = t;
  before_ = y;
}

}  // namespace drape::solver
