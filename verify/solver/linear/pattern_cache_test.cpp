// Analyses of patterns are shared by the runs of a sweep, which does not change what they give.

#include "solver/linear/pattern_cache.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/integrator.hpp"

namespace drape::verify::pattern_cache_test {
namespace {

using solver::pattern_counts;
using solver::PatternCounts;
using solver::SparseMatrix;

/// 1 × n, with ones in these columns.
SparseMatrix row_with(int n, const std::vector<int>& columns) {
  SparseMatrix A(1, n);
  for (const int j : columns) A.insert(0, j) = 1;
  A.makeCompressed();
  return A;
}

/// Values that count how many analyses there were before.
struct Counted {
  solver::PatternCache<int> cache;
  int analyses = 0;

  int of(const SparseMatrix& A) {
    return *cache.of(A, [&] { return std::make_shared<const int>(analyses++); });
  }
};

TEST(PatternCache, KnowsPatternsApart) {
  Counted counted;
  EXPECT_EQ(counted.of(row_with(3, {0, 1})), 0);
  EXPECT_EQ(counted.of(row_with(3, {0, 2})), 1);
  EXPECT_EQ(counted.of(row_with(3, {0})), 2);
  SparseMatrix two_rows(2, 3);
  two_rows.insert(1, 0) = 1;
  two_rows.insert(1, 1) = 1;
  two_rows.makeCompressed();
  EXPECT_EQ(counted.of(two_rows), 3);
  EXPECT_EQ(counted.of(2 * row_with(3, {0, 1})), 0) << "other values";
}

TEST(PatternCache, KeepsTheLastOnesAlone) {
  Counted counted;
  const auto of = [&](int j) { return counted.of(row_with(20, {j})); };
  for (int j = 0; j < 8; ++j) of(j);
  EXPECT_EQ(of(0), 0);
  of(8);
  EXPECT_EQ(of(0), 0) << "used after the one that made place";
  EXPECT_EQ(of(1), 9);
}

/// The analyses that a run asked for, and where it ended.
struct Asked {
  std::int64_t computed = 0, shared = 0;
  solver::Vectors x;
};

Asked run(const char* method, const char* stage, int n) {
  const std::vector<model::Override> size{{"grid.n", std::to_string(n)}};
  const model::Cloth cloth = model::compile(model::load_scene("hung-corners", size));
  solver::Options options;
  options.stage = &solver::stage_kind(stage);
  const PatternCounts before = pattern_counts();
  solver::Integrator integrator(cloth.ode, solver::method(method), options, cloth.start);
  EXPECT_EQ(integrator.step(1e-3).outcome, solver::Outcome::success);
  const PatternCounts after = pattern_counts();
  return {after.computed - before.computed, after.shared - before.shared, integrator.state().x};
}

/// The sizes of others are their own.
struct Sweep {
  const char *method, *stage;
  int n;
};

class RunsOfASweep : public testing::TestWithParam<Sweep> {};

TEST_P(RunsOfASweep, ShareTheOrderingsOfTheFirst) {
  const auto [method, stage, n] = GetParam();
  const Asked first = run(method, stage, n), second = run(method, stage, n), other = run(method, stage, n + 1);
  EXPECT_GE(first.computed, 1);
  EXPECT_EQ(second.computed, 0);
  EXPECT_EQ(second.shared, first.computed + first.shared);
  EXPECT_EQ(second.x, first.x);
  EXPECT_EQ(other.computed, first.computed) << "another size";
}

INSTANTIATE_TEST_SUITE_P(Factors, RunsOfASweep,
                         testing::Values(Sweep{"bdf2", "fixed-point", 13}, Sweep{"bdf2", "newton", 15},
                                         Sweep{"rodas3", "fixed-point", 17}),
                         [](const auto& factor) { return testing::PrintToString(factor.param.n); });

}  // namespace
}  // namespace drape::verify::pattern_cache_test
