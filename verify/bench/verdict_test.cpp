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
  EXPECT_EQ(judge(Outcome::success, true, {0.9e-2, 0}, 1e-2), Verdict::accurate);
  EXPECT_EQ(judge(Outcome::success, true, {1.1e-2, 0}, 1e-2), Verdict::wrong);
}

TEST(VerdictOnARun, KnowsNoErrorThatTheReferenceLeavesOpen) {
  EXPECT_EQ(judge(Outcome::success, true, {0.9e-2, 0.2e-2}, 1e-2), Verdict::bounded);
  EXPECT_EQ(judge(Outcome::success, true, {1.1e-2, 0.2e-2}, 1e-2), Verdict::bounded);
  EXPECT_EQ(judge(Outcome::success, true, {}, 1e-2), Verdict::bounded);
}

TEST(VerdictOnARun, OfARunThatFailedIsItsReasonWhateverItsError) {
  const UncertainError small{1e-6, 1e-9};
  EXPECT_EQ(judge(Outcome::unstable, true, small, 1e-2), Verdict::unstable);
  EXPECT_EQ(judge(Outcome::not_finite, true, small, 1e-2), Verdict::unstable);
  EXPECT_EQ(judge(Outcome::not_converged, true, small, 1e-2), Verdict::not_converged);
  EXPECT_EQ(judge(Outcome::breakdown, true, small, 1e-2), Verdict::not_converged);
  EXPECT_EQ(judge(Outcome::inaccurate, true, small, 1e-2), Verdict::not_converged);
  EXPECT_EQ(judge(Outcome::failed, true, small, 1e-2), Verdict::not_converged);
  EXPECT_EQ(judge(Outcome::success, false, small, 1e-2), Verdict::not_finished);
}

}  // namespace
}  // namespace drape::verify::verdict_test
