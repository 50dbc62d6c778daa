// A reference is believed because two solvers of different families agree, and used where the problem is well conditioned.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/reference.hpp"
#include "solver/base/largest.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::certified_reference_test {
namespace {

using namespace small_problems;
using reference::certify;
using reference::NotCertified;
using reference::Reference;
using reference::ReferenceError;
using reference::rms_distance;
using testing::AllOf;
using testing::HasSubstr;

const std::vector<double> times{start_time + 0.2, start_time + 0.7, start_time + 1, start_time + 1.5};

Reference reference_of(const Problem& problem, double rtol) {
  return reference::reference(problem.ode, problem.start, start_time, times, {.rtol = rtol});
}

class CertifiedReferenceOf : public testing::TestWithParam<std::string> {
 protected:
  const Problem problem = problem_named(GetParam());

  double worst_error(const Reference& reference) const {
    double worst = 0;
    for (std::size_t k = 0; k < times.size(); ++k)
      worst = base::larger(worst, rms_distance(reference.trajectory.states[k].x, problem.exact(times[k]).x));
    return worst;
  }
};
INSTANTIATE_TEST_SUITE_P(, CertifiedReferenceOf, testing::ValuesIn(names(problems())),
                         [](const auto& test) { return test.param; });

TEST_P(CertifiedReferenceOf, DisagreesByItsErrorNeitherMoreNorLess) {
  for (const double rtol : {1e-6, 1e-8, 1e-10}) {
    const Reference reference = reference_of(problem, rtol);
    const double error = worst_error(reference), uncertainty = std::ranges::max(reference.error);
    EXPECT_GE(uncertainty, error / 2) << "at rtol = " << rtol;
    EXPECT_LE(uncertainty, 30 * error) << "at rtol = " << rtol;
    EXPECT_EQ(reference.tolerance, rtol);
  }
}

TEST_P(CertifiedReferenceOf, NamesBothFamiliesAndHasAnUncertaintyForEveryTime) {
  const Reference reference = reference_of(problem, 1e-6);
  EXPECT_EQ(reference.name, "cvode-bdf");
  EXPECT_EQ(reference.witness, "arkode-esdirk");
  EXPECT_EQ(reference.trajectory.times, times);
  for (const auto* series : {&reference.error, &reference.growth}) EXPECT_EQ(series->size(), times.size());
}

model::Cloth hung_sheet(std::vector<model::Override> overrides) {
  overrides.insert(overrides.begin(), {"grid.n", "6"});
  return compile(model::load_scene("hung-corners", overrides));
}

TEST(CertifiedReference, IsTheSameByTwoThreads) {
  const std::vector<double> ends{0.1, 0.2};
  const model::Cloth cloth = hung_sheet({{"material.damping", "5"}}), twin = hung_sheet({{"material.damping", "5"}});
  const auto solve = [&](const reference::Equations& equations) {
    return reference::reference(equations, cloth.start, 0, ends, {.rtol = 1e-8, .size = 0.8});
  };
  const Reference alone = solve({cloth.ode, cloth.ode}), together = solve({cloth.ode, twin.ode});
  EXPECT_EQ(together.error, alone.error);
  EXPECT_EQ(together.growth, alone.growth);
  for (std::size_t k = 0; k < ends.size(); ++k) {
    EXPECT_EQ(together.trajectory.states[k].x, alone.trajectory.states[k].x);
    EXPECT_EQ(together.witnessed.states[k].v, alone.witnessed.states[k].v);
  }
  EXPECT_EQ(twin.ode.work->count("reference/klu_fallbacks"), 0);
  EXPECT_GT(twin.ode.work->count("arkode/steps"), 0) << "the witness is the second thread's";
  EXPECT_EQ(cloth.ode.work->count("reference/klu_fallbacks"), 0);
}

/// The equation of a scene whose first `calls` evaluations fail, each at the beginning of a motion.
solver::SplitOde failing_at_first(const model::Cloth& cloth, int calls) {
  solver::SplitOde ode = cloth.ode;
  ode.force = [calls, force = ode.force](double t, const Vectors& x, const Vectors& v, Vectors& f) mutable {
    if (calls-- > 0) throw std::runtime_error("not yet");
    force(t, x, v, f);
  };
  return ode;
}

TEST(CertifiedReference, HasIdaInThePlaceOfTheFamilyThatStops) {
  const std::vector<model::Override> damping{{"material.damping", "5"}};
  const model::Cloth cloth = hung_sheet(damping), twin = hung_sheet(damping);
  const auto solve = [&](const SplitOde& first, const SplitOde& second) {
    return reference::reference({first, second}, cloth.start, 0, std::vector{0.1, 0.2}, {.rtol = 1e-8, .size = 0.8});
  };
  const auto expect = [](const Reference& reference, const char* name) {
    EXPECT_EQ(reference.name, name);
    EXPECT_EQ(reference.witness, "ida-bdf");
    EXPECT_LE(std::ranges::max(reference.error), 1e-6);
    EXPECT_GT(std::ranges::max(reference.error), 0);
  };
  expect(solve(cloth.ode, failing_at_first(twin, 2)), "cvode-bdf");  // with our factor and with KLU
  expect(solve(failing_at_first(cloth, 4), twin.ode), "arkode-esdirk");
  EXPECT_THROW(solve(cloth.ode, failing_at_first(twin, 100)), ReferenceError);
}

TEST(CertifiedReference, FallsBackOnTheExactJacobianWhereDampingIsStiff) {
  const model::Cloth cloth = hung_sheet({{"material.damping", "1e7"}});
  const Reference reference =
      reference::reference(cloth.ode, cloth.start, 0, std::vector{0.5, 1.0}, {.rtol = 1e-9, .size = 0.8});
  EXPECT_LE(std::ranges::max(reference.error), 1e-8 * 0.8);
  EXPECT_GT(cloth.ode.work->count("reference/klu_fallbacks"), 0);
}

TEST(CertifiedReference, ExistsWhereASheetHasHardlyAnyMass) {
  const model::Cloth cloth = hung_sheet({{"material.density", "1e-6"}});
  const Reference reference = reference::reference(cloth.ode, cloth.start, 0, std::vector{0.1}, {.rtol = 1e-9, .size = 0.8});
  EXPECT_LE(std::ranges::max(reference.error), 1e-8 * 0.8);
}

TEST(CertifiedReference, SeesThatTwoFamiliesFollowDifferentForces) {
  // ARKODE asks for the force at other times than CVODE: a force that flickers is not the same to both.
  Problem problem = free_particles();
  problem.ode.force = [force = problem.ode.force](double t, const Vectors& x, const Vectors& v, Vectors& f) {
    force(t, x, v, f);
    f.array() += 1e-3 * std::sin(1e7 * t);
  };
  const Reference reference = reference::reference(problem.ode, problem.start, start_time, times, {.rtol = 1e-4});
  EXPECT_THROW(certify(reference, 1e-9, 1e9, 1), NotCertified);
}

/// Families that disagree by 2 µm, and perturbations that grow 200-fold later.
Reference some_reference() {
  Reference reference;
  reference.name = "a";
  reference.witness = "b";
  reference.error = {2e-6, 5e-6};
  reference.growth = {1, 200};
  reference.trajectory.times = {0.1, 0.2};
  return reference;
}

std::string complaint(const Reference& reference, double agreement, double growth, double size) {
  try {
    certify(reference, agreement, growth, size);
    return "";
  } catch (const NotCertified& error) {
    return error.what();
  }
}

TEST(Certificate, IsRefusedWhereFamiliesDisagreeByMoreThanAllowed) {
  const Reference reference = some_reference();
  EXPECT_EQ(complaint(reference, 1.1e-5, 1000, 0.5), "");
  EXPECT_THAT(complaint(reference, 0.9e-5, 1000, 0.5),
              AllOf(HasSubstr("a and b disagree by 1e-05"), HasSubstr("t = 0.2 s"), HasSubstr("at most 9e-06")));
  EXPECT_THAT(complaint(reference, 3e-6, 1000, 0.5), HasSubstr("t = 0.1 s")) << "the first time is named";
}

TEST(Certificate, IsNotAskedForWherePerturbationsGrow) {
  EXPECT_EQ(complaint(some_reference(), 5e-6, 100, 0.5), "");
  EXPECT_NE(complaint(some_reference(), 5e-6, 201, 0.5), "");
}

TEST(Certificate, IsAskedForIfTheGrowthIsNotANumber) {
  Reference reference = some_reference();
  reference.growth[0] = std::nan("");
  EXPECT_THAT(complaint(reference, 1e-6, 100, 1), HasSubstr("t = 0.1 s"));
}

TEST(Certificate, IsRefusedIfTheDisagreementIsNotANumber) {
  Reference reference = some_reference();
  reference.error[0] = std::nan("");
  EXPECT_THAT(complaint(reference, 1, 100, 1), HasSubstr("nan"));
}

TEST(Largest, IsNotANumberIfOneIsNone) {
  EXPECT_TRUE(std::isnan(base::larger(1, std::nan(""))));
  EXPECT_TRUE(std::isnan(base::larger(std::nan(""), 1)));
  EXPECT_EQ(base::larger(1, 2), 2);
  EXPECT_EQ(base::larger(2, 1), 2);
  EXPECT_TRUE(std::isnan(base::largest(std::vector{1.0, std::nan(""), 3.0})));
  EXPECT_EQ(base::largest(std::vector{1.0, 4.0, 3.0}), 4);
}

}  // namespace
}  // namespace drape::verify::certified_reference_test
