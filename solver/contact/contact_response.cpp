#include "solver/contact/contact_response.hpp"

#include <algorithm>
#include <utility>

#include "solver/base/decompositions.hpp"
#include "solver/base/stopwatch.hpp"

namespace drape::solver {
namespace {

/// A particle this near to the border, over the largest coordinate, counts as touching when a step begins with the constraints
/// of the one before.
constexpr double touching = 1e-9;

/// Violations below this are round-off, over the largest coordinate.
constexpr double violation_round_off = 2e-13;

}  // namespace

ContactResponse::ContactResponse(const SplitOde& ode)
    : ode_(ode),
      allowed_(allowed_directions(ode)),
      pinned_(Filter::partial(ode.pins)),
      constrained_particles_(
          ode.work->counter("constrained_particles", "particles constrained by contacts, summed over steps")),
      changes_(ode.work->counter("contact_changes", "contacts caught, released, or changed between sticking and sliding")) {
  if (ode.pairs) pairs_.emplace(ode);
}

void ContactResponse::begin(double t0, double h, const State& y0, bool again) {
  if (!again) remember();
  step_begin_ = t0;
  step_ = h;
  divided_ = false;
  impulse_.setZero();
  work_ = 0;
  contacts_.clear();
  if (ode_.contacts) ode_.contacts(t0, h, y0, contacts_);
  if (pairs_) pairs_->begin(t0, h, y0, again);
  touch_all(t0, h, y0);
}

bool ContactResponse::find_pairs(const Stage& stage, const State& y) {
  if (!pairs_ || divided_ || !pairs_->find(stage, y)) return false;
  rebuild_filter();
  return true;
}

void ContactResponse::begin_part(double t0, double h, const State& y0) {
  const auto along_normal = [&](const Contact& contact) { return y0.x.row(contact.particle).dot(contact.normal); };
  if (std::exchange(divided_, true)) {
    remember();
  } else {
    if (pairs_) pairs_->clear();
    borders_.clear();
    for (const Contact& contact : contacts_)
      borders_.push_back({along_normal(contact) - std::max(0.0, contact.gap), contact.least});
  }
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const auto [begin, end] = borders_[k];
    const double moves = (end - begin) / step_, now = begin + (t0 - step_begin_) * moves;
    contacts_[k].gap = along_normal(contacts_[k]) - now;
    contacts_[k].least = now + h * moves;
  }
  touch_all(t0, h, y0);
}

void ContactResponse::remember() {
  past_.clear();
  for (const Touched& p : touched_)
    for (std::size_t k = p.begin; k < p.end; ++k)
      if (active_[k]) past_.push_back({p.particle, contacts_[k].obstacle, p.status, p.force, p.bound});
}

/// Finds the particles with contacts, and their first constraints.
void ContactResponse::touch_all(double t0, double h, const State& y0) {
  const base::Stopwatch stopwatch(ode_.response_ms);
  t0_ = t0;
  h_ = h;
  y0_ = &y0;
  size_ = y0.x.cwiseAbs().maxCoeff();
  touched_.clear();
  active_.assign(contacts_.size(), false);
  std::size_t past = 0;
  for (std::size_t begin = 0, end = 0; begin < contacts_.size(); begin = end) {
    const int particle = contacts_[begin].particle;
    while (end < contacts_.size() && contacts_[end].particle == particle) ++end;
    touch(particle, begin, end, past);
  }
  rebuild_filter();
}

void ContactResponse::touch(int particle, std::size_t begin, std::size_t end, std::size_t& past) {
  Touched p;
  p.particle = particle;
  p.begin = begin;
  p.end = end;
  p.allowed = allowed_.empty() ? Eigen::Matrix3d::Identity() : allowed_[particle];
  if (p.allowed.isZero()) return;
  const Eigen::Vector3d v = y0_->v.row(particle);
  int held = 0;
  Past remember{particle, 0, Status::free, Eigen::Vector3d::Zero(), 0};
  while (past < past_.size() && past_[past].particle < particle) ++past;
  for (std::size_t k = begin; k < end; ++k) {
    const Contact& contact = contacts_[k];
    bool was = false;
    for (std::size_t j = past; j < past_.size() && past_[j].particle == particle; ++j) {
      remember = past_[j];
      was = was || past_[j].obstacle == contact.obstacle;
    }
    const bool near = contact.gap + h_ * (v - contact.velocity).dot(contact.normal) <= touching * size_;
    active_[k] = near && held < most_contacts && (contact.gap < 0 || was);
    held += active_[k];
    p.fresh = p.fresh || (active_[k] && !was);
  }
  p.status = remember.status;
  configure(p);
  if (p.status != Status::free && !p.fresh) remember_friction(p, remember);
  touched_.push_back(p);
}

/// Sets the friction from the multipliers of the step before.
void ContactResponse::remember_friction(Touched& p, const Past& was) const {
  p.rubs = true;
  if (p.status == Status::slides) p.friction = coulomb(p, y0_->v.row(p.particle), was.force, was.bound);
}

/// Friction on a sliding particle during a step h, against its motion without friction; less than the bound where that would
/// reverse it.
Eigen::Vector3d ContactResponse::coulomb(const Touched& p, const Eigen::Vector3d& v, const Eigen::Vector3d& force,
                                         double bound) const {
  const double m = ode_.mass[p.particle];
  const Eigen::Vector3d momentum = p.tangent() * (m * (v - p.obstacle) + h_ * force);
  const double size = momentum.norm();
  if (size <= h_ * bound) return -momentum / h_;
  return -bound / size * momentum;
}

/// Computes all that depends on which contacts are active and on whether the particle sticks.
void ContactResponse::configure(Touched& p) {
  const auto count = std::count(active_.begin() + static_cast<std::ptrdiff_t>(p.begin),
                                active_.begin() + static_cast<std::ptrdiff_t>(p.end), true);
  p.normals.resize(3, count);
  p.velocity.setZero();
  p.free = p.allowed;
  if (count == 0) {
    p.status = Status::free;
    p.friction.setZero();
    return;
  }
  const Eigen::Vector3d x0 = y0_->x.row(p.particle), v0 = y0_->v.row(p.particle);
  const Eigen::Vector3d prescribed = x0 + h_ * (v0 - p.allowed * v0);
  PerContact speed(count), recede(count);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Index c = 0;
  for (std::size_t k = p.begin; k < p.end; ++k) {
    if (!active_[k]) continue;
    const Contact& contact = contacts_[k];
    p.normals.col(c) = p.allowed * contact.normal;
    speed[c] = (contact.least - prescribed.dot(contact.normal)) / h_;
    recede[c] = contact.velocity.dot(p.normals.col(c));
    ++c;
    mean += contact.velocity / static_cast<double>(count);
  }
  if (count == 1)
    p.inverse = p.normals.transpose() / p.normals.squaredNorm();
  else
    p.inverse = base::pseudo_inverse(p.normals);
  p.velocity = p.inverse.transpose() * speed;
  p.obstacle = p.inverse.transpose() * recede + p.tangent() * mean;
  p.altered = contacts_[p.begin].alters;
  if (p.altered) {
    p.alteration = p.inverse.transpose() * (speed - recede);
    p.velocity -= p.alteration;
  }
  if (p.status == Status::free) p.status = first_status(p);
  if (p.status == Status::sticks) {
    p.velocity += p.tangent() * (p.obstacle + time_to_impact(p) / h_ * (v0 - p.obstacle));
    p.free.setZero();
  } else {
    p.free = p.tangent();
    if (p.free.trace() < 0.5) p.free.setZero();  // except for round-off
  }
}

/// Time until a particle touches an obstacle [s], at most h.
double ContactResponse::time_to_impact(const Touched& p) const {
  const Eigen::Vector3d v = y0_->v.row(p.particle);
  double time = h_;
  for (std::size_t k = p.begin; k < p.end; ++k) {
    if (!active_[k]) continue;
    const double approach = (contacts_[k].velocity - v).dot(contacts_[k].normal);
    time = approach > 0 ? std::min(time, std::max(0.0, contacts_[k].gap) / approach) : 0;
  }
  return time;
}

/// A particle sticks at once if the friction of its impact alone would stop it.
ContactResponse::Status ContactResponse::first_status(const Touched& p) const {
  const Eigen::Vector3d v = y0_->v.row(p.particle).transpose() - p.obstacle;
  const PerContact approach = -(p.inverse * v);
  const double sliding = (p.tangent() * v).norm();
  const double bound = friction_bound(p, approach);
  return bound >= sliding && friction_bound(p, PerContact::Ones(approach.size())) > 0 ? Status::sticks : Status::slides;
}

/// Σ η λ over the active contacts that push.
double ContactResponse::friction_bound(const Touched& p, const PerContact& lambda) const {
  double bound = 0;
  for (std::size_t k = p.begin, c = 0; k < p.end; ++k)
    if (active_[k]) bound += contacts_[k].friction * std::max(0.0, lambda[static_cast<Eigen::Index>(c++)]);
  return bound;
}

void ContactResponse::rebuild_filter() {
  filter_.clear();
  auto touched = touched_.begin();
  for (const Filter::Block& block : pinned_.blocks()) {
    while (touched != touched_.end() && touched->particle < block.particle) ++touched;
    if (touched == touched_.end() || touched->particle != block.particle) filter_.add(block.particle, block.free);
  }
  for (const Touched& p : touched_)
    if (p.status != Status::free || !p.free.isIdentity(0)) filter_.add(p.particle, p.free);
  if (!has_pairs()) return;
  pairs_->set_free(filter_);
  filter_.add(*pairs_);
}

void ContactResponse::impose(const Stage& stage, State& y) const {
  const base::Stopwatch stopwatch(ode_.response_ms);
  for (const Touched& p : touched_) {
    if (p.status == Status::free) continue;
    const Eigen::Matrix3d constrained = p.constrained();
    Eigen::Vector3d v = y.v.row(p.particle), x = y.x.row(p.particle);
    v += p.velocity - constrained * v;
    const Eigen::Vector3d x0 = y0_->x.row(p.particle), ax = stage.ax.row(p.particle);
    x = ax + stage.gamma * v;
    if (p.altered)
      x += stage.gamma * p.alteration;
    else
      x += constrained * (x0 + (stage.t - t0_) * v - x);
    y.v.row(p.particle) = v;
    y.x.row(p.particle) = x;
  }
  if (pairs_) pairs_->impose(stage, y);
}

bool ContactResponse::update(const Stage& stage, State& y, const Vectors& r, const Eigen::VectorXd& bounds, double noise,
                             Changes changes) {
  if (!has_pairs()) return update_particles(stage, y, r, noise, changes);
  pushed_ = r;
  pairs_->add_forces(pushed_);
  const bool changed = update_particles(stage, y, pushed_, noise, changes);
  rubbed_ = r;
  rub_obstacles(stage.gamma, rubbed_);
  find_supports(r, y.v);
  if (!pairs_->update(y, rubbed_, bounds, noise, changes != Changes::captures, supports_)) {
    pushed_ = r;
    pairs_->add_forces(pushed_);  // which are those of this solution only now
    for (Touched& p : touched_)
      if (p.status != Status::free) balance(p, stage, y, pushed_);
    rub_obstacles(stage.gamma, pushed_);
    pushed_ /= stage.gamma;  // for finish()
    return changed;
  }
  leave_supports();
  rebuild_filter();
  return true;
}

/// Contacts of which pairs may push particles away: of those with one contact.
void ContactResponse::find_supports(const Vectors& r, const Vectors& v) {
  supports_.clear();
  for (const Touched& p : touched_) {
    if (p.status == Status::free || p.normals.cols() != 1) continue;
    const Eigen::Vector3d normal = p.normals.col(0).normalized();
    supports_.push_back({p.particle, normal, std::max(0.0, -r.row(p.particle).dot(normal)), v.row(p.particle).dot(normal)});
  }
}

/// Releases the contacts whose supports do not push any more.
void ContactResponse::leave_supports() {
  auto support = supports_.begin();
  for (Touched& p : touched_) {
    while (support != supports_.end() && support->particle < p.particle) ++support;
    if (support == supports_.end() || support->particle != p.particle || support->lambda > 0) continue;
    std::fill(active_.begin() + static_cast<std::ptrdiff_t>(p.begin), active_.begin() + static_cast<std::ptrdiff_t>(p.end),
              false);
    configure(p);
    ++changes_;
  }
}

/// Sets the forces on a constrained particle; returns the multipliers of its contacts.
ContactResponse::PerContact ContactResponse::balance(Touched& p, const Stage& stage, const State& y, const Vectors& r) const {
  const Eigen::Vector3d reaction = -r.row(p.particle).transpose(), v = y.v.row(p.particle), av = stage.av.row(p.particle);
  PerContact lambda = p.inverse * reaction;
  p.bound = friction_bound(p, lambda) / stage.gamma;
  p.holding = p.tangent() * reaction / stage.gamma;
  p.force = (ode_.mass[p.particle] * (v - av) - reaction) / stage.gamma;
  return lambda;
}

bool ContactResponse::update_particles(const Stage& stage, const State& y, const Vectors& r, double noise, Changes changes) {
  const base::Stopwatch stopwatch(ode_.response_ms);
  bool changed = false;
  for (Touched& p : touched_) {
    const Eigen::Vector3d v = y.v.row(p.particle);
    const Eigen::Vector3d x1 = y.x.row(p.particle).transpose() + (t0_ + h_ - stage.t) * v;
    bool differs = false;
    if (p.status != Status::free) {
      const PerContact lambda = balance(p, stage, y, r);
      differs = changes != Changes::captures && (release(p, lambda, noise) || (p.rubs && rub(p, v)));
    }
    if (!differs) differs = capture(p, x1);
    if (differs) configure(p);
    changed |= differs;
    changes_ += differs;
  }
  if (!changed && changes == Changes::all) {
    for (Touched& p : touched_) {
      if (p.status == Status::free || p.rubs || !rub(p, y.v.row(p.particle))) continue;
      configure(p);
      changed = true;
      ++changes_;
    }
  }
  if (changed) rebuild_filter();
  return changed;
}

/// Releases the contact that would have to pull hardest.
bool ContactResponse::release(Touched& p, const PerContact& lambda, double noise) {
  Eigen::Index weakest = 0;
  if (lambda.minCoeff(&weakest) >= -noise) return false;
  for (std::size_t k = p.begin; k < p.end; ++k)
    if (active_[k] && weakest-- == 0) active_[k] = false;
  return true;
}

/// Captures the contact that is violated most. One at a time: two contacts with almost parallel normals meet far away, and
/// where the particle does not violate the second one any more, it has no reason to go there.
bool ContactResponse::capture(Touched& p, const Eigen::Vector3d& x1) {
  if (p.normals.cols() == most_contacts) return false;
  double most = violation_round_off * size_;
  std::size_t captured = p.end;
  for (std::size_t k = p.begin; k < p.end; ++k) {
    const double violation = contacts_[k].least - x1.dot(contacts_[k].normal);
    if (active_[k] || violation <= most) continue;
    if ((p.allowed * contacts_[k].normal).isZero(1e-6)) continue;  // pins decide
    most = violation;
    captured = k;
  }
  if (captured == p.end) return false;
  active_[captured] = p.fresh = true;
  return true;
}

/// Decides the friction of a new contact; later a particle that friction would reverse sticks.
bool ContactResponse::rub(Touched& p, const Eigen::Vector3d& v) {
  const Eigen::Vector3d sliding = p.tangent() * (v - p.obstacle);
  const bool first = !std::exchange(p.rubs, true);
  if (first && p.status == Status::sticks) {
    if (p.holding.norm() <= p.bound) return false;
    p.status = Status::slides;
    p.friction = p.bound * p.holding.normalized();
    return true;
  }
  if (first && !sliding.isZero(0)) {
    p.friction = -p.bound * sliding.normalized();
    return p.bound > 0;
  }
  if (p.status != Status::slides || !(sliding.dot(p.friction) > 0)) return false;
  p.friction.setZero();
  p.status = Status::sticks;
  p.fresh = true;
  return true;
}

void ContactResponse::add_friction(double gamma, Vectors& r) const {
  const base::Stopwatch stopwatch(ode_.response_ms);
  rub_obstacles(gamma, r);
  if (pairs_) pairs_->add_friction(r);
}

void ContactResponse::rub_obstacles(double gamma, Vectors& r) const {
  for (const Touched& p : touched_) r.row(p.particle) += gamma * p.friction;
}

/// Replaces some directions of y0 by those from which the uniform acceleration a leads to y1, where that changes the velocity
/// less than the step did: stiff neighbours may pull much harder for a moment.
void ContactResponse::rewrite_history(const Eigen::Matrix3d& directions, const Eigen::Vector3d& a, int particle,
                                      const State& y1, State& y0) const {
  const Eigen::Vector3d x1 = y1.x.row(particle), v1 = y1.v.row(particle), x0 = y0.x.row(particle), v0 = y0.v.row(particle);
  const double most = (v1 - v0).norm(), size = h_ * a.norm();
  const Eigen::Vector3d change = size > most ? Eigen::Vector3d(most / size * h_ * a) : Eigen::Vector3d(h_ * a);
  y0.x.row(particle) += directions * (x1 - h_ * (v1 - change / 2) - x0);
  y0.v.row(particle) += directions * (v1 - change - v0);
}

double ContactResponse::stopped_energy() const {
  double energy = pairs_ ? pairs_->stopped_energy() : 0;
  for (const Touched& p : touched_)
    if (p.fresh)
      energy +=
          0.5 * ode_.mass[p.particle] * (p.constrained() * (p.obstacle - y0_->v.row(p.particle).transpose())).squaredNorm();
  return energy;
}

bool ContactResponse::finish(State& y1, State& y0) {
  const base::Stopwatch stopwatch(ode_.response_ms);
  bool changed = false;
  if (pairs_) {
    const Eigen::Vector3d before = y1.v.transpose() * ode_.mass;
    changed = pairs_->finish(y1, y0);
    if (ode_.pins.empty()) {
      impulse_ += y1.v.transpose() * ode_.mass - before;  // what stands on supports stops by them
      if (has_pairs()) {
        // Forces of pairs have no sum: what those of the last sweeps have more in the directions that obstacles leave free than
        // the solution, obstacles bear less in the others.
        Eigen::Vector3d missing = pushed_.colwise().sum();
        for (const Touched& p : touched_)
          if (p.status != Status::free) missing -= p.constrained() * pushed_.row(p.particle).transpose();
        impulse_ -= h_ * missing;
      }
    }
  }
  for (Touched& p : touched_) {
    if (p.status == Status::free) continue;
    ++constrained_particles_;
    const Eigen::Matrix3d constrained = p.constrained();
    const Eigen::Vector3d v1 = y1.v.row(p.particle), jump = constrained * (p.obstacle - v1);
    y1.v.row(p.particle) += jump;
    const Eigen::Vector3d v0 = y0.v.row(p.particle), stopped = constrained * (p.obstacle - v0);
    const Eigen::Vector3d impulse = ode_.mass[p.particle] * stopped + h_ * (p.friction - constrained * p.force);
    impulse_ += impulse;
    work_ += 0.5 * impulse.dot(v0 + v1 + jump);
    const bool impulsive = p.fresh && p.bound > 0;
    if (p.fresh) {  // the reaction to the impact does not last
      p.bound = friction_bound(p, -(p.inverse * p.force));
      p.holding = -(p.tangent() * p.force);
    }
    if (p.status == Status::sticks && p.holding.norm() > p.bound) p.status = Status::slides;  // in the next step
    if (!p.fresh) continue;
    Eigen::Vector3d f = p.free * p.force;
    if (p.status == Status::slides) f += coulomb(p, y1.v.row(p.particle), p.force, p.bound);
    const Eigen::Matrix3d jumped = impulsive ? p.allowed : constrained;  // friction has an impulse too
    rewrite_history(jumped, f / ode_.mass[p.particle], p.particle, y1, y0);
    changed = true;
  }
  return changed;
}

bool ContactResponse::impact() const {
  return std::ranges::any_of(touched_, [](const Touched& p) { return p.fresh; }) || (pairs_ && pairs_->impact());
}

int ContactResponse::constrained() const {
  return static_cast<int>(std::ranges::count_if(touched_, [](const Touched& p) { return p.status != Status::free; }));
}

}  // namespace drape::solver
