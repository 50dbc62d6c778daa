#include "solver/contact/impact_response.hpp"

#include <algorithm>
#include <cmath>

#include "solver/base/stopwatch.hpp"
#include "solver/filter.hpp"

namespace drape::solver {
namespace {

constexpr double round_off = 1e-13;  ///< over the largest position, velocity or acceleration: less than that is none

}  // namespace

ImpactResponse::ImpactResponse(const SplitOde& ode) : ode_(ode), allowed_(allowed_directions(ode)) {}

void ImpactResponse::begin(double t0, double h, const State& y0) {
  h_ = h;
  impulse_.setZero();
  work_ = 0;
  found_.clear();
  contacts_.clear();
  ode_.contacts(t0, h, y0, found_);
  for (const Contact& contact : found_) {
    const Eigen::Matrix3d allowed = allowed_.empty() ? Eigen::Matrix3d::Identity() : allowed_[contact.particle];
    const Eigen::Vector3d direction = allowed * contact.normal;
    if (direction.isZero(1e-6)) continue;  // pins decide
    const double start = y0.x.row(contact.particle).dot(contact.normal) - std::max(0.0, contact.gap);
    contacts_.push_back({contact, allowed, direction / direction.squaredNorm(), start});
  }
}

/// Adds the impulse and work of a change of velocity, where v is the velocity in the middle of it.
void ImpactResponse::give(int particle, const Eigen::Vector3d& change, const Eigen::Vector3d& v) {
  impulse_ += ode_.mass[particle] * change;
  work_ += ode_.mass[particle] * change.dot(v);
}

/// The largest number in the rows of particles with contacts.
double ImpactResponse::largest(const Vectors& rows) const {
  double size = 0;
  for (const Side& side : contacts_) size = std::max(size, rows.row(side.contact.particle).cwiseAbs().maxCoeff());
  return size;
}

/// Several contacts of a particle disturb each other: they are corrected in turn, and unneeded corrections are undone, until
/// none changes by more than the noise. `missing`: the correction that a contact needs; `note`: called for every change of a
/// row.
template <class Missing, class Note>
void ImpactResponse::take_turns(double Side::*given, double noise, Vectors& rows, const Missing& missing, const Note& note) {
  constexpr int most_turns = 50;
  for (Side& side : contacts_) side.*given = 0;
  bool again = true;
  for (int k = 0; k < most_turns && again; ++k) {
    again = false;
    for (Side& side : contacts_) {
      const double change = std::max(missing(side), -(side.*given));
      side.*given += change;
      rows.row(side.contact.particle) += change * side.escape;
      note(side.contact.particle, change * side.escape);
      again = again || std::abs(change) > noise;
    }
  }
}

void ImpactResponse::push_out(double s, Vectors& x) {
  const base::Stopwatch stopwatch(ode_.response_ms);
  const auto depth = [&](const Side& side) {
    const double border = side.start + s / h_ * (side.contact.least - side.start);
    return border - x.row(side.contact.particle).dot(side.contact.normal);
  };
  const double noise = round_off * largest(x);
  take_turns(&Side::pushed, noise, x, depth, [](int, const Eigen::Vector3d&) {});
  for (Side& side : contacts_) side.touched = depth(side) > -10 * noise;
}

void ImpactResponse::stop(double tau, bool begins, Vectors& v, Vectors& a) {
  const base::Stopwatch stopwatch(ode_.response_ms);
  const double lasts = begins ? 0 : tau / 2;
  const double pull = largest(a), noise = round_off * (largest(v) + tau * pull);
  const auto approach = [&](const Side& side) {
    const Contact& contact = side.contact;
    return side.touched ? (contact.velocity - v.row(contact.particle).transpose()).dot(contact.normal) : 0.0;
  };
  const auto pressure = [&](const Side& side) {
    const bool leaves = !side.touched || approach(side) < -noise;
    return leaves ? 0.0 : -a.row(side.contact.particle).dot(side.contact.normal);
  };
  take_turns(&Side::impact, noise, v, approach,
             [&](int i, const Eigen::Vector3d& jump) { give(i, jump, v.row(i).transpose() - 0.5 * jump); });
  take_turns(&Side::load, round_off * pull, a, pressure,
             [&](int i, const Eigen::Vector3d& borne) { give(i, lasts * borne, v.row(i)); });
  for (const Side& side : contacts_) {
    if (side.contact.friction == 0 || !side.touched) continue;
    const int i = side.contact.particle;
    const auto [jump, borne] = friction(side, tau, v.row(i), a.row(i));
    v.row(i) += jump;
    a.row(i) += borne;
    give(i, jump + lasts * borne, v.row(i).transpose() - 0.5 * jump);
  }
}

/// Coulomb's law for one contact: a particle sticks if friction can keep it from sliding for half a sub-step.
ImpactResponse::Friction ImpactResponse::friction(const Side& side, double tau, const Eigen::Vector3d& v,
                                                  const Eigen::Vector3d& a) {
  const auto tangential = [&](const Eigen::Vector3d& u) -> Eigen::Vector3d {
    const Eigen::Vector3d free = side.allowed * u;
    return free - free.dot(side.contact.normal) * side.escape;
  };
  const double drag = side.contact.friction * side.impact, hold = side.contact.friction * side.load;
  const Eigen::Vector3d sliding = tangential(v - side.contact.velocity), pull = tangential(a);
  const Eigen::Vector3d without = sliding + tau / 2 * pull;
  const double speed = without.norm();
  if (speed > drag + hold * tau / 2) return {-drag / speed * without, -hold / speed * without};
  return {-sliding, -pull};
}

int ImpactResponse::constrained() const {
  int count = 0, last = -1;
  for (const Side& side : contacts_) {
    if (!side.touched || side.contact.particle == last) continue;
    ++count;
    last = side.contact.particle;
  }
  return count;
}

}  // namespace drape::solver
