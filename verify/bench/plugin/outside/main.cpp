// Steps of a built-in scene by the installed libraries.
#include <cstdio>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/integrator.hpp"

int main() {
  const drape::model::Cloth cloth = drape::model::compile(drape::model::load_scene("hung-edge"));
  drape::solver::Integrator integrator(cloth.ode, drape::solver::method("bdf2"), {}, cloth.start);
  for (int k = 0; k < 10; ++k) integrator.step(0.01);
  std::printf("%.17g\n", integrator.state().x.col(2).minCoeff());
}
