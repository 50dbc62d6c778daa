// Sheets meet obstacles: at rest the multipliers carry the weight, energy is only lost, two responses that share no code agree,
// and the filtered conjugate gradients solve the constrained system.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <random>
#include <utility>

#include "reference/reference.hpp"
#include "reference/stepped.hpp"
#include "solver/linear/conjugate_gradients.hpp"
#include "verify/support/contact_scenes.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_matrices.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::contact_sheet_test {
namespace {

using namespace contact_scenes;
using solver::Outcome;
using solver::Vectors;

constexpr double g = 9.81;
const std::string table =
    "obstacles = [{ shape = 'box', size = [0.2, 0.2, 0.04], position = [0.15, 0.15, -0.04], friction = 0.3 }]\n";
const std::string ball = "obstacles = [{ shape = 'sphere', radius = 0.1, position = [0.14, 0.15, -0.12], friction = 0.3 }]\n";
const std::string floor_below = "obstacles = [{ shape = 'plane', position = [0, 0, -0.1], friction = 0.3 }]\n";

class SheetContact : public testing::TestWithParam<std::string> {
 protected:
  const std::string& method = GetParam();
};
INSTANTIATE_TEST_SUITE_P(, SheetContact, testing::ValuesIn(methods()), [](const auto& test) {
  std::string name = test.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST_P(SheetContact, ComesToRestOnAFloorWithoutBouncing) {
  const Trial trial = sheet(floor_below + "end.time = 0.6\n");
  const double h = 0.005, border = -0.1 + 5e-3;
  const auto moments = run(trial, method, h);
  for (const Moment& moment : moments) {
    EXPECT_GE(moment.y.x.col(2).minCoeff(), border - 1e-12);
    if (moment.t > 0.15) {
      EXPECT_LE(moment.y.x.col(2).maxCoeff(), border + 1e-9) << moment.t << ": the fall takes 0.139 s";
    }
  }
  EXPECT_LE(moments.back().y.v.norm(), 1e-9);
  EXPECT_NEAR(moments.back().contacts.impulse[2] / h, trial.cloth.ode.mass.sum() * g, 1e-6);
  EXPECT_LE(energy_rise(moments), 1e-6 * trial.cloth.ode.mass.sum() * g * 0.1);
}

TEST_P(SheetContact, OnATableOrABallLosesEnergyOnly) {
  for (const std::string& obstacle : {table, ball}) {
    const Trial trial = sheet(obstacle + "end.time = 0.5\n");
    const auto moments = run(trial, method, 0.0025);
    const double fall = trial.cloth.ode.mass.sum() * g * 0.1;
    EXPECT_LE(energy_rise(moments), 1e-4 * fall) << obstacle;
    EXPECT_GE(clearance(trial, moments), 5e-3 - 1e-6) << obstacle;
    EXPECT_GT(moments.back().contacts.constrained, 0) << obstacle;
  }
}

/// Friction over pressure, both summed over all steps, of a tilted sheet that is thrown on a floor and slides on.
double friction_over_pressure(const std::string& method, double h) {
  const Trial trial = sheet(floor_below + "start = { rotation = [0, 10, 0], velocity = [3, 0, 0] }\nend.time = 0.3\n");
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();
  for (const Moment& moment : run(trial, method, h)) impulse += moment.contacts.impulse;
  return impulse.head<2>().norm() / impulse[2];
}

TEST_P(SheetContact, RubsByCoulombsLawInTotal) { EXPECT_NEAR(friction_over_pressure(method, 0.000625), 0.3, 0.02); }

/// While not all contacts are found, few particles carry what all will: friction that is decided then is three times as much.
TEST(Friction, IsDecidedWhenContactsAreFound) {
  for (const char* method : {"imex-euler", "sbdf2"}) EXPECT_NEAR(friction_over_pressure(method, 0.02), 0.3, 0.06) << method;
}

/// Anderson's method restarts where contacts change.
TEST(StagesInContact, AreAcceleratedToTheSameMotion) {
  for (const std::string& obstacle : {table, ball})
    for (const char* method : {"implicit-euler", "bdf2", "midpoint"}) {
      const auto solved = [&](const char* stage) {
        Trial trial = sheet(obstacle + "end.time = 0.3\n");
        solver::Options options;
        options.loop_tolerance = 1e-8;
        options.stage = &solver::stage_kind(stage);
        Moment last = run(trial, method, 0.01, options).back();
        EXPECT_GT(last.contacts.constrained, 0);
        return std::pair(std::move(last), trial.cloth.ode.work->count("updates"));
      };
      const auto [plain, plain_updates] = solved("fixed-point");
      for (const char* stage : {"anderson", "auto"}) {
        const auto [accelerated, updates] = solved(stage);
        EXPECT_LE(reference::rms_distance(accelerated.y.x, plain.y.x), 1e-6 * 0.3) << obstacle << method << " " << stage;
        EXPECT_LT(updates, plain_updates / 2) << obstacle << method << " " << stage;
      }
    }
}

/// The distance of a method at h from the reference of a scene, and the reference's own uncertainty, over the sheet's size.
struct Distance {
  double error, uncertainty;
};

Distance distance(const Trial& trial, const reference::Reference& reference, const std::string& method, double h) {
  solver::Options tight;
  tight.loop_tolerance = 1e-8;
  tight.cg_tolerance = 1e-9;
  const Moment last = run(trial, method, h, tight).back();
  return {reference::rms_distance(last.y.x, reference.trajectory.states.back().x) / 0.3,
          *std::ranges::max_element(reference.error) / 0.3};
}

TEST(ContactReference, IsApproachedByEveryMethod) {
  DRAPE_SLOW();
  for (const std::string& obstacle : {table, ball}) {
    const Trial trial = sheet(obstacle + "end.time = 0.3\n");
    const std::vector<double> times{0.1, 0.2, 0.3};
    const auto truth = reference::contact_reference(trial.cloth.ode, trial.cloth.start, 0, times, {.size = 0.3});
    EXPECT_EQ(truth.name, "verlet");
    EXPECT_EQ(truth.witness, "midpoint");
    const auto doubled = reference::stepped(trial.cloth.ode, solver::method("verlet"), trial.cloth.start, 0, times, 1e-3);
    for (std::size_t k = 0; k < times.size(); ++k)
      EXPECT_GE(truth.error[k], reference::rms_distance(truth.trajectory.states[k].x, doubled.states[k].x)) << "of the steps";
    for (const std::string& method : methods()) {
      const Distance coarse = distance(trial, truth, method, 0.004), fine = distance(trial, truth, method, 0.001);
      EXPECT_LE(fine.uncertainty, 1e-4) << obstacle;
      EXPECT_LE(fine.error, std::max(0.6 * coarse.error, 5e-4)) << method << " " << obstacle;
      EXPECT_LE(fine.error, method.starts_with("imex-e") ? 0.05 : 5e-3) << method << " " << obstacle;
    }
  }
}

TEST(ContactReference, SaysThatItFailed) {
  Trial trial = sheet(table + "end.time = 0.1\n");
  trial.cloth.ode.force = [](double, const Vectors&, const Vectors&, Vectors& f) { f.setConstant(std::nan("")); };
  const std::vector<double> times{0.1};
  EXPECT_THROW(reference::contact_reference(trial.cloth.ode, trial.cloth.start, 0, times, {.size = 0.3}),
               reference::ReferenceError);
}

TEST(FilteredConjugateGradients, SolveTheConstrainedSystem) {
  const int n = 20;
  const small_problems::SparseMatrix A = small_matrices::sheet(5, 4);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized(); };
  solver::Filter filter;
  Eigen::MatrixXd P = Eigen::MatrixXd::Identity(3 * n, 3 * n);
  for (const int i : {0, 3, 7, 8, 19}) {  // constrained in one, two or three directions
    const Eigen::Vector3d a = direction(), b = a.cross(direction()).normalized();
    Eigen::Matrix3d free = Eigen::Matrix3d::Identity() - a * a.transpose();
    if (i % 2 == 1) free -= b * b.transpose();
    if (i == 7) free.setZero();
    filter.add(i, free);
    P.block<3, 3>(3 * i, 3 * i) = free;
  }
  for (const solver::LinearSolver& kind : solver::linear_solvers()) {
    solver::Counters work;
    solver::ConjugateGradients cg(kind.make(), 1000, work);
    cg.analyse(A);
    ASSERT_EQ(cg.factor(A), Outcome::success);
    Vectors b = small_problems::noise(n, 9);
    filter(b);
    Vectors r = b, d(n, 3);
    ASSERT_EQ(cg.solve(A, filter, r, d, 1e-13).outcome, Outcome::success);

    // P A P d = b, d = P d: nonsingular with the identity on the constrained directions
    const Eigen::MatrixXd full = small_problems::threefold(A);
    const Eigen::MatrixXd dense = P * full * P + Eigen::MatrixXd::Identity(3 * n, 3 * n) - P;
    const Eigen::VectorXd expected = dense.llt().solve(Eigen::VectorXd::Map(b.data(), 3 * n));
    EXPECT_LE((Eigen::VectorXd::Map(d.data(), 3 * n) - expected).cwiseAbs().maxCoeff(), 1e-11) << kind.name;
  }
}

TEST(NoObstacle, NoDetectionAndNoMemory) {
  const Trial trial = sheet("end.time = 0.05\n");
  run(trial, "bdf2", 0.01);
  EXPECT_EQ(trial.cloth.contacts, nullptr);
  EXPECT_FALSE(trial.cloth.ode.contacts);
  for (const solver::Counters::Kind& kind : trial.cloth.ode.work->kinds())
    if (kind.name == "obstacle_queries" || kind.name == "constrained_particles" || kind.name == "contact_changes") {
      EXPECT_EQ(kind.count, 0) << kind.name;
    }
}

TEST(FarObstacles, AreAskedOnceAndThenLeftAlone) {
  const Trial trial = sheet("obstacles = [{ shape = 'sphere', radius = 0.1, position = [0, 0, -90] }]\nend.time = 0.1\n");
  run(trial, "sbdf2", 0.01);
  EXPECT_EQ(trial.cloth.ode.work->count("obstacle_queries"), 49);
  EXPECT_EQ(trial.cloth.ode.work->count("constrained_particles"), 0);
}

TEST(RestingContact, CostsOneLinearSystemAStepAtRest) {
  const Trial trial = sheet(floor_below + "end.time = 0.5\n");
  run(trial, "sbdf2", 0.01);
  EXPECT_LE(trial.cloth.ode.work->count("updates"), 50 + 4) << "except at the impact";
  EXPECT_GE(trial.cloth.ode.work->count("constrained_particles"), 49 * 35);
}

/// Reaction constraints need steps that their springs' time resolves, and no loop over a force that is switched.
TEST(ReactionConstraints, BringASheetToRestNearTheBorder) {
  for (const std::string method : {"imex-euler", "sbdf2", "verlet"}) {
    const Trial trial = sheet(floor_below + "contact.response = 'reaction'\ncontact.reaction_time = 0.005\nend.time = 0.8\n");
    EXPECT_FALSE(trial.cloth.ode.contacts) << "they are forces";
    const auto moments = run(trial, method, 0.001);
    EXPECT_NEAR(moments.back().y.x.col(2).minCoeff(), -0.095, 1e-4) << method;
    EXPECT_NEAR(moments.back().y.x.col(2).maxCoeff(), -0.095, 1e-3) << method;
    EXPECT_GE(clearance(trial, moments), 0) << method;
    EXPECT_LE(kinetic_energy(trial.cloth.ode, moments.back().y.v), 1e-6) << method;
  }
}

TEST(ReactionConstraints, LetGoOfWhatIsPulledAway) {
  const std::vector<model::Override> wind{{"forces.wind", "[0, 0, 19.62]"}, {"forces.drag", "1"}, {"forces.lift", "1"}};
  const Trial trial = particles(
      "contact = { distance = 0.01, response = 'reaction' }\nend.time = 0.02\n"
      "obstacles = [{ shape = 'plane', position = [0, 0, -0.005] }]\n",
      wind);
  const Moment last = run(trial, "verlet", 0.0005).back();
  EXPECT_NEAR(last.y.v(0, 2), g * 0.02, 1e-9) << "twice its weight lifts it freely, though in the collision area";
}

TEST(ReactionConstraints, BrakeASlidingParticle) {
  const Trial trial = particles(
      "contact = { distance = 0.01, response = 'reaction', reaction_time = 0.005 }\nstart.velocity = [1, 0, 0]\nend.time = "
      "0.2\n"
      "obstacles = [{ shape = 'plane', position = [0, 0, -0.0099], friction = 0.3 }]\n");
  const auto moments = run(trial, "verlet", 0.0005);
  EXPECT_NEAR(moments.back().y.v(0, 0), 1 - 0.3 * g * 0.2, 0.02);
}

}  // namespace
}  // namespace drape::verify::contact_sheet_test
