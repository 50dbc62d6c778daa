// What counts as accurate, wrong, unstable or not converged.

#include <gtest/gtest.h>

#include "bench/studies/stability/stability.hpp"

namespace drape::verify::classification_test {
namespace {

using bench::Classification;
using bench::classify;
using bench::UncertainError;
using solver::Outcome;

TEST(ClassificationOfARun, SeparatesAccurateFromWrongByTheBound) {
  EXPECT_EQ(classify(Outcome::success, {0.9e-2, 0}, 1e-2), Classification::accurate);
  EXPECT_EQ(classify(Outcome::success, {1.1e-2, 0}, 1e-2), Classification::wrong);
}

TEST(ClassificationOfARun, KnowsNoErrorThatTheReferenceLeavesOpen) {
  EXPECT_EQ(classify(Outcome::success, {0.9e-2, 0.2e-2}, 1e-2), Classification::bounded);
  EXPECT_EQ(classify(Outcome::success, {1.1e-2, 0.2e-2}, 1e-2), Classification::bounded);
  EXPECT_EQ(classify(Outcome::success, {}, 1e-2), Classification::bounded);
}

TEST(ClassificationOfARun, OfARunThatFailedIsItsReasonWhateverItsError) {
  const UncertainError small{1e-6, 1e-9};
  EXPECT_EQ(classify(Outcome::unstable, small, 1e-2), Classification::unstable);
  EXPECT_EQ(classify(Outcome::not_finite, small, 1e-2), Classification::unstable);
  EXPECT_EQ(classify(Outcome::not_converged, small, 1e-2), Classification::not_converged);
  EXPECT_EQ(classify(Outcome::breakdown, small, 1e-2), Classification::not_converged);
  EXPECT_EQ(classify(Outcome::inaccurate, small, 1e-2), Classification::not_converged);
  EXPECT_EQ(classify(Outcome::failed, small, 1e-2), Classification::not_converged);
  EXPECT_EQ(classify(Outcome::out_of_evaluations, small, 1e-2), Classification::not_finished);
}

}  // namespace
}  // namespace drape::verify::classification_test
