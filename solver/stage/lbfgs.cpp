#include "solver/stage/lbfgs.hpp"

#include <algorithm>
#include <cmath>

namespace drape::solver {
namespace {

constexpr double inverse_tolerance = 0.02;  ///< of A⁻¹ where it is iterated, over its right-hand side
constexpr double sufficient = 0.3;          ///< part of the first slope by which the energy must fall   [Liu et al. 2017]
constexpr double shorter = 0.5;             ///< part of an update that is tried after one that failed
constexpr int most_searched = 30;           ///< trials along an update

double dot(const Vectors& a, const Vectors& b) { return (a.array() * b.array()).sum(); }

}  // namespace

Lbfgs::Lbfgs(const SplitOde& ode, const Options& options, StageSystem& system) : StageIteration(ode, options, system) {
  for (Vectors* field : {&from_, &r_, &q_, &d_}) field->setZero(ode.particles(), 3);
  for (Pair& pair : pairs_)
    for (Vectors* field : {&pair.step, &pair.fall}) field->setZero(ode.particles(), 3);
}

void Lbfgs::begin(const State&) { count_ = 0; }

double Lbfgs::slope() const { return dot(system().residual(), d_); }

/// d = H r by the two loops   [Nocedal 1980].
LinearResult Lbfgs::find_direction() {
  q_ = system().residual();
  for (int age = 0; age < kept(); ++age) {
    const Pair& pair = newest(age);
    parts_[age] = dot(pair.step, q_) / pair.curvature;
    q_ -= parts_[age] * pair.fall;
  }
  const LinearResult solved = system().respond(q_, inverse_tolerance);
  d_ = system().correction();
  for (int age = kept(); age-- > 0;) {
    const Pair& pair = newest(age);
    d_ += (parts_[age] - dot(pair.fall, d_) / pair.curvature) * pair.step;
  }
  return solved;
}

/// Adds the part of d along which the energy falls enough, and evaluates the residual there; false if none is found.
bool Lbfgs::follow(const Stage& stage, State& y) {
  const double start = dot(r_, d_);
  double part = 1;
  for (int k = 0; k < most_searched; ++k, part *= shorter) {
    y.v = from_ + part * d_;
    evaluate(stage, y);
    if ((start + slope()) / 2 >= sufficient * start) return true;
  }
  return false;
}

/// Keeps the update unless r fell against it, which would make H indefinite.
void Lbfgs::remember(const State& y) {
  Pair& oldest = pairs_[count_ % memory];
  oldest.step = y.v - from_;
  oldest.fall = r_ - system().residual();
  oldest.curvature = dot(oldest.step, oldest.fall);
  if (oldest.curvature > 0) ++count_;
}

LinearResult Lbfgs::advance(const Stage& stage, State& y, double) {
  from_ = y.v;
  r_ = system().residual();
  LinearResult solved = find_direction();
  if (solved.outcome != Outcome::success) return solved;
  if (!follow(stage, y)) solved.outcome = std::isfinite(slope()) ? Outcome::not_converged : Outcome::not_finite;
  remember(y);
  return solved;
}

}  // namespace drape::solver
