// The exact Jacobian is assembled into a pattern that is found once: nothing is left of earlier calls, whatever the state.

#include <gtest/gtest.h>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::verify::exact_jacobian_test {
namespace {

using solver::SparseMatrix;

struct Jacobians {
  SparseMatrix dx, dv;
};

Jacobians jacobians(const model::Cloth& cloth, const solver::State& y) {
  Jacobians result;
  cloth.ode.jacobian(0.1, y.x, y.v, result.dx, result.dv);
  return result;
}

TEST(ExactJacobian, KeepsItsPatternAndNothingElse) {
  for (const char* name : {"pulled", "bending", "hung-corners"}) {
    const model::Scene scene = model::load_scene(name, std::vector<model::Override>{{"grid.n", "5"}});
    const model::Cloth cloth = model::compile(scene);
    solver::State moved = cloth.start;
    moved.x += 0.01 * model::size(scene) * solver::Vectors::Random(moved.x.rows(), 3);
    moved.v += solver::Vectors::Random(moved.x.rows(), 3);
    const Jacobians first = jacobians(cloth, cloth.start), second = jacobians(cloth, moved);
    const Jacobians anew = jacobians(model::compile(scene), moved);
    EXPECT_EQ((second.dx - anew.dx).norm(), 0) << name;
    EXPECT_EQ((second.dv - anew.dv).norm(), 0) << name;
    EXPECT_GT((second.dx - first.dx).norm(), 0) << name;
    EXPECT_EQ(first.dx.nonZeros(), second.dx.nonZeros()) << name;
    EXPECT_EQ(first.dv.nonZeros(), second.dv.nonZeros()) << name;
  }
}

TEST(ExactJacobian, OverwritesWhatItIsGiven) {
  const model::Cloth cloth = model::compile(model::load_scene("hung-corners", std::vector<model::Override>{{"grid.n", "5"}}));
  const Jacobians right = jacobians(cloth, cloth.start);
  Jacobians given = right;
  given.dx *= 2;
  given.dv.resize(0, 0);
  cloth.ode.jacobian(0.1, cloth.start.x, cloth.start.v, given.dx, given.dv);
  EXPECT_EQ((given.dx - right.dx).norm(), 0);
  EXPECT_EQ((given.dv - right.dv).norm(), 0);
}

}  // namespace
}  // namespace drape::verify::exact_jacobian_test
