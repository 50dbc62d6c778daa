#include "solver/methods/stabilised.hpp"

#include <cmath>

#include "solver/stability.hpp"

namespace drape::solver {

// The largest decay is that of the initial state until neighbours have moved apart by a tenth.
double stages_of(Step& s, double (*fewest)(double h_decay), double most) {
  SubStepping& kept = s.sub_stepping;
  if (kept.limit == 0 || kept.stretch_watch.stretched(s.ode.stiffness, s.y0().x, *s.ode.partition)) {
    ++kept.limits;
    kept.stretch_watch.begin(s.ode.stiffness, s.y0().x);
    kept.limit = 1 / spectrum(s.ode, s.t, s.y0()).decay;
  }
  const double h_decay = s.h / kept.limit, stages = fewest(h_decay);
  if (std::isfinite(h_decay) && stages <= most) return stages;
  s.result.outcome = std::isfinite(h_decay) ? Outcome::not_converged : Outcome::not_finite;
  return 0;
}

}  // namespace drape::solver
