// The condition of a stage's matrix: closed forms, dense eigenvalues and the Lanczos process agree.

#include "reference/theory/condition.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/decompositions.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::condition_test {
namespace {

using reference::PinnedBorder;
using reference::stage_eigenvalues;

struct Sheet {
  std::string name, pins;
  PinnedBorder pinned;
  int pinned_particles;
};
const Sheet sheets[] = {{"none", "[]", PinnedBorder::none, 0},
                        {"one_edge", "[{ where = \"upper edge\" }]", PinnedBorder::one_edge, 7},
                        {"all", "[{ where = \"border\" }]", PinnedBorder::all, 24}};

class Condition : public testing::TestWithParam<Sheet> {
 protected:
  static constexpr int n = 7;
  static constexpr double h = 0.01, d = 30;
  model::Scene scene = model::load_scene(
      "hung-edge", std::vector<model::Override>{
                       {"grid.n", "7"}, {"material.damping", "30"}, {"material.shear", "0"}, {"pins", GetParam().pins}});
  model::Cloth cloth = model::compile(scene);
  solver::SparseMatrix A = reference::stage_matrix(cloth.ode, h);

  double g() const {
    const double area = scene.sheet.material.density * scene.sheet.grid.spacing_u() * scene.sheet.grid.spacing_u();
    return h * h * scene.sheet.material.tension.weft / area + h * d / area;
  }

  /// Eigenvalues of M^-1/2 A M^-1/2 among free particles.
  Eigen::VectorXd dense() const {
    std::vector<int> free;
    std::vector<bool> pinned(n * n, false);
    for (const solver::Pin& pin : cloth.ode.pins) pinned[pin.particle] = true;
    for (int i = 0; i < n * n; ++i)
      if (!pinned[i]) free.push_back(i);
    const Eigen::VectorXd s = cloth.ode.mass.cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = s.asDiagonal() * Eigen::MatrixXd(A) * s.asDiagonal();
    return base::symmetric_eigen(scaled(free, free)).values;
  }

  /// Components along all eigenvectors of the free particles.
  solver::Vectors solution() const {
    solver::Vectors x = small_problems::noise(n * n, 3);
    solver::filter(cloth.ode.pins, x);
    return x;
  }
};
INSTANTIATE_TEST_SUITE_P(, Condition, testing::ValuesIn(sheets), [](const auto& test) { return test.param.name; });

TEST_P(Condition, HasEigenvaluesInClosedForm) {
  const Eigen::VectorXd values = dense();
  ASSERT_EQ(values.size(), n * n - GetParam().pinned_particles);
  const auto known = stage_eigenvalues(n, g(), GetParam().pinned);
  EXPECT_NEAR(known.least, values.minCoeff(), 1e-10 * known.least);
  EXPECT_NEAR(known.largest, values.maxCoeff(), 1e-10 * known.largest);
}

TEST_P(Condition, IsWhatTheLanczosProcessFinds) {
  const auto jacobi = solver::linear_solver("jacobi").make();
  jacobi->analyse(A);
  ASSERT_EQ(jacobi->factor(A), solver::Outcome::success);
  const double known = stage_eigenvalues(n, g(), GetParam().pinned).condition();
  const auto run = reference::krylov_run(A, *jacobi, solution(), 1e-6);
  EXPECT_NEAR(run.eigenvalues.condition(), known, 1e-6 * known);
  EXPECT_GT(run.iterations, 3);
  EXPECT_LE(run.iterations, reference::sufficient_iterations(known, 1e-6) + 1);
}

/// ν_h = 564 on 20 × 20 particles without damping.
TEST(ConditionOfASheet, IsThatOfTheFormulas) {
  const double nu = 564, c[] = {1, 2.0 / 3, 0.5};
  const double all[] = {141.1, 135.8, 129.0}, edge[] = {929, 739, 575}, none[] = {4513, 2006, 1129};
  for (int k = 0; k < 3; ++k) {
    const double g = c[k] * c[k] * nu;
    EXPECT_NEAR(stage_eigenvalues(20, g, PinnedBorder::all).condition(), all[k], 2e-3 * all[k]);
    EXPECT_NEAR(stage_eigenvalues(20, g, PinnedBorder::one_edge).condition(), edge[k], 2e-3 * edge[k]);
    EXPECT_NEAR(stage_eigenvalues(20, g, PinnedBorder::none).condition(), none[k], 2e-3 * none[k]);
  }
  EXPECT_NEAR(reference::sufficient_iterations(929, 2e-4), 140.4, 0.1);
}

}  // namespace
}  // namespace drape::verify::condition_test
