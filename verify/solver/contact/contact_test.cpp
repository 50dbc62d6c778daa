// Particles meet obstacles as mechanics says: they come to rest at the border of the collision area, slide by Coulomb's law,
// and leave when nothing presses them.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "verify/support/contact_scenes.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::contact_test {
namespace {

using namespace contact_scenes;
using solver::Vectors;

constexpr double g = 9.81;

class Contact : public testing::TestWithParam<std::string> {
 protected:
  const std::string& method = GetParam();
};
INSTANTIATE_TEST_SUITE_P(, Contact, testing::ValuesIn(methods()), [](const auto& test) {
  std::string name = test.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

const std::string floor_below =
    "contact.distance = 0.01\nobstacles = [{ shape = 'plane', position = [0, 0, -0.31], friction = 0.3 }]\n";

TEST_P(Contact, DropsComeToRestAtTheBorderWithoutBouncing) {
  const Trial trial = particles(floor_below + "end.time = 0.5");
  const auto moments = run(trial, method, 0.013);
  for (const Moment& moment : moments) {
    EXPECT_GE(moment.y.x.col(2).minCoeff(), -0.3 - 1e-12);
    if (moment.t > 0.27) {
      EXPECT_LE(moment.y.x.col(2).maxCoeff(), -0.3 + 1e-12) << moment.t << ": the fall takes 0.247 s";
    }
  }
  EXPECT_LE(moments.back().y.v.norm(), 1e-12);
  EXPECT_EQ(moments.back().contacts.constrained, 4);
  EXPECT_LE(energy_rise(moments), 1e-15);
}

TEST_P(Contact, LeavesTheCollisionAreaGradually) {
  for (const double omega : {0.5, 0.25}) {
    const Trial trial = particles(fmt::format(
        "contact = {{ distance = 0.01, relaxation = {} }}\nobstacles = [{{ shape = 'plane', position = [0, 0, -0.002] }}]\n"
        "end.time = 0.05\n",
        omega));
    const auto moments = run(trial, method, 0.01);
    for (std::size_t k = 1; k < moments.size(); ++k) {
      const double depth = 0.008 - moments[k].y.x(0, 2), before = 0.008 - moments[k - 1].y.x(0, 2);
      EXPECT_NEAR(depth, (1 - omega) * before, 1e-12) << omega << ", step " << k;
    }
  }
}

TEST_P(Contact, AreNotTunnelledByLongSteps) {
  const Trial trial = particles("obstacles = [{ shape = 'box', size = [1, 1, 0.001], position = [0, 0, -0.5] }]\nend.time = 2");
  const auto moments = run(trial, method, 0.25);
  EXPECT_NEAR(moments.back().y.x.col(2).minCoeff(), -0.4945, 1e-12);
}

TEST_P(Contact, RestCarriesTheWeight) {
  const Trial trial = particles(floor_below + "end.time = 0.5");
  const double h = 0.01, weight = trial.cloth.ode.mass.sum() * g;
  const Moment last = run(trial, method, h).back();
  EXPECT_NEAR(last.contacts.impulse[2] / h, weight, 1e-12);
  EXPECT_LE(last.contacts.impulse.head<2>().norm(), 1e-15);
}

/// An inclined plane through the origin, rising along x, on whose collision area the particles begin.
std::string incline(double degrees, double friction) {
  return fmt::format(
      "contact.distance = 0.01\nstart.velocity = [0, 0, 0]\n"
      "obstacles = [{{ shape = 'plane', rotation = [0, {}, 0], friction = {} }}]\nend.time = 0.3\n",
      -degrees, friction);
}

/// The particles in one point on the border of the collision area of such a plane.
void put_on(Trial& trial, double degrees) {
  const double a = degrees * M_PI / 180;
  trial.cloth.start.x.rowwise() = Eigen::RowVector3d(-0.01 * std::sin(a), 0, 0.01 * std::cos(a));
}

TEST_P(Contact, SlidesDownAnInclineByCoulombsLaw) {
  for (const double friction : {0.0, 0.2, 0.5}) {
    Trial trial = particles(incline(40, friction));
    put_on(trial, 40);
    const double a = 40 * M_PI / 180, h = 0.01;
    const auto moments = run(trial, method, h);
    const double acceleration = g * (std::sin(a) - friction * std::cos(a));
    const Eigen::RowVector3d down(-std::cos(a), 0, -std::sin(a));
    const Moment& last = moments.back();
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(last.y.v.row(i).dot(down), acceleration * last.t, 1e-11) << friction;
      EXPECT_NEAR((last.y.x.row(i) - moments.front().y.x.row(i)).dot(down), acceleration * last.t * last.t / 2,
                  acceleration * last.t * h / 2 + 1e-11)
          << friction << ": Euler's error";
    }
    EXPECT_NEAR(clearance(trial, moments), 0.01, 1e-12);
  }
}

TEST_P(Contact, SticksBelowTheFrictionAngle) {
  Trial trial = particles(incline(16, 0.3));  // tan 16° = 0.287
  put_on(trial, 16);
  const Moment last = run(trial, method, 0.01).back();
  EXPECT_LE((last.y.x - trial.cloth.start.x).norm(), 1e-12);
  EXPECT_NEAR(last.contacts.impulse.norm() / 0.01, trial.cloth.ode.mass.sum() * g, 1e-12)
      << "friction and normal force together";

  Trial steeper = particles(incline(18, 0.3));  // tan 18° = 0.325
  put_on(steeper, 18);
  EXPECT_GE((run(steeper, method, 0.01).back().y.x - steeper.cloth.start.x).norm(), 1e-3);
}

TEST_P(Contact, SlidingComesToAnEndInFiniteTime) {
  Trial trial = particles(
      "contact.distance = 0.01\nobstacles = [{ shape = 'plane', position = [0, 0, -0.01], friction = 0.4 }]\n"
      "start.velocity = [1.0, 0.5, 0]\nend.time = 0.5\n");
  const double h = 0.005, v0 = std::hypot(1.0, 0.5), a = 0.4 * g;
  const auto moments = run(trial, method, h);
  const Eigen::RowVector3d way = moments.back().y.x.row(0) - moments.front().y.x.row(0);
  EXPECT_NEAR(way.norm(), v0 * v0 / (2 * a), v0 * h) << "first order in time";
  EXPECT_NEAR(way[1] / way[0], 0.5, 1e-9) << "straight on";
  EXPECT_LE(moments.back().y.v.norm(), 1e-12);
  EXPECT_LE(energy_rise(moments), 1e-15);
}

TEST_P(Contact, EndsWhenTheLiftedPlateStops) {
  // At 0.2 s a plate that rises with 1 m/s stops: what lies on it flies on, to come back at 0.2 + 2/g = 0.404 s.
  const Trial trial = particles(
      "contact.distance = 0.01\nend.time = 0.5\n"
      "obstacles = [{ shape = 'plane', motion = [{ time = 0, position = [0, 0, -0.01] }, { time = 0.2, position = [0, 0, 0.19] "
      "}] }]\n");
  for (const double h : {0.01, 0.02 / 3}) {
    const auto moments = run(trial, method, h);
    for (const Moment& moment : moments) {
      const double flight = moment.t - 0.2;
      if (moment.t < 1e-9 || std::abs(flight - 2 / g) < 1.01 * h) continue;
      const bool flies = flight > 1e-9 && flight < 2 / g;
      EXPECT_EQ(moment.contacts.constrained, flies ? 0 : 4) << moment.t;
      const double height = flies ? 0.2 + flight - g / 2 * flight * flight : std::min(moment.t, 0.2);
      EXPECT_NEAR(moment.y.x(0, 2), height, flies ? g * flight * h / 2 + 1e-12 : 1e-12) << moment.t;
    }
  }
}

/// Wind in any direction without regard to the surface, growing from 0 as sin ωt: load in N/m², of which the particles weigh
/// ρ g = 9.81.
std::vector<model::Override> wind(const std::string& load) {
  return {{"forces.wind", load},
          {"forces.wind_constant", "0"},
          {"forces.wind_frequency", "2"},
          {"forces.drag", "1"},
          {"forces.lift", "1"}};
}

TEST_P(Contact, EndsWhenAForceLifts) {
  const Trial trial =
      particles("contact.distance = 0.01\nobstacles = [{ shape = 'plane', position = [0, 0, -0.01] }]\nend.time = 0.5\n",
                wind("[0, 0, 19.62]"));
  const double h = 0.01, lifts = std::asin(0.5) / 2;  // 2 ρ g sin 2t = ρ g
  for (const Moment& moment : run(trial, method, h)) {
    if (moment.t == 0 || std::abs(moment.t - lifts) < h) continue;
    EXPECT_EQ(moment.contacts.constrained, moment.t < lifts ? 4 : 0) << moment.t;
    if (moment.t < lifts) {
      EXPECT_LE(moment.y.x.col(2).cwiseAbs().maxCoeff(), 1e-12);
    }
    if (moment.t > lifts + 2 * h) {
      EXPECT_GT(moment.y.v(0, 2), 0);
    }
  }
}

TEST_P(Contact, StopsSlidingAndSticksAsTheForceTells) {
  const Trial trial = particles(
      "contact.distance = 0.01\nobstacles = [{ shape = 'plane', position = [0, 0, -0.01], friction = 0.3 }]\nend.time = 0.5\n",
      wind("[5.886, 0, 0]"));
  const double h = 0.01, slides = std::asin(0.5) / 2;  // 2 η ρ g sin 2t = η ρ g
  const auto velocity = [&](double t) { return 5.886 * (std::cos(2 * slides) - std::cos(2 * t)) / 2 - 0.3 * g * (t - slides); };
  const auto moments = run(trial, method, h);
  for (const Moment& moment : moments) {
    if (moment.t < slides - h) {
      EXPECT_LE(moment.y.v.norm(), 1e-12) << moment.t;
    }
  }
  const Moment& last = moments.back();
  EXPECT_NEAR(last.y.v(0, 0), velocity(last.t), 3 * h) << "a step later, a force of up to 2.9 N/kg lags";
  EXPECT_GT(velocity(last.t), 0.2);
}

TEST_P(Contact, GivesAsMuchMomentumAsItTakes) {
  // A plate that rises with 2 m/s meets particles at rest, without weight.
  const Trial trial = particles(
      "end.time = 0.3\n"
      "obstacles = [{ shape = 'plane', motion = [{ time = 0, position = [0, 0, -0.2] }, { time = 1, position = [0, 0, 1.8] }] "
      "}]\n",
      std::vector<model::Override>{{"forces.gravity", "[0, 0, 0]"}});
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();
  const auto moments = run(trial, method, 0.01);
  for (const Moment& moment : moments) impulse += moment.contacts.impulse;
  const double mass = trial.cloth.ode.mass.sum();
  EXPECT_NEAR(moments.back().y.v.col(2).minCoeff(), 2, 1e-12);
  EXPECT_NEAR(impulse[2], 2 * mass, 1e-12 * mass);
}

TEST_P(Contact, HoldsAParticleBetweenTwoAndThreePlanes) {
  // The first two make a groove along y, the other three a funnel.
  const auto planes = [&](int walls, double friction) {
    const std::vector<std::string> groove{"[0, 40, 0]", "[0, -40, 0]"};
    const std::vector<std::string> funnel{"[0, 40, 0]", "[34.64, -20, 0]", "[-34.64, -20, 0]"};
    std::string text = "contact.distance = 0.01\nend.time = 1.5\nobstacles = [";
    for (const std::string& rotation : walls == 2 ? groove : funnel)
      text += fmt::format("{{ shape = 'plane', position = [0, 0, -0.3], rotation = {}, friction = {} }},", rotation, friction);
    return text + "]\n";
  };
  for (const int walls : {2, 3})
    for (const double friction : {0.0, 0.1}) {
      const Trial trial = particles(planes(walls, friction));
      const double h = 0.01, of_a_fall = trial.cloth.ode.mass.sum() * g * h * g * h / 2;  // energy, in one step
      const auto moments = run(trial, method, h);
      EXPECT_GE(clearance(trial, moments), 0.01 - 1e-9) << walls;
      EXPECT_LE(energy_rise(moments), 0.1 * of_a_fall) << walls;
      const double way = method == "verlet" ? g * h * h : 1e-9, speed = method == "verlet" ? g * h : 1e-9;
      const Moment& last = moments.back();  // without a matrix walls take turns, step by step
      if (walls < 3) {                      // the bottom of the groove, at equal distance from both walls
        EXPECT_LE(last.y.x.col(0).cwiseAbs().maxCoeff(), way) << friction;
        EXPECT_NEAR(last.y.x(0, 2), -0.3 + 0.01 / std::cos(40 * M_PI / 180), way) << friction;
      }
      EXPECT_LE(last.y.v.norm(), speed) << walls;
    }
}

/// Both planes are met in the step of the impact; they intersect 0.29 m away, where nothing calls the particles. A stage whose
/// forces are nonlinear may not come back from there.
TEST_P(Contact, DoesNotGoWhereTwoAlmostParallelPlanesIntersect) {
  const Trial trial = sheet(
      "contact.distance = 0.01\nobstacles = [{ shape = 'plane', rotation = [0, 0.05, 0], position = [0, 0, -0.11] },\n"
      "{ shape = 'plane', rotation = [0, -0.05, 0], position = [0, 0, -0.1105] }]\nend.time = 0.2\n");
  const auto moments = run(trial, method, 0.01);
  const double slope = 0.05 * M_PI / 180;
  for (const Moment& moment : moments)
    EXPECT_LE(moment.y.v.leftCols<2>().cwiseAbs().maxCoeff(), 2 * slope * g * moment.t) << moment.t << ": friction-free";
  EXPECT_GE(clearance(trial, moments), 0.01 - 1e-12);
  if (method == "implicit-euler" || method == "midpoint") {
    EXPECT_EQ(trial.cloth.ode.work->count("contact_changes"), 49) << "each particle is captured once, by one plane";
  }
}

TEST_P(Contact, LetsWhatFallsOnEdgesAndCornersOfABoxSlideOff) {
  Trial trial = particles(
      "obstacles = [{ shape = 'box', size = [0.4, 0.4, 0.1], position = [0, 0, -0.2], friction = 0.1 }]\nend.time = 0.6\n");
  trial.cloth.start.x << 0.2, 0.2, 0, 0.2, 0, 0, 0.201, -0.2, 0, -0.199, 0.0, 0;
  trial.cloth.start.v.row(1) << 1, 0, 0;
  const auto moments = run(trial, method, 0.01);
  EXPECT_GE(clearance(trial, moments), 5e-3 - 1e-9);
  EXPECT_LE(energy_rise(moments), 1e-12);
}

TEST_P(Contact, OfStiffSpringsWithABallGainsNoEnergy) {
  // Particles that stick at once go their way until they touch: held where they were, they would strain the springs.
  const std::vector<model::Override> small{{"grid.size", "0.0421"}};
  const Trial trial = particles(
      "material = { tension = 1e4, damping = 0.5 }\nend.time = 0.06\n"
      "obstacles = [{ shape = 'sphere', radius = 0.2, position = [0.02105, 0.02105, -0.21], friction = 0.3 }]\n",
      small);
  const auto moments = run(trial, method, 0.01);
  EXPECT_EQ(moments.back().contacts.constrained, 4);
  EXPECT_LE(energy_rise(moments), 1e-12);
}

TEST_P(Contact, LeavesPinnedCoordinatesAlone) {
  const Trial trial =
      particles(floor_below +
                "pins = [{ particles = [[0, 0]] }, { particles = [[1, 0]], directions = 'xy', velocity = [0.1, 0, 0] }]\n"
                "end.time = 0.6");
  const Moment last = run(trial, method, 0.01).back();
  EXPECT_EQ(last.y.x.row(0), trial.cloth.start.x.row(0)) << "above the floor";
  EXPECT_NEAR(last.y.x(1, 0), 0.1 + 0.06, 1e-12) << "drawn over it";
  EXPECT_NEAR(last.y.x(1, 2), -0.3, 1e-12);
}

TEST(BridsonInContact, DampingDoesNotRingAfterAnImpact) {
  // Two of four particles hit a box; a stiff damper stops the others as well. The trapezoidal rule would throw them back.
  const Trial trial = particles(
      "material.damping = 1e4\nend.time = 0.4\nobstacles = [{ shape = 'box', size = [0.1, 1, 0.1], position = [0, 0, -0.2] "
      "}]\n");
  bool met = false;
  for (const Moment& moment : run(trial, "bridson", 0.01)) {
    met = met || moment.contacts.constrained > 0;
    if (met) {
      EXPECT_LE(moment.y.v.cwiseAbs().maxCoeff(), g * 0.01) << moment.t;
    }
  }
  EXPECT_TRUE(met);
}

TEST(BridsonInContact, ObstaclesMoveEvenlyDuringAStep) {
  const Trial trial = sheet(
      "end.time = 0.1\nobstacles = [{ shape = 'box', size = [0.2, 1, 0.04], motion = [{ time = 0, position = [0.1, 0.15, "
      "-0.025] }, "
      "{ time = 0.1, position = [0.1, 0.15, 0.075] }] }]\n");
  const Moment once = run(trial, "bridson", 0.05).back(), often = run(trial, "verlet", 1e-4).back();
  EXPECT_LE((once.y.x - often.y.x).norm(), 1e-3) << "a lifted sheet, with two steps of many parts";
}

TEST_P(Contact, EndsTenThousandRandomDropsOutsideAndAtLessEnergy) {
  DRAPE_SLOW();
  const std::vector<model::Override> grid{{"grid.n", "100"}};
  Trial trial = particles(
      "end.time = 0.6\ncontact.distance = 0.01\nobstacles = [\n"
      "{ shape = 'plane', position = [0, 0, -1], rotation = [5, 0, 0], friction = 0.2 },\n"
      "{ shape = 'sphere', radius = 0.3, position = [0.5, 0, -0.6], friction = 0.5 },\n"
      "{ shape = 'box', size = [0.5, 0.5, 0.3], position = [-0.4, 0.2, -0.5], rotation = [20, 30, 10], friction = 0.3 },\n"
      "{ shape = 'cylinder', radius = 0.25, height = 0.4, position = [0, -0.5, -0.6], rotation = [30, 0, 0] }]\n",
      grid);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1, 1), speed(-3, 3);
  for (int i = 0; i < 10000; ++i) {
    trial.cloth.start.x.row(i) << place(random), place(random), 0.3 * place(random) + 0.2;
    trial.cloth.start.v.row(i) << speed(random), speed(random), speed(random);
  }
  const double h = 0.02, of_a_fall = g * h * g * h / 2;  // in one step, per mass
  const auto moments = run(trial, method, h);
  const auto energies = [](const Moment& moment) -> Eigen::VectorXd {
    return 0.5 * moment.y.v.rowwise().squaredNorm() + g * moment.y.x.col(2);
  };
  int touched = 0;
  for (std::size_t k = 1; k < moments.size(); ++k) {
    EXPECT_LE((energies(moments[k]) - energies(moments[k - 1])).maxCoeff(), 0.02 * of_a_fall) << moments[k].t;
    touched += moments[k].contacts.constrained;
  }
  EXPECT_GE(touched, 10000) << "or the test would show nothing";
  EXPECT_GE(clearance(trial, moments), 0.01 - 1e-9);
}

}  // namespace
}  // namespace drape::verify::contact_test
