#include "solver/methods/sub_steps.hpp"

#include <algorithm>
#include <cmath>

namespace drape::solver {
namespace {

/// Where a step counts as failed: at some microseconds a sub-step it would take minutes.
constexpr double most_substeps = 1e8;

double new_limit(Step& s, SubStepLimit limit, double t, const State& y) {
  ++s.sub_stepping.limits;
  s.sub_stepping.stretch_watch.begin(s.ode.stiffness, y.x);
  return limit(s.ode, t, y);
}

}  // namespace

void sub_step(Step& s, SubStepLimit limit, bool (*whole_step)(Step& s, double substeps)) {
  if (s.sub_stepping.limit == 0) s.sub_stepping.limit = new_limit(s, limit, s.t, s.y0());
  for (bool done = false; !done;) {
    if (!(s.sub_stepping.limit > 0)) {
      s.result.outcome = Outcome::not_finite;
      return;
    }
    const double substeps = std::max(1.0, std::ceil(s.h / (s.options.verlet_fraction * s.sub_stepping.limit)));
    if (substeps > most_substeps) {
      s.result.outcome = Outcome::not_converged;
      return;
    }
    done = whole_step(s, substeps);
    if (!done) s.recall();
    if (!done && s.sub_stepping.impacts != nullptr) s.sub_stepping.impacts->begin(s.t, s.h, s.y0());
    if (!done && s.contacts != nullptr) s.contacts->begin(s.t, s.h, s.y0());
  }
}

bool limit_narrowed(Step& s, SubStepLimit limit, double t, const Vectors& v, bool alarmed) {
  constexpr int stretch_period = 8;
  constexpr double worthwhile = 0.98;
  const bool looks = ++s.sub_stepping.substeps % stretch_period == 0;
  const auto stretched = [&] { return s.sub_stepping.stretch_watch.stretched(s.ode.stiffness, s.y1().x, *s.ode.partition); };
  if (!alarmed && !(looks && stretched())) return false;
  const double now = new_limit(s, limit, t, {s.y1().x, v});
  if (now < worthwhile * s.sub_stepping.limit) {
    s.sub_stepping.limit = now;
    return true;
  }
  if (alarmed) s.sub_stepping.limit_watch.rest();
  return false;
}

void inverse_masses(const SplitOde& ode, Vectors& w) {
  for (int c = 0; c < 3; ++c) w.col(c) = ode.mass.cwiseInverse();
  for (const Pin& pin : ode.pins)
    for (int c = 0; c < 3; ++c)
      if (pin.fixed(c)) w(pin.particle, c) = 0;
}

}  // namespace drape::solver
