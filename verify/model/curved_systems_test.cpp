// The constant matrices of curved and graded panels: multigrid takes their coefficients and needs no more iterations on fine
// grids.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/linear/conjugate_gradients.hpp"
#include "solver/linear/stage_matrix.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::curved_systems_test {
namespace {

using solver::Vectors;

/// That of IMEX Euler, h = 0.01 s.
solver::SparseMatrix matrix(const std::string& scene, const std::vector<model::Override>& changes) {
  return solver::stage_matrix(model::compile(model::load_scene(scene, changes)).ode, 0.01);
}

/// Iterations to 1e-8.
int iterations(const solver::SparseMatrix& A) {
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
    const auto needed = [&](int k) {
      std::vector<model::Override> all = changes;
      all.push_back({"grid.n", fmt::format("[{}, {}]", (60 << k) + 1, (20 << k) + 1)});
      return iterations(matrix("skirt", all));
    };
    const int coarse = needed(0), fine = needed(2);
    EXPECT_LE(fine, most);
    EXPECT_LE(fine, 1.4 * coarse) << "a spacing of a quarter";
  }
}

TEST(AutomaticChoice, FactorsWhereSpacingsVary) {
  DRAPE_SLOW();
  const auto chosen = [](const solver::SparseMatrix& A) {
    const auto automatic = solver::make_automatic();
    EXPECT_EQ(automatic->factor(A), solver::Outcome::success);
    return std::string(automatic->reason());
  };
  EXPECT_EQ(chosen(matrix("skirt", {{"grid.n", "[321, 81]"}})), "varying");
  const auto graded = [](const char* by) { return matrix("hung-edge", {{"grid.n", "161"}, {"grid.grading", by}}); };
  EXPECT_EQ(chosen(graded("3")), "varying");
  for (const char* slightly : {"1", "1.5", "1.9"}) {
    EXPECT_EQ(chosen(graded(slightly)), "grid") << slightly;
    EXPECT_LE(iterations(graded(slightly)), 12) << slightly;
  }
}

}  // namespace
}  // namespace drape::verify::curved_systems_test
