// What linear theory predicts of methods on sheets, against the running code.

#include "reference/theory/linear_prediction.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace drape::verify::linear_prediction_test {
namespace {

using reference::predict;
using solver::method;

constexpr double undamped = std::numeric_limits<double>::infinity();

TEST(LinearPrediction, FindsNoGrowthWhereMethodsAreStable) {
  for (const char* name : {"imex-euler", "implicit-euler", "sbdf2", "bdf2", "midpoint", "imex-midpoint", "tr-bdf2"})
    for (const double nu : {1e0, 1e7})
      for (const double ratio : {1e-2, 1e6, undamped}) EXPECT_LT(predict(method(name), nu, ratio)->radius, 1 + 1e-5) << name;
}

TEST(LinearPrediction, KnowsHowMuchDampingTheHigherBdfNeed) {
  // They grow where a root of μ² + s μ + W = 0 is too near the imaginary axis: at h ω of about 1, s = ω² h²/ratio.
  const auto stable = [](const char* name, double ratio) { return predict(method(name), 1e3, ratio)->radius < 1 + 1e-5; };
  EXPECT_TRUE(stable("bdf3", 1) && stable("bdf4", 1) && stable("bdf5", 0.3));
  EXPECT_FALSE(stable("bdf5", 3));
  EXPECT_TRUE(stable("bdf3", 3));
  EXPECT_FALSE(stable("bdf4", 30) || stable("bdf5", 30) || stable("bdf3", undamped));
}

TEST(LinearPrediction, SeesTheThesisLoopSlowDownWithStiffnessOverDamping) {
  EXPECT_NEAR(predict(method("implicit-euler"), 1e7, 1)->loop, 0.5, 1e-3);  // γ² ν/(1 + γ² ν + γ s) with s = ν
  EXPECT_NEAR(predict(method("bdf2"), 1e7, 1)->loop, 0.4, 1e-3);
  EXPECT_GT(predict(method("bdf2"), 1e7, undamped)->loop, 0.999);
  EXPECT_EQ(predict(method("sbdf2"), 1e7, 1)->loop, 0);
}

}  // namespace
}  // namespace drape::verify::linear_prediction_test
