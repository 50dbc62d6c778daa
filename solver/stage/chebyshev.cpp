#include "solver/stage/chebyshev.hpp"

namespace drape::solver {
namespace {

constexpr int loop_delay = 10;  ///< as published   [Wang 2015, S = 10]

}  // namespace

double ChebyshevWeights::next() {
  if (iterations_ < delay_ || iterations_ == 0)
    weight_ = 1;
  else
    weight_ = weight_ == 1 ? 2 / (2 - square_) : 4 / (4 - square_ * weight_);
  ++iterations_;
  return weight_;
}

ChebyshevIterates::ChebyshevIterates(Eigen::Index particles, double radius, int delay)
    : weights_(radius, delay), before_(Vectors::Zero(particles, 3)) {}

void ChebyshevIterates::restart(const Vectors& v) {
  weights_.restart();
  before_ = v;
}

void ChebyshevIterates::combine(const Vectors& last, Vectors& v) {
  const double weight = weights_.next();
  if (weight != 1) v = before_ + weight * (v - before_);
  before_ = last;
}

ChebyshevLoop::ChebyshevLoop(const SplitOde& ode, const Options& options, StageSystem& system)
    : StageIteration(ode, options, system),
      iterates_(ode.particles(), options.chebyshev_radius, loop_delay),
      last_(Vectors::Zero(ode.particles(), 3)) {}

void ChebyshevLoop::begin(const State& y) { iterates_.restart(y.v); }

LinearResult ChebyshevLoop::advance(const Stage& stage, State& y, double target) {
  const LinearResult solved = system().correct(target);
  last_ = y.v;
  y.v += system().correction();
  iterates_.combine(last_, y.v);
  evaluate(stage, y);
  return solved;
}

}  // namespace drape::solver
