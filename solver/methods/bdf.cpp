#include <cmath>

#include "solver/methods/starts.hpp"

namespace drape::solver {
namespace {

/// The first steps of BDF(k) are of order 4, so that they do not spoil its own.
void bdf(Step& s, int k) {
  s.starting = s.history.smooth() < k;
  if (s.starting) return s.after_impact ? implicit_euler(s) : esdirk4(s);
  const double t1 = s.t + s.h;
  // dy/dt(t1) ≈ α y1 − Σ α_j y_j of the polynomial through y1 and the last k states
  double alpha = 0;
  for (int j = 0; j < k; ++j) alpha += 1 / (t1 - s.history[j].t);
  const History::Weights weights = s.history.weights(t1, k);
  Vectors &ax = s.scratch.ax, &av = s.scratch.av;
  ax.setZero();
  av.setZero();
  for (int j = 0; j < k; ++j) {
    const double c = weights[j] / ((t1 - s.history[j].t) * alpha);
    ax += c * s.history[j].y.x;
    av += c * s.history[j].y.v;
  }
  double remainder = 1;
  for (int j = 0; j < k; ++j) remainder *= (t1 - s.history[j].t) / (j + 1);
  s.solve({1 / alpha, t1, ax, av}, remainder / (alpha * (k + 1)) / std::pow(s.h, k + 1));
}

}  // namespace

// x1 = Σ c_j x_j + γ v1,   M v1 = M Σ c_j v_j + γ f(t1, x1, v1) with 1/γ = Σ 1/(t1 − t_j) and c_j = γ w_j/(t1 − t_j), where the
// weights w_j extrapolate the last k states to t1   [Curtiss, Hirschfelder 1952, for steps of any size]
void bdf3(Step& s) { bdf(s, 3); }
void bdf4(Step& s) { bdf(s, 4); }
void bdf5(Step& s) { bdf(s, 5); }

}  // namespace drape::solver
