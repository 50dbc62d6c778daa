// What counts as accurate, wrong, unstable or not converged.

#include "bench/studies/verdict.hpp"

#include <gtest/gtest.h>

namespace drape::verify::verdict_test {
namespace {

using bench::judge;
using bench::UncertainError;
using bench::Verdict;
using solver::Outcome;

TEST(VerdictOnARun, SeparatesAccurateFromWrongByTheBound) {
  EXPECT_EQ(judge(Outcome::success, {0.9e-2, 0}, 1e-2), Verdict::accurate);
  EXPECT_EQ(judge(Outcome::success, {1.1e-2, 0}, 1e-2), Verdict::wrong);
}

TEST(VerdictOnARun, KnowsNoErrorThatTheReferenceLeavesOpen) {
  EXPECT_EQ(judge(Outcome::success, {0.9e-2, 0.2e-2}, 1e-2), Verdict::bounded);
  EXPECT_EQ(judge(Outcome::success, {1.1e-2, 0.2e-2}, 1e-2), Verdict::bounded);
  EXPECT_EQ(judge(Outcome::success, {}, 1e-2), Verdict::bounded);
}

TEST(VerdictOnARun, OfARunThatFailedIsItsReasonWhateverItsError) {
  const UncertainError small{1e-6, 1e-9};
  EXPECT_EQ(judge(Outcome::unstable, small, 1e-2), Verdict::unstable);
  EXPECT_EQ(judge(Outcome::not_finite, small, 1e-2), Verdict::unstable);
  EXPECT_EQ(judge(Outcome::not_converged, small, 1e-2), Verdict::not_converged);
  EXPECT_EQ(judge(Outcome::breakdown, small, 1e-2), Verdict::not_converged);
  EXPECT_EQ(judge(Outcome::inaccurate, small, 1e-2), Verdict::not_converged);
  EXPECT_EQ(judge(Outcome::failed, small, 1e-2), Verdict::not_converged);
  EXPECT_EQ(judge(Outcome::out_of_evaluations, small, 1e-2), Verdict::not_finished);
}

}  // namespace
}  // namespace drape::verify::verdict_test
