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

/// The matrix of IMEX Euler, h = 0.01 s, on a half-circle skirt with cells divided by 2^k.
solver::SparseMatrix matrix(std::vector<model::Override> changes, int k) {
  changes.push_back({"grid.n", fmt::format("[{}, {}]", (60 << k) + 1, (20 << k) + 1)});
  return solver::stage_matrix(model::compile(model::load_scene("skirt", changes)).ode, 0.01);
}

/// Iterations to 1e-8.
int iterations(const std::vector<model::Override>& changes, int k) {
  const solver::SparseMatrix A = matrix(changes, k);
  solver::Counters work;
  solver::ConjugateGradients cg(solver::make_multigrid(), 100, work);
  cg.analyse(A);
  EXPECT_EQ(cg.factor(A), solver::Outcome::success);
  EXPECT_EQ(work.count("linear_solver/multigrid"), 1);
  Vectors r = small_problems::noise(static_cast<int>(A.rows()), 9), d = r;
  return cg.solve(A, {}, r, d, 1e-8 * r.norm()).iterations;
}

/// More than on uniform sheets, where neither direction is the stronger one everywhere.
TEST(MultigridOfCurvedPanels, NeedsHardlyMoreIterationsOnFineGrids) {
  const struct {
    std::vector<model::Override> changes;
    int most;
  } panels[] = {{{}, 24}, {{{"grid.grading", "[1, 8]"}}, 44}, {{{"grid.grading", "[8, 0.2]"}}, 36}};
  for (const auto& [changes, most] : panels) {
    const int coarse = iterations(changes, 0), fine = iterations(changes, 2);
    EXPECT_LE(fine, most);
    EXPECT_LE(fine, 1.4 * coarse) << "a spacing of a quarter";
  }
}

TEST(AutomaticChoice, FactorsWhereSpacingsVary) {
  const auto chosen = [](const std::vector<model::Override>& changes, const std::string& scene) {
    const auto automatic = solver::make_automatic();
    const auto A = solver::stage_matrix(model::compile(model::load_scene(scene, changes)).ode, 0.01);
    EXPECT_EQ(automatic->factor(A), solver::Outcome::success);
    return std::string(automatic->reason());
  };
  EXPECT_EQ(chosen({{"grid.n", "[321, 81]"}}, "skirt"), "varying");
  EXPECT_EQ(chosen({{"grid.n", "161"}}, "hung-edge"), "grid");
  EXPECT_EQ(chosen({{"grid.n", "161"}, {"grid.grading", "1.5"}}, "hung-edge"), "grid");
  EXPECT_EQ(chosen({{"grid.n", "161"}, {"grid.grading", "3"}}, "hung-edge"), "varying");
}

}  // namespace
}  // namespace drape::verify::curved_systems_test
