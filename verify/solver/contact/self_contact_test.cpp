// Cloth meets itself: pairs of faces, vertices and edges are constrained in the systems of a step, and separated after it.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "bench/runs/record.hpp"
#include "bench/runs/reference_work.hpp"
#include "model/collision/self_contacts.hpp"
#include "reference/reference.hpp"
#include "solver/base/statistics.hpp"
#include "solver/contact/pair_search.hpp"
#include "solver/contact/separation.hpp"
#include "verify/support/contact_scenes.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::self_contact_test {
namespace {

using contact_scenes::Moment;
using contact_scenes::Trial;
using Eigen::Vector3d;
using solver::State;
using solver::Vectors;

Trial compiled(const std::string& toml, std::span<const model::Override> changes = {}) {
  const model::Scene scene = model::parse_scene("name = 'test'\n" + toml, "test", changes);
  return {scene, model::compile(scene)};
}

/// Two squares of 8 × 8 particles; the upper one flies against the lower one, which rests.
Trial plates(std::span<const model::Override> changes = {}) {
  return compiled(
      "grid = { n = 8, size = 0.2 }\n"
      "material = { density = 0.3, tension = 200, damping = 0.2, shear = 10, bend = 1e-5 }\n"
      "contact = { thickness = 0.005 }\nend = { time = 0.06 }\n"
      "[[panels]]\nname = 'lower'\n"
      "[[panels]]\nname = 'upper'\nstart.position = [0.0071, 0.0043, 0.022]\nstart.velocity = [0, 0, -1]\n",
      changes);
}

Vector3d momentum(const solver::SplitOde& ode, const State& y) { return (ode.mass.asDiagonal() * y.v).colwise().sum(); }

Vector3d angular_momentum(const solver::SplitOde& ode, const State& y) {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < ode.particles(); ++i) {
    const Vector3d x = y.x.row(i), v = y.v.row(i);
    sum += ode.mass[i] * x.cross(v);
  }
  return sum;
}

/// The least distance of a cloth from itself [m], if it is below `reach`.
double least_distance(const model::Cloth& cloth, const Vectors& x, double reach) {
  solver::Counters unused;
  std::vector<model::Proximity> near;
  model::SelfContacts(model::ClothSurface(*cloth.garment), unused).near(x, reach, near);
  for (const model::Proximity& pair : near) reach = std::min(reach, pair.distance);
  return reach;
}

class SelfContactBy : public testing::TestWithParam<std::string> {};

TEST_P(SelfContactBy, StopsASheetThatFliesAgainstAnother) {
  const Trial trial = plates();
  const std::vector<Moment> moments = contact_scenes::run(trial, GetParam(), 0.01);
  const solver::SplitOde& ode = trial.cloth.ode;
  const double before = solver::kinetic_energy(ode, moments.front().y.v);
  for (const Moment& moment : moments) {
    EXPECT_GE(least_distance(trial.cloth, moment.y.x, 0.006), 0.9 * 0.005) << moment.t;
    EXPECT_LE((momentum(ode, moment.y) - momentum(ode, moments.front().y)).norm(), 1e-3 * 0.012) << moment.t;
  }
  EXPECT_NEAR(solver::kinetic_energy(ode, moments.back().y.v) / before, 0.5, 0.01);  // inelastic, of equal masses
}

TEST_P(SelfContactBy, CostsNoSystemsWhereNothingMeets) {
  const model::Override apart[] = {{"end.time", "0.01"}}, without[] = {{"end.time", "0.01"}, {"contact.thickness", "0"}};
  const Trial thick = plates(apart), thin = plates(without);
  const std::vector<Moment> met = contact_scenes::run(thick, GetParam(), 0.01),
                            free = contact_scenes::run(thin, GetParam(), 0.01);
  EXPECT_EQ(met.back().y.x, free.back().y.x);
  for (const char* counter : {"updates", "cg_iterations"})
    EXPECT_EQ(thick.cloth.ode.work->count(counter), thin.cloth.ode.work->count(counter)) << counter;
  EXPECT_THROW((void)thin.cloth.ode.work->count("self_pairs"), std::out_of_range);
}

/// A square on a fixed plate that is tilted by `degrees`: gravity is.
Trial on_a_slope(double degrees, double friction) {
  const double a = degrees * M_PI / 180;
  return compiled(fmt::format(
      "grid = {{ n = 13, size = 0.3 }}\n"
      "material = {{ density = 0.3, tension = 200, damping = 0.2, shear = 10, bend = 1e-5 }}\n"
      "forces = {{ gravity = [{}, 0, {}] }}\ncontact = {{ thickness = 0.005, self_friction = {} }}\nend = {{ time = 0.2 }}\n"
      "pins = [{{ where = 'all', panel = 'lower' }}]\n"
      "[[panels]]\nname = 'lower'\n"
      "[[panels]]\nname = 'upper'\ngrid = {{ n = 5, size = 0.1 }}\nstart.position = [0.0071, 0.103, 0.005]\n",
      9.81 * std::sin(a), -9.81 * std::cos(a), friction));
}

/// Across borders of cells, of which a step passes half of one at the end. A border may catch a particle for a step, which
/// changes the speed by up to a tenth, with few steps: whence medians.
TEST_P(SelfContactBy, SlidesAndSticksByCoulombsLaw) {
  DRAPE_SLOW();
  const double a = 40 * M_PI / 180, time = 0.2;
  const auto slide = [&](double friction, int steps) {
    const std::vector<Moment> moments = contact_scenes::run(on_a_slope(40, friction), GetParam(), time / steps);
    const State &y0 = moments.front().y, &y = moments.back().y;
    return std::pair(y.v.bottomRows(25).col(0).mean(), (y.x - y0.x).bottomRows(25).col(0).mean());
  };
  for (const double friction : {0.0, 0.3}) {
    const double expected = time * 9.81 * (std::sin(a) - friction * std::cos(a));
    std::vector<double> speeds, ways;
    for (const int steps : {18, 20, 21, 22, 25}) {
      const auto [speed, way] = slide(friction, steps);
      EXPECT_NEAR(speed, expected, 0.13 * expected) << friction << ", " << steps;
      speeds.push_back(speed), ways.push_back(way);
    }
    EXPECT_NEAR(base::quantile(speeds, 0.5), expected, 0.03 * expected) << friction;
    EXPECT_NEAR(base::quantile(ways, 0.5), 0.5 * time * expected, 0.07 * 0.5 * time * expected)
        << friction;  // 5 % are Euler's error
  }
  EXPECT_LE(std::abs(slide(1, 20).second), 5e-4) << "of 0.126 m without friction";
}

INSTANTIATE_TEST_SUITE_P(All, SelfContactBy,
                         testing::Values("imex-euler", "implicit-euler", "sbdf2", "bdf2", "midpoint", "verlet"),
                         [](const auto& method) {
                           std::string name = method.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST(SelfContact, IsAcceleratedToTheSameMotion) {
  DRAPE_SLOW();
  for (const char* method : {"implicit-euler", "bdf2", "midpoint"}) {
    const auto solved = [&](const char* stage) {
      const model::Override longer[] = {{"end.time", "0.1"}};
      const Trial trial = plates(longer);
      solver::Options options;
      options.loop_tolerance = 1e-8;
      options.stage = &solver::stage_kind(stage);
      const std::vector<Moment> moments = contact_scenes::run(trial, method, 0.01, options);
      EXPECT_GT(trial.cloth.ode.work->count("constrained_pairs"), 0);
      return std::pair(moments.back().y, trial.cloth.ode.work->count("updates"));
    };
    const auto [plain, plain_updates] = solved("fixed-point");
    for (const char* stage : {"anderson", "auto"}) {
      const auto [accelerated, updates] = solved(stage);
      EXPECT_LE(reference::rms_distance(accelerated.x, plain.x), 1e-5 * 0.2) << method << " " << stage;
      EXPECT_LT(updates, 0.8 * static_cast<double>(plain_updates)) << method << " " << stage;
    }
  }
}

TEST(SelfContact, KeepsBothMomentaToRoundOff) {
  // Without forces between particles all changes are those of contacts; explicit and implicit response.
  for (const char* method : {"implicit-euler", "verlet"})
    for (const char* friction : {"0", "0.4"}) {
      const model::Override loose[] = {{"material.tension", "0"},
                                       {"material.shear", "0"},
                                       {"material.bend", "0"},
                                       {"material.damping", "0"},
                                       {"contact.self_friction", friction}};
      Trial trial = plates(loose);
      trial.cloth.start.v.col(0).tail(64).setConstant(0.5);
      const solver::SplitOde& ode = trial.cloth.ode;
      solver::Options exact;
      exact.loop_tolerance = 1e-14, exact.cg_tolerance = 1e-15;
      const std::vector<Moment> moments = contact_scenes::run(trial, method, 0.01, exact);
      EXPECT_LE((momentum(ode, moments.back().y) - momentum(ode, moments.front().y)).norm(), 1e-12 * 0.012) << method;
      EXPECT_LE((angular_momentum(ode, moments.back().y) - angular_momentum(ode, moments.front().y)).norm(), 1e-12 * 0.012)
          << method;
      EXPECT_LT(moments.back().energy, 0.65 * moments.front().energy) << method;
    }
}

/// Three sheets that fall by some millimetres onto each other and the floor.
Trial stack() {
  return compiled(
      "grid = { n = 8, size = 0.2 }\n"
      "material = { density = 0.3, tension = 200, damping = 0.2, shear = 10, bend = 1e-5 }\n"
      "forces = { gravity = [0, 0, -9.81] }\nobstacles = [{ shape = 'plane' }]\n"
      "contact = { distance = 0.005, thickness = 0.005 }\nend = { time = 0.4 }\n"
      "[[panels]]\nname = 'lower'\nstart.position = [0, 0, 0.008]\n"
      "[[panels]]\nname = 'middle'\nstart.position = [0.0071, 0.0043, 0.022]\n"
      "[[panels]]\nname = 'upper'\nstart.position = [0.0031, 0.0133, 0.035]\n");
}

TEST(SelfContact, HoldsAStackAtRest) {
  DRAPE_SLOW();
  const Trial trial = stack();
  for (const double h : {0.01, 0.02}) {
    const std::vector<Moment> moments = contact_scenes::run(trial, "bdf2", h);
    const State& rest = moments.back().y;
    EXPECT_LE(rest.v.col(2).cwiseAbs().maxCoeff(), 1e-7) << h;
    EXPECT_LE(rest.v.cwiseAbs().maxCoeff(), 1e-4) << h << ": there is no friction";
    for (int layer = 0; layer < 3; ++layer)
      for (int i = 64 * layer; i < 64 * (layer + 1); ++i) EXPECT_NEAR(rest.x(i, 2), 0.005 * (layer + 1), 1e-4) << h;
    const double weight = 9.81 * trial.cloth.ode.mass.sum();
    for (std::size_t k = 1; k < moments.size(); ++k) {
      const double gained = momentum(trial.cloth.ode, moments[k].y)[2] - momentum(trial.cloth.ode, moments[k - 1].y)[2];
      EXPECT_NEAR(gained, moments[k].contacts.impulse[2] - h * weight, 1e-6 * h * weight) << h << ", " << moments[k].t;
    }
    // The floor bears the weight of all layers.
    EXPECT_NEAR(moments.back().contacts.impulse[2] / h, weight, 1e-3 * weight) << h;
  }
  // More than three rows push in each direction that they hold: sweeps hardly find out which of them do.
  EXPECT_GT(trial.cloth.ode.work->count("undecided_pairs"), 60) << "steps";
}

/// Two crossed strips whose ends pass each other: a mirror maps one on the other, so that they meet in its plane.
TEST_P(SelfContactBy, CrossesStripsInTheirMirrorPlane) {
  const Trial trial = compiled(
      "grid = { n = [11, 3], size = [0.3, 0.06] }\n"
      "material = { density = 0.3, tension = 20, damping = 0.2, shear = 1, bend = 1e-5 }\n"
      "contact = { thickness = 0.005 }\nend = { time = 0.4 }\n"
      "[[panels]]\nname = 'lower'\nstart.position = [-0.15, -0.03, -0.01]\n"
      "[[panels]]\nname = 'upper'\nstart.position = [0.03, -0.15, 0.01]\nstart.rotation = [0, 0, 90]\n"
      "[[pins]]\nwhere = 'left edge'\npanel = 'lower'\nvelocity = [0, 0, 0.05]\n"
      "[[pins]]\nwhere = 'right edge'\npanel = 'lower'\nvelocity = [0, 0, 0.05]\n"
      "[[pins]]\nwhere = 'left edge'\npanel = 'upper'\nvelocity = [0, 0, -0.05]\n"
      "[[pins]]\nwhere = 'right edge'\npanel = 'upper'\nvelocity = [0, 0, -0.05]\n");
  constexpr int middle = 16, particles = 33;
  const Vectors x = contact_scenes::run(trial, GetParam(), 0.01).back().y.x;
  EXPECT_NEAR(x(0, 2), 0.01, 1e-9);
  EXPECT_NEAR(x(particles, 2), -0.01, 1e-9);
  EXPECT_NEAR(x(middle, 2), -0.0025, 2e-4);
  EXPECT_NEAR(x(particles + middle, 2), 0.0025, 2e-4);
}

/// The impact is inelastic, between equal masses: the centre of the upper plate falls on with half its speed.
TEST(SelfContact, HasAReferenceOfTwoResponses) {
  const Trial trial = plates();
  const std::vector<double> times{0.03, 0.06};
  const auto truth = bench::compute_reference(trial.scene, trial.cloth, times, {.size = 0.2}, {}, 600);
  EXPECT_EQ(truth.name, "verlet");
  EXPECT_EQ(truth.witness, "midpoint");
  EXPECT_LE(std::ranges::max(truth.error), 0.01 * 0.2);
  const double met = 0.022 - 0.005;  // [s], at 1 m/s
  for (std::size_t k = 0; k < times.size(); ++k)
    EXPECT_NEAR(truth.trajectory.states[k].x.bottomRows(64).col(2).mean(), 0.005 - (times[k] - met) / 2, 2e-4) << times[k];
}

/// Counts in how many frames of a run cloth intersects itself, or has particles inside obstacles.
class Intersections : public bench::Observer {
 public:
  void begin(const model::Scene&, const model::Cloth& cloth, const State& start) override {
    cloth_ = &cloth;
    contacts_.emplace(model::ClothSurface(*cloth.garment), unused_);
    count(cloth.begin, start.x);
  }
  void observe(const solver::StepReport& step) override { count(step.t, step.y.x); }

  int frames = 0;

 private:
  void count(double t, const Vectors& x) {
    const bool outside = !cloth_->contacts || cloth_->contacts->distances(t, x).minCoeff() > 0;
    frames += outside && contacts_->intersections(x).empty() ? 0 : 1;
  }

  const model::Cloth* cloth_ = nullptr;
  solver::Counters unused_;
  std::optional<model::SelfContacts> contacts_;
};

/// Scenes in which cloth meets itself.
constexpr const char* scenes[] = {"sphere_drop", "cloth_stack", "twist", "curtain_drawn"};

/// A run that must last until the end of the scene.
int intersecting_frames(const std::string& name, const char* method, double step,
                        std::span<const model::Override> changes = {}) {
  const model::Scene scene = model::load_scene(name, changes);
  Intersections intersections;
  bench::Observer* const observers[] = {&intersections};
  const results::RunRecord run = bench::record({scene, "", &solver::method(method), step, solver::Options{}}, observers);
  EXPECT_TRUE(run.succeeded()) << name << ", " << method << ", " << step << ": " << run.message;
  return intersections.frames;
}

TEST(SelfContact, LeavesNoIntersectionInAnyFrame) {
  DRAPE_SLOW();
  for (const char* scene : scenes)
    for (const char* method : {"imex-euler", "implicit-euler", "sbdf2", "bdf2", "midpoint", "verlet"})
      for (const double step : {0.01, 0.02})
        EXPECT_EQ(intersecting_frames(scene, method, step), 0) << scene << ", " << method << ", " << step;
}

TEST(SelfContact, WithoutWhichSheetsPassThroughThemselves) {
  DRAPE_SLOW();
  const model::Override thin[] = {{"contact.thickness", "0"}};
  for (const char* scene : scenes) EXPECT_GT(intersecting_frames(scene, "midpoint", 0.01, thin), 0) << scene;
}

/// A vertex above the middle of a triangle, without forces; all of 1 kg.
struct Falling {
  solver::SplitOde ode;
  State y0;
};

/// Pairs of that vertex with that face.
class VertexAndFace : public solver::PairSearch {
 public:
  void begin(double, double) override {}
  const solver::BodyPoints& bodies() const override { return none_; }
  bool rubs() const override { return false; }
  void find(const Vectors& x0, const Vectors& x1, double part, std::vector<solver::PairContact>& found) override {
    found.clear();
    if (height(x1) < part * keeps && height(x1) < height(x0))
      found.push_back({{3, 0, 1, 2}, false, points(x0), points(x1), keeps, 0});
  }
  void renew(const Vectors& x, std::vector<solver::PairContact>& pairs) const override {
    for (solver::PairContact& pair : pairs) pair.begin = points(x);
  }

 private:
  static constexpr double keeps = 0.01;  // [m]
  solver::BodyPoints none_;

  static double height(const Vectors& x) { return x(3, 2) - (x(0, 2) + x(1, 2) + x(2, 2)) / 3; }
  static solver::PairContact::Points points(const Vectors& x) {
    return {{1, -1. / 3, -1. / 3, -1. / 3}, Vector3d::UnitZ(), height(x)};
  }
};

Falling falling() {
  Falling trial;
  trial.ode.mass = Eigen::VectorXd::Ones(4);
  trial.ode.pairs = std::make_shared<VertexAndFace>();
  trial.y0.x.resize(4, 3);
  trial.y0.x << 0, 0, 0, 0.3, 0, 0, 0, 0.3, 0, 0.1, 0.1, 0.02;
  trial.y0.v.setZero(4, 3);
  trial.y0.v(3, 2) = -5;
  return trial;
}

/// The state after a step of 0.01 s without forces.
State moved(const State& y0) { return {y0.x + 0.01 * y0.v, y0.v}; }

TEST(Separation, PushesAPairApartAndKeepsMomenta) {
  const Falling trial = falling();
  State y1 = moved(trial.y0);
  ASSERT_TRUE(solver::Separation(trial.ode).separate(0, trial.y0, 0.01, {1, 0.1}, {}, y1));
  EXPECT_NEAR(y1.x(3, 2) - y1.x.col(2).head(3).mean(), 0.01, 2e-5);
  EXPECT_LE((momentum(trial.ode, y1) - momentum(trial.ode, trial.y0)).norm(), 1e-15);
  EXPECT_LE((angular_momentum(trial.ode, y1) - angular_momentum(trial.ode, trial.y0)).norm(), 1e-15);
}

TEST(Separation, DoesNotMoveWhatIsPinnedNorPushIntoObstacles) {
  Falling trial = falling();
  for (const int i : {0, 1, 2}) trial.ode.pins.push_back({.particle = i});
  State y1 = moved(trial.y0);
  ASSERT_TRUE(solver::Separation(trial.ode).separate(0, trial.y0, 0.01, {1, 0.1}, {}, y1));
  EXPECT_EQ(y1.x.topRows(3), trial.y0.x.topRows(3));
  EXPECT_NEAR(y1.x(3, 2), 0.01, 2e-5);

  Falling supported = falling();
  std::vector<solver::Contact> floor;
  for (const int i : {0, 1, 2}) floor.push_back({.particle = i, .normal = Vector3d::UnitZ(), .gap = 0, .least = 0});
  y1 = moved(supported.y0);
  ASSERT_TRUE(solver::Separation(supported.ode).separate(0, supported.y0, 0.01, {1, 0.1}, floor, y1));
  for (const int i : {0, 1, 2}) EXPECT_GE(y1.x(i, 2), -1e-12);
  EXPECT_GE(y1.x(3, 2), 0.001);
}

TEST(Separation, SaysWherePinsForceAPairThroughItself) {
  Falling trial = falling();
  for (const int i : {0, 1, 2, 3}) trial.ode.pins.push_back({.particle = i});
  State y1 = moved(trial.y0);
  EXPECT_FALSE(solver::Separation(trial.ode).separate(0, trial.y0, 0.01, {1, 0.1}, {}, y1));
}

}  // namespace
}  // namespace drape::verify::self_contact_test
