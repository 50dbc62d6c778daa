#include "solver/plugin.hpp"
#include "solver/step.hpp"

namespace {

using drape::solver::Method;
using drape::solver::State;
using drape::solver::Step;

// The implicit midpoint rule   [Etzmuß 2002, (3.26)], solved for the state in the middle:
// ym = y0 + h/2 f(t0 + h/2, ym),   y1 = 2 ym − y0
void midpoint(Step& s) {
  const State& y0 = s.y0();
  State& ym = s.y1();
  if (!s.solve({s.h / 2, s.t + s.h / 2, y0.x, y0.v}, 1.0 / 12)) return;
  s.y1().x = 2 * ym.x - y0.x;
  s.y1().v = 2 * ym.v - y0.v;
}

const Method rows[] = {{.name = "my-midpoint",
                        .description = "implicit midpoint rule, from a plugin",
                        .order = 2,
                        .stages = Method::Stages::nonlinear,
                        .step = midpoint}};

}  // namespace

DRAPE_PLUGIN(rows)
