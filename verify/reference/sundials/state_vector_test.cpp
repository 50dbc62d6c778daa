// Our vector of SUNDIALS against SUNDIALS' own serial one: every operation on random numbers, results in place included.

#include "reference/sundials/state_vector.hpp"

#include <gtest/gtest.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace drape::verify::state_vector_test {
namespace {

using reference::sundials_tools::content;
using reference::sundials_tools::make_state_vector;
using reference::sundials_tools::StateVector;

struct Destroy {
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
};
using Owned = std::unique_ptr<_generic_N_Vector, Destroy>;

constexpr int particles = 131, reactions = 7, size = 6 * particles + reactions, count = 7;  // some chunks, the last not full

/// The same numbers in ours and theirs: some of each, and operations that are done to both.
class Pair {
 public:
  Pair() {
    const StateVector zero{
        {solver::Vectors::Zero(particles, 3), solver::Vectors::Zero(particles, 3)}, Eigen::VectorXd::Zero(reactions), size};
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-2, 2);
    for (int k = 0; k < count; ++k) {
      const Eigen::VectorXd numbers = Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(random); });
      ours_.emplace_back(make_state_vector(zero, context_));
      theirs_.emplace_back(N_VNew_Serial(size, context_));
      StateVector& mine = content(ours_.back().get());
      const auto block = [&](Eigen::Index first) { return Eigen::Map<const solver::Vectors>(&numbers[first], particles, 3); };
      mine.state = {block(0), block(3 * particles)};
      mine.reactions = numbers.tail(reactions);
      std::copy_n(numbers.data(), size, N_VGetArrayPointer(theirs_.back().get()));
    }
  }

  using Vectors = std::vector<N_Vector>;
  using Operation = std::function<std::vector<double>(Vectors& v)>;

  /// Does it to both; says how they differ in what is returned or in any vector then, relative to the largest number.
  double difference(const Operation& operation) {
    Vectors a = handles(ours_), b = handles(theirs_);
    const std::vector<double> p = operation(a), q = operation(b);
    double worst = p.size() == q.size() ? 0 : INFINITY;
    for (std::size_t k = 0; k < p.size(); ++k) worst = std::max(worst, std::abs(p[k] - q[k]) / std::max(1.0, std::abs(q[k])));
    for (int k = 0; k < count; ++k) {
      const auto serial = Eigen::Map<const Eigen::VectorXd>(N_VGetArrayPointer(b[k]), size);
      worst = std::max(worst, (numbers(a[k]) - serial).cwiseAbs().maxCoeff() / serial.cwiseAbs().maxCoeff());
    }
    return worst;
  }

  static Eigen::VectorXd numbers(N_Vector vector) {
    const StateVector& mine = content(vector);
    Eigen::VectorXd all(size);
    all << mine.state.x.reshaped<Eigen::RowMajor>(), mine.state.v.reshaped<Eigen::RowMajor>(), mine.reactions;
    return all;
  }

  N_Vector ours(int k) { return ours_[static_cast<std::size_t>(k)].get(); }

 private:
  static Vectors handles(const std::vector<Owned>& owned) {
    Vectors all;
    for (const Owned& one : owned) all.push_back(one.get());
    return all;
  }

  sundials::Context context_;
  std::vector<Owned> ours_, theirs_;
};

struct Case {
  std::string name;
  Pair::Operation operation;
};

using V = Pair::Vectors;

/// An operation that returns nothing.
template <class F>
Pair::Operation silent(F f) {
  return [f](V& v) {
    f(v);
    return std::vector<double>{};
  };
}

std::vector<Case> cases() {
  std::vector<Case> all{
      {"LinearSum", silent([](V& v) { N_VLinearSum(2, v[0], -3, v[1], v[2]); })},
      {"LinearSumInFirst", silent([](V& v) { N_VLinearSum(2, v[0], -3, v[1], v[0]); })},
      {"LinearSumInSecond", silent([](V& v) { N_VLinearSum(1, v[0], -1, v[1], v[1]); })},
      {"LinearSumOfOne", silent([](V& v) { N_VLinearSum(2, v[0], 0.5, v[0], v[0]); })},
      {"Const", silent([](V& v) { N_VConst(0.3, v[1]); })},
      {"Prod", silent([](V& v) { N_VProd(v[0], v[1], v[2]); })},
      {"ProdInPlace", silent([](V& v) { N_VProd(v[0], v[1], v[1]); })},
      {"Div", silent([](V& v) { N_VDiv(v[0], v[1], v[2]); })},
      {"DivInPlace", silent([](V& v) { N_VDiv(v[0], v[1], v[1]); })},
      {"Scale", silent([](V& v) { N_VScale(-0.7, v[0], v[1]); })},
      {"ScaleInPlace", silent([](V& v) { N_VScale(-0.7, v[0], v[0]); })},
      {"Abs", silent([](V& v) { N_VAbs(v[0], v[1]); })},
      {"AbsInPlace", silent([](V& v) { N_VAbs(v[0], v[0]); })},
      {"Inv", silent([](V& v) { N_VInv(v[0], v[1]); })},
      {"InvInPlace", silent([](V& v) { N_VInv(v[0], v[0]); })},
      {"AddConst", silent([](V& v) { N_VAddConst(v[0], 5, v[1]); })},
      {"AddConstInPlace", silent([](V& v) { N_VAddConst(v[0], 5, v[0]); })},
      {"Reductions",
       [](V& v) {
         N_VAbs(v[1], v[2]);
         return std::vector<double>{N_VDotProd(v[0], v[1]),
                                    N_VDotProd(v[0], v[0]),
                                    N_VMaxNorm(v[0]),
                                    N_VWrmsNorm(v[0], v[1]),
                                    N_VWrmsNormMask(v[0], v[1], v[3]),
                                    N_VMin(v[0]),
                                    N_VMin(v[2]),
                                    static_cast<double>(N_VGetLength(v[0]))};
       }},
      {"DotProdMulti",
       [](V& v) {
         std::vector<double> products(count);
         EXPECT_EQ(N_VDotProdMulti(count, v[2], v.data(), products.data()), 0);
         return products;
       }},
      {"VectorArrays", silent([](V& v) {
         std::vector<double> c{2, -1, 0.3};
         N_VScaleVectorArray(3, c.data(), v.data(), v.data());
         N_VLinearSumVectorArray(3, 2, v.data(), 0.1, v.data() + 3, v.data());
         N_VConstVectorArray(2, 4, v.data() + 5);
       })},
      {"Clone", silent([](V& v) {
         const Owned copy(N_VClone(v[0]));
         N_VScale(2, v[0], copy.get());
         N_VLinearSum(1, copy.get(), 1, v[1], v[2]);
       })},
  };
  for (const int vectors : {1, 2, 3, count}) {
    const auto combine = [vectors](V& v, int result) {
      std::vector<double> c{1, -2, 0.5, 3, 0, 7, -0.1};
      EXPECT_EQ(N_VLinearCombination(vectors, c.data(), v.data(), v[static_cast<std::size_t>(result)]), 0);
    };
    all.push_back({"LinearCombination" + std::to_string(vectors), silent([=](V& v) { combine(v, count - 1); })});
    if (vectors == count) all.pop_back();  // theirs may have the result as its first argument only
    all.push_back({"LinearCombinationInFirst" + std::to_string(vectors), silent([=](V& v) { combine(v, 0); })});
    const auto add = [vectors](V& v, bool in_place) {
      std::vector<double> c{1, -2, 0.5, 3, 0, 7};
      N_Vector x = v.back();
      const int few = std::min(vectors, in_place ? 6 : 3);
      EXPECT_EQ(N_VScaleAddMulti(few, c.data(), x, v.data(), in_place ? v.data() : v.data() + 3), 0);
    };
    all.push_back({"ScaleAddMulti" + std::to_string(vectors), silent([=](V& v) { add(v, false); })});
    all.push_back({"ScaleAddMultiInPlace" + std::to_string(vectors), silent([=](V& v) { add(v, true); })});
  }
  return all;
}

class StateVectorOperation : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(, StateVectorOperation, testing::ValuesIn(cases()), [](const auto& test) { return test.param.name; });

TEST_P(StateVectorOperation, IsThatOfTheSerialVector) { EXPECT_LE(Pair().difference(GetParam().operation), 1e-14); }

TEST(StateVectorOperations, MayHaveTheResultAsAnyArgument) {
  for (int result = 0; result < count; ++result) {
    Pair pair;
    std::vector<N_Vector> v;
    std::vector<double> c{1, -2, 0.5, 3, 0, 7, -0.1};
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(size);
    for (int k = 0; k < count; ++k) {
      v.push_back(pair.ours(k));
      sum += c[static_cast<std::size_t>(k)] * Pair::numbers(v.back());
    }
    N_VLinearCombination(count, c.data(), v.data(), v[static_cast<std::size_t>(result)]);
    EXPECT_LE((Pair::numbers(v[static_cast<std::size_t>(result)]) - sum).norm(), 1e-14 * sum.norm());
  }
}

TEST(StateVector, CountsOnlyTheUnknownsInItsNorms) {
  sundials::Context context;
  StateVector half{{solver::Vectors::Constant(10, 3, 2), solver::Vectors::Zero(10, 3)}, {}, 30};
  const Owned x(make_state_vector(half, context)), weights(N_VClone(x.get()));
  N_VConst(3, weights.get());
  EXPECT_DOUBLE_EQ(N_VWrmsNorm(x.get(), weights.get()), 6);
  EXPECT_EQ(N_VGetLength(x.get()), 30);
}

TEST(StateVector, ClonesDoNotShareMemory) {
  Pair pair;
  const Eigen::VectorXd before = Pair::numbers(pair.ours(0));
  const Owned copy(N_VClone(pair.ours(0)));
  N_VConst(1, copy.get());
  EXPECT_EQ(Pair::numbers(pair.ours(0)), before);
}

}  // namespace
}  // namespace drape::verify::state_vector_test
