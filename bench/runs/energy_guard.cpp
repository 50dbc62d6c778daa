#include "bench/runs/energy_guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace drape::bench {
namespace {

using solver::State;
using solver::Vectors;

/// Strain, and part of a sum, that round-off and unfinished solves may leave in a sheet at rest.
constexpr double strain_noise = 1e-9, round_off = 1e-12;

State start_of(const model::Cloth& cloth) {
  State start = cloth.start;
  solver::prescribe(cloth.ode.pins, start.v);
  return start;
}

double noise_of(const model::Garment& garment, const Vectors& weight, const Vectors& x) {
  double noise = round_off * weight.cwiseProduct(x).cwiseAbs().sum();
  for (const model::Garment::Panel& panel : garment.panels()) {
    const model::WeftWarp& k = panel.sheet.material.tension;
    noise += std::max(k.weft, k.warp) * strain_noise * strain_noise * panel.sheet.grid.cell_areas().sum();
  }
  return noise;
}

/// What cloth that falls freely has after a second, and that grows with the square of time [J/s²].
double fall_of(const Eigen::Vector3d& gravity, const Vectors& weight) {
  return 0.5 * gravity.norm() * weight.rowwise().norm().sum();
}

}  // namespace

EnergyGuard::GivenWork::GivenWork(const solver::SplitOde::Force& given, double begin, const State& start, bool jumps)
    : given_(given), jumps_(jumps) {
  if (!given_) return;
  last_.x = start.x;
  given_(begin, start.x, start.v, last_.f);
  pair_ = last_;
}

void EnergyGuard::GivenWork::go_on(double t, const State& y) {
  if (!given_) return;
  now_.x = y.x;
  given_(t, y.x, y.v, now_.f);
  fine_ += last_.work_to(now_);
  const Vectors difference = (now_.f - last_.f).cwiseProduct(now_.x - last_.x);
  pending_ = halfway_ ? 0 : 0.5 * std::abs(difference.sum());
  if (jumps_) doubt_ += 0.5 * difference.rowwise().sum().cwiseAbs().sum();
  if (halfway_) {
    coarse_ += pair_.work_to(now_);
    doubt_ = std::max(doubt_, std::abs(fine_ - coarse_));
    pair_ = now_;
    paired_ = true;
  }
  halfway_ = !halfway_;
  std::swap(last_, now_);
}

EnergyGuard::EnergyGuard(const model::Scene& scene, const model::Cloth& cloth)
    : cloth_(cloth),
      wind_(scene.sheet.wind),
      areas_(cloth.garment->areas()),
      weight_(cloth.garment->cloth_masses() * scene.sheet.gravity.transpose()),
      x_(cloth.start.x),
      start_(kinetic_and_elastic(cloth.begin, start_of(cloth))),
      noise_(noise_of(*cloth.garment, weight_, x_)),
      fall_(fall_of(scene.sheet.gravity, weight_)),
      time_(scene.end - cloth.begin),
      most_given_(std::max(0.0, start_)),
      work_(cloth.given, cloth.begin, start_of(cloth), !scene.obstacles.empty() && model::is_force(scene.contact.response)) {}

double EnergyGuard::kinetic_and_elastic(double t, const State& y) const {
  const double gravity = -weight_.cwiseProduct(y.x).sum();
  const double divided = cloth_.ode.step_forces ? cloth_.ode.step_forces->energy(t, y.x) : 0;  // what their forces do is given
  return solver::kinetic_energy(cloth_.ode, y.v) + solver::stored_energy(cloth_.ode, t, y) - divided - gravity;
}

/// What a wind may have done in a step that is longer than its swing [J].
double EnergyGuard::unresolved(const solver::StepReport& step, const Vectors& moved) const {
  if (!wind_.blows() || !(wind_.frequency * step.h > 1)) return 0;
  const double load = (std::abs(wind_.constant) + 1) * wind_.load.norm() * std::max(std::abs(wind_.drag), std::abs(wind_.lift));
  return load * areas_.dot(moved.rowwise().norm());
}

bool EnergyGuard::exceeded(const solver::StepReport& step) {
  const Vectors moved = step.y.x - x_;
  if (cloth_.ode.damping.nonZeros() > 0) damped_ -= moved.cwiseProduct(cloth_.ode.damping * moved).sum() / step.h;
  contact_work_ += step.contacts.work;
  work_.go_on(step.t, step.y);
  unresolved_ += unresolved(step, moved);
  x_ = step.y.x;
  const double given = start_ + weight_.cwiseProduct(x_ - cloth_.start.x).sum() + work_.value() + contact_work_;
  most_given_ = std::max(most_given_, given);
  energy_ = kinetic_and_elastic(step.t, step.y);
  const double first = std::min(first_steps * step.h, first_part * time_);
  const double doubt = work_.doubt() + unresolved_, tolerance = tolerated * most_given_ + noise_;
  limit_ = given - damped_ + tolerance + fall_ * first * first + doubt;
  judges_ = work_.compared() && doubt <= tolerance;
  return !(energy_ <= limit_);
}

std::string EnergyGuard::message(double t) const {
  return fmt::format("at t = {:.4g} s its energy was {:.3g} J where the scene can have {:.3g} J", t, energy_, limit_);
}

void EnergyGuardObserver::observe(const solver::StepReport& step) {
  if (guard_->exceeded(step)) throw Ending{solver::Outcome::unstable, guard_->message(step.t), good_};
  good_ = step.t;
}

std::string EnergyGuardObserver::remark() const {
  return guard_->judges() ? "" : "energy cannot be judged: work is too uncertain with such steps";
}

RunEnd run_guarded(const RunSpec& spec, const model::Cloth& cloth, const Limits& limits) {
  EnergyGuardObserver guard;
  Observer* const observers[] = {&guard};
  return run(spec, cloth, observers, limits);
}

}  // namespace drape::bench
