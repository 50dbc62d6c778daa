#include <algorithm>
#include <cmath>

#include "solver/methods.hpp"
#include "solver/stability.hpp"

namespace drape::solver {
namespace {

/// Where a step counts as failed: at some microseconds a sub-step it would take minutes.
constexpr double most_substeps = 1e8;

}  // namespace

// h is divided into equal sub-steps τ inside the stability limit of the initial state, and in each
//   x1 = x0 + τ v0 + τ²/2 a0,   a1 = a(t1, x1, v0 + τ a0),   v1 = v0 + τ/2 (a0 + a1)
// which is velocity Verlet where forces do not depend on velocities and of second order where they do, with one
// evaluation a sub-step   [Verlet 1967; Groot, Warren 1997, λ = 1].
void verlet(Step& s) {
  if (s.explicit_limit == 0) s.explicit_limit = verlet_limit(spectrum(s.ode, s.t, s.y0()));
  if (!(s.explicit_limit > 0)) {
    s.result.outcome = Outcome::not_finite;
    return;
  }
  const double substeps = std::max(1.0, std::ceil(s.h / (s.options.verlet_fraction * s.explicit_limit)));
  if (substeps > most_substeps) {
    s.result.outcome = Outcome::not_converged;
    return;
  }
  const double tau = s.h / substeps;
  State& y = s.y1();
  Vectors& a = s.next.f;
  const auto accelerate = [&](double t, const Vectors& v) {
    s.ode.force(t, y.x, v, a);
    filter(s.ode.pins, a);
    a = s.ode.mass.cwiseInverse().asDiagonal() * a;
  };

  const bool contacts = s.impacts != nullptr && !s.impacts->empty();
  y = s.y0();
  prescribe(s.ode.pins, y.v);
  if (s.now.has_f)
    a = s.now.f;
  else
    accelerate(s.t, y.v);
  if (contacts) {
    s.impacts->push_out(0, y.x);
    s.impacts->stop(tau, true, y.v, a);
  }
  for (double k = 1; k <= substeps; ++k) {
    y.x += tau * y.v + (0.5 * tau * tau) * a;
    if (contacts) s.impacts->push_out(k * tau, y.x);
    y.v += (0.5 * tau) * a;        // the half of a0
    s.av = y.v + (0.5 * tau) * a;  // the velocity that a1 is evaluated with
    accelerate(s.t + k * tau, s.av);
    y.v += (0.5 * tau) * a;
    if (contacts) s.impacts->stop(tau, false, y.v, a);
  }
  s.next.has_f = !contacts;  // what obstacles bear was taken from it
  s.error_constant = 1.0 / (6 * substeps * substeps);
  s.substeps += static_cast<std::int64_t>(substeps);
}

}  // namespace drape::solver
