#include "solver/step.hpp"

namespace drape::solver {

// x1 = x0 + h v1,   M v1 = M v0 + h f(t1, x1, v1)   [Etzmuß 2002, (3.33)]
void implicit_euler(Step& s) {
  const State& y0 = s.y0();
  s.solve({s.h, s.t + s.h, y0.x, y0.v}, 1.0 / 2);
}

}  // namespace drape::solver
