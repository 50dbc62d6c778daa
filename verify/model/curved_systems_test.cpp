// The constant matrices of curved and graded panels: multigrid takes their coefficients and needs no more iterations on fine
// grids.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "model/scene_file/scene_file.hpp"
#include "solver/linear/conjugate_gradients.hpp"
#include "solver/linear/stage_matrix.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::curved_systems_test {
namespace {

using solver::Vectors;

/// Iterations to 1e-8 with the matrix of IMEX Euler, h = 0.01 s, on the scene with cells divided 2^k times.
int iterations(const std::string& name, std::vector<model::Override> changes, int nu, int nv, int k) {
  const auto divided = [&](int n) { return ((n - 1) << k) + 1; };
  changes.push_back({"grid.n", fmt::format("[{}, {}]", divided(nu), divided(nv))});
  const model::Cloth cloth = model::compile(model::load_scene(name, changes));
  const auto A = solver::stage_matrix(cloth.ode, 0.01);
  solver::Counters work;
  solver::ConjugateGradients cg(solver::make_multigrid(), 100, work);
  cg.analyse(A);
  EXPECT_EQ(cg.factor(A), solver::Outcome::success);
  EXPECT_EQ(work.count("linear_solver/multigrid"), 1);
  Vectors r = small_problems::noise(cloth.ode.particles(), 9), d = r;
  return cg.solve(A, {}, r, d, 1e-8 * r.norm()).iterations;
}

TEST(MultigridOfCurvedPanels, NeedsFewIterationsOnAnyGrid) {
  const std::vector<std::pair<std::string, std::vector<model::Override>>> panels{
      {"skirt", {}}, {"skirt", {{"grid.grading", "[1, 8]"}}}, {"skirt", {{"grid.grading", "[8, 0.2]"}}}};
  for (const auto& [name, changes] : panels)
    for (int k = 0; k < 3; ++k)
      EXPECT_LE(iterations(name, changes, 61, 21, k), 12)
          << name << " " << (changes.empty() ? "" : changes[0].value) << " " << k;
}

}  // namespace
}  // namespace drape::verify::curved_systems_test
