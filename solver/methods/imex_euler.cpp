#include "solver/step.hpp"

namespace drape::solver {

// A v1 = M v0 + h f_expl(x0, v0) + h K x0,   x1 = x0 + h v1,   A = M − h² K − h D   [Etzmuß 2002, (3.22)–(3.24)]
void imex_euler(Step& s) {
  const State& y0 = s.y0();
  s.solve_split({s.h, s.t + s.h, y0.x, y0.v}, s.explicit_force(s.now(), s.t), 1.0 / 2);
}

}  // namespace drape::solver
