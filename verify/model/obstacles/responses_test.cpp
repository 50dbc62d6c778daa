// The responses that constraints are compared with, against closed forms: single particles above a plane under their weight.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "verify/support/contact_scenes.hpp"

namespace drape::verify::responses_test {
namespace {

using namespace contact_scenes;
using solver::Vectors;

constexpr double g = 9.81, d = 0.01, e = 2e-3, n = 10;

/// Particles at height 0 that are `above` the surface of a plane.
Trial above_plane(const std::string& response, double above, const std::string& more, double push = g) {
  return particles(
      fmt::format("contact.distance = {}\ncontact.response = '{}'\ncontact.push = {}\ncontact.exponent = {}\n"
                  "contact.range = {}\nobstacles = [{{ shape = 'plane', position = [0, 0, {}] }}]\n{}\n",
                  d, response, push, n, e, -above, more));
}

std::vector<double> heights(const Trial& trial, const std::vector<Moment>& moments) {
  std::vector<double> all;
  for (const Moment& moment : moments) all.push_back(trial.cloth.contacts->distances(moment.t, moment.y.x).minCoeff());
  return all;
}

solver::Options tight() {
  solver::Options options;
  options.loop_tolerance = 1e-12;
  options.cg_tolerance = 1e-12;
  options.stage = &solver::stage_kind("newton");
  return options;
}

// --- Fields
// --------------------------------------------------------------------------------------------------------------------

struct FieldCase {
  const char *response, *method;
  int order;
};
std::string title(const testing::TestParamInfo<FieldCase>& test) {
  std::string name = fmt::format("{}_{}", test.param.response, test.param.method);
  std::ranges::replace(name, '-', '_');
  return name;
}

class Fields : public testing::TestWithParam<FieldCase> {
 protected:
  const std::string response = GetParam().response, method = GetParam().method;
  const bool penalty = response == "penalty";

  /// Distance from the surface after a time at rest at first, by the classical Runge-Kutta method.
  double true_height(double r, double time) const {
    const double b = 2 * std::sqrt(g / e);
    const auto a = [&](double at, double v) {
      return -g + (penalty ? g * std::pow(d / at, n) : std::exp((d - at) / e) * (g - b * v));
    };
    const int steps = 20000;
    const double h = time / steps;
    double v = 0;
    for (int k = 0; k < steps; ++k) {
      const double k1 = a(r, v), v2 = v + h / 2 * k1, k2 = a(r + h / 2 * v, v2), v3 = v + h / 2 * k2;
      const double k3 = a(r + h / 2 * v2, v3), v4 = v + h * k3, k4 = a(r + h * v3, v4);
      r += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
      v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    return r;
  }
};
INSTANTIATE_TEST_SUITE_P(, Fields,
                         testing::Values(FieldCase{"penalty", "implicit-euler", 1}, FieldCase{"penalty", "bdf2", 2},
                                         FieldCase{"penalty", "midpoint", 2}, FieldCase{"penalty", "verlet", 2},
                                         FieldCase{"penalty", "sbdf2", 2}, FieldCase{"field", "implicit-euler", 1},
                                         FieldCase{"field", "bdf2", 2}, FieldCase{"field", "imex-euler", 1},
                                         FieldCase{"field", "verlet", 2}, FieldCase{"field", "sbdf2", 2}),
                         title);

TEST_P(Fields, AreFollowedWithTheOrderOfTheMethod) {
  const double from = 0.012, time = 0.1, truth = true_height(from, time);
  const Trial trial = above_plane(response, from, fmt::format("end.time = {}", time));
  EXPECT_FALSE(trial.cloth.ode.contacts) << "they are forces";
  const auto error = [&](double h) { return std::abs(heights(trial, run(trial, method, h, tight())).back() - truth); };
  const double h = GetParam().order == 1 ? 5e-5 : 5e-4, coarse = error(h), fine = error(h / 2);
  EXPECT_NEAR(std::log2(coarse / fine), GetParam().order, 0.3) << coarse << " " << fine;
}

/// m g = m c (d/r)ⁿ, m g = m c exp((d − r)/e); a potential is left by what damps it: large steps of implicit methods.
TEST_P(Fields, CarryTheWeightWhereTheyBalanceIt) {
  if (penalty && method != "implicit-euler" && method != "bdf2") return;
  for (const double c : {g / 3, 4 * g}) {
    const double rest = penalty ? d * std::pow(c / g, 1 / n) : d + e * std::log(c / g);
    const Trial trial = above_plane(response, 1.1 * rest, "end.time = 3", c);
    const auto moments = run(trial, method, penalty ? 0.01 : 0.001, tight());
    EXPECT_NEAR(heights(trial, moments).back(), rest, 1e-8) << c;
  }
}

TEST(Penalty, TurnsAroundWhereItHasTheEnergyOfTheFall) {
  const double from = 0.03;
  const Trial trial = above_plane("penalty", from, "end.time = 0.2");
  const auto potential = [](double r) { return g * r + g * d / (n - 1) * std::pow(d / r, n - 1); };
  double low = 0.2 * d, high = d;  // the potential falls there
  for (int k = 0; k < 60; ++k) (potential((low + high) / 2) > potential(from) ? low : high) = (low + high) / 2;
  const auto r = heights(trial, run(trial, "verlet", 1e-5));
  EXPECT_NEAR(*std::ranges::min_element(r), low, 1e-3 * d);
  EXPECT_NEAR(*std::max_element(r.begin() + r.size() / 2, r.end()), from, 1e-3 * d) << "nothing is lost";
}

TEST(FieldDerivatives, AreThoseOfTheForce) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(-1, 1);
  for (const char* response : {"penalty", "field"})
    for (const double above : {0.013, 0.008, -0.03}) {  // the last where fields are linear
      const Trial trial = above_plane(response, above, "end.time = 1");
      const solver::SplitOde& ode = trial.cloth.ode;
      const Vectors x = trial.cloth.start.x;
      Vectors v(4, 3);
      for (double& at : v.reshaped()) at = 0.01 * part(random);
      v.col(2).array() -= 0.02;  // approaching, so that nothing is left out of the Newton matrix
      solver::SparseMatrix by_x, by_v, J;
      ode.jacobian(0, x, v, by_x, by_v);
      const auto difference = [&](int k, bool of_x) {
        const double step = 1e-7;
        Vectors to = of_x ? x : v, from = to, f1(4, 3), f0(4, 3);
        to(k / 3, k % 3) += step;
        from(k / 3, k % 3) -= step;
        ode.force(0, of_x ? to : x, of_x ? v : to, f1);
        ode.force(0, of_x ? from : x, of_x ? v : from, f0);
        const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> rows = (f1 - f0) / (2 * step);
        return Eigen::VectorXd(rows.reshaped<Eigen::RowMajor>());
      };
      const double gamma = 0.01, size = std::max(Eigen::MatrixXd(by_x).norm(), 1.0);
      ode.newton_matrix(0, x, v, gamma, solver::Jacobian::whole, J);
      Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(12, 12);
      for (int k = 0; k < 12; ++k) {
        const Eigen::VectorXd dx = difference(k, true), dv = difference(k, false);
        EXPECT_LE((Eigen::VectorXd(by_x.col(k)) - dx).norm(), 1e-6 * size) << response << above;
        EXPECT_LE((Eigen::VectorXd(by_v.col(k)) - dv).norm(), 1e-6 * size) << response << above;
        expected.col(k) = -gamma * gamma * dx - gamma * dv;
        expected(k, k) += ode.mass[k / 3];
      }
      const Eigen::MatrixXd upper = expected.triangularView<Eigen::Upper>();
      EXPECT_LE((Eigen::MatrixXd(J) - upper).norm(), 1e-6 * size) << response << above;
    }
}

// --- Changes after a step
// ------------------------------------------------------------------------------------------------------

class Relocations : public testing::TestWithParam<std::string> {
 protected:
  const std::string& method = GetParam();
};
INSTANTIATE_TEST_SUITE_P(, Relocations, testing::ValuesIn(methods()), [](const auto& test) {
  std::string name = test.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

/// Without weight particles fly towards a plane that rises, and fly on after one step from the border.
TEST_P(Relocations, SendBackWithTheirRestitution) {
  const double w = 0.25, end = 0.1;
  for (const auto& [response, back] : {std::pair("reposition", 0.0), std::pair("impulse", 0.0), std::pair("reflect", 0.7)}) {
    const Trial trial = particles(
        fmt::format("contact = {{ distance = {}, response = '{}', restitution = 0.7 }}\nstart.velocity = [0.5, 0, -1]\n"
                    "obstacles = [{{ shape = 'plane', motion = [{{ time = 0, position = [0, 0, -0.05] }}, {{ time = 1, "
                    "position = [0, 0, 0.2] }}] }}]\nend.time = {}\n",
                    d, response, end),
        std::vector<model::Override>{{"forces.gravity", "[0, 0, 0]"}});
    const auto moments = run(trial, method, 0.005);
    const auto hit = std::ranges::find_if(moments, [](const Moment& moment) { return moment.contacts.constrained > 0; });
    ASSERT_NE(hit, moments.end());
    EXPECT_NEAR(trial.cloth.contacts->distances(hit->t, hit->y.x).minCoeff(), d, 1e-12) << response;
    EXPECT_NEAR(hit->contacts.impulse[2], trial.cloth.ode.mass.sum() * (1 + back) * (1 + w), 1e-9) << response;
    const Eigen::Vector3d v = moments.back().y.v.row(1);
    EXPECT_LE((v - Eigen::Vector3d(0.5, 0, w + back * (1 + w))).norm(), 1e-8) << response;
    const double left = back * (1 + w) * (moments.back().t - hit->t);
    EXPECT_NEAR(trial.cloth.contacts->distances(end, moments.back().y.x).minCoeff(), d + left, 1e-9) << response;
  }
}

/// What lies still falls again in each step, by at most g h².
TEST_P(Relocations, KeepWhatFellAtTheBorder) {
  const double h = 0.005;
  for (const std::string response : {"reposition", "impulse"}) {
    const Trial trial = above_plane(response, 0.03, "end.time = 0.4");
    const auto moments = run(trial, method, h);
    double impulse = 0, lands = 0.1, fastest = 0;
    for (const Moment& moment : moments) {
      if (moment.t <= lands) continue;
      EXPECT_NEAR(trial.cloth.contacts->distances(moment.t, moment.y.x).minCoeff(), d, 1.01 * g * h * h) << response;
      fastest = std::max(fastest, moment.y.v(0, 2));
      impulse += moment.contacts.impulse[2];
    }
    EXPECT_NEAR(fastest, response == "impulse" ? g * h : 0, 1e-9) << "against the weight in the next step";
    const double weight = trial.cloth.ode.mass.sum() * g;
    EXPECT_NEAR(impulse, weight * (0.4 - lands), 4 * weight * h) << response;
  }
}

TEST(RelocationOfPins, LeavesThemWhereTheyAre) {
  const Trial trial = above_plane("reposition", 0.004, "pins = [{ particles = [[0, 0]] }]\nend.time = 0.02");
  const Vectors x = run(trial, "implicit-euler", 0.01).back().y.x;
  EXPECT_EQ(x(0, 2), 0);
  EXPECT_NEAR(x(1, 2), d - 0.004, 1e-12);
}

// --- Positions altered in the implicit equation
// --------------------------------------------------------------------------------

/// Depths in the collision area, negative above it, of particles that begin 4 mm deep, at the beginning and after each step.
std::vector<double> depths(const std::string& method, double relaxation, int steps) {
  const double h = 0.005;
  const Trial trial =
      above_plane("alteration", d - 0.004, fmt::format("contact.relaxation = {}\nend.time = {}", relaxation, steps * h));
  std::vector<double> all = heights(trial, run(trial, method, h, tight()));
  for (double& r : all) r = d - r;
  return all;
}

TEST(Alteration, LosesItsPartOfTheDepthInAStepOfOneStepMethods) {
  for (const char* method : {"imex-euler", "implicit-euler", "midpoint", "imex-midpoint"}) {
    const auto all = depths(method, 0.5, 12);
    for (std::size_t k = 1; k < all.size(); ++k) EXPECT_NEAR(all[k], 0.5 * all[k - 1], 1e-12) << method << " " << k;
  }
}

/// The history does not know of the alteration: x1 = 4/3 x0 − 1/3 x₋₁ + 2/3 h (v + c) swings through the border, after a first
/// step by another method.
TEST(Alteration, ThrowsParticlesOutByMethodsWithHistory) {
  for (const char* method : {"bdf2", "sbdf2"}) {
    const auto all = depths(method, 0.9, 12);
    double before = all[1], now = all[1];
    for (std::size_t k = 2; k < all.size() && now > 0; ++k) {
      const double next = (4 - 2 * 0.9) / 3 * now - before / 3;
      EXPECT_NEAR(all[k], next, 1e-12) << method << " " << k;
      before = now;
      now = next;
    }
    EXPECT_LT(now, -1e-5) << method;
  }
}

int releases(const std::vector<double>& depths) {
  int count = 0;
  for (std::size_t k = 1; k < depths.size(); ++k) count += depths[k - 1] > 0 && depths[k] < 0 ? 1 : 0;
  return count;
}

TEST(Alteration, BouncesOneStepMethodsWithARelaxationAboveOne) {
  for (const char* method : {"imex-euler", "implicit-euler", "midpoint"}) {
    EXPECT_NEAR(depths(method, 1.5, 1)[1], -0.5 * 0.004, 1e-12) << method;
    EXPECT_GE(releases(depths(method, 1.5, 200)), 10) << method;
    EXPECT_EQ(releases(depths(method, 0.9, 200)), 0) << method;
  }
}

}  // namespace
}  // namespace drape::verify::responses_test
