// Every method has the order that its table row declares, neither less nor more: on a nonlinear problem that depends on time
// and velocity, with steps that change, and with an end time that the step does not divide.

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "solver/methods/starts.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::orders_test {
namespace {

using namespace small_problems;
using solver::bdf2_coefficients;
using solver::Integrator;
using solver::Outcome;
using solver::Step;
using solver::StepReport;

constexpr double duration = 1.5;  // [s]
/// From where on the order rules to where round-off does.
std::vector<int> refinements(const Method& method) {
  if (method.order == 5) return {78, 156, 234, 312};
  if (method.name == "esdirk4") return {66, 102, 150, 216};
  if (method.name == "epirk4s3a") return {288, 384, 512, 640};
  if (method.order == 4) return {96, 192, 288, 384};
  if (method.name == "ros34pw2-w") return {900, 1200, 1600, 2400};
  return {150, 300, 600, 1200, 2400};
}

double rms(const Vectors& difference) { return std::sqrt(difference.rowwise().squaredNorm().mean()); }

/// The largest error on the way.
struct Errors {
  double x = 0, v = 0;

  void see(const Problem& problem, double t, const State& y) {
    const State exact = problem.exact(t);
    x = std::max(x, rms(y.x - exact.x));
    v = std::max(v, rms(y.v - exact.v));
  }
};

/// Positions and velocities: both must have the order.
struct Measured {
  Convergence x, v;

  void add(double h, const Errors& errors) {
    x.steps.push_back(h), x.errors.push_back(errors.x);
    v.steps.push_back(h), v.errors.push_back(errors.v);
  }
};

testing::AssertionResult has_order(const Measured& measured, double order) {
  const auto x = has_order(measured.x, order), v = has_order(measured.v, order);
  return testing::AssertionResult(x && v) << "positions: " << x.message() << "\nvelocities: " << v.message();
}

/// `steps_in_duration` steps of the same size, not a whole number of them.
Errors run_to_the_end(const Problem& problem, const Method& method, double steps_in_duration) {
  Errors errors;
  Integrator integrator(problem.ode, method, tight(), problem.start, start_time);
  const auto run = integrate(integrator, start_time + duration, duration / steps_in_duration,
                             [&](const StepReport& step) { errors.see(problem, step.t, step.y); });
  EXPECT_EQ(run.outcome, Outcome::success) << run.message;
  EXPECT_NEAR(run.last_good_time, start_time + duration, 1e-12);
  return errors;
}

Errors run_with(const Problem& problem, const Method& method, const std::vector<double>& steps) {
  Errors errors;
  Integrator integrator(problem.ode, method, tight(), problem.start, start_time);
  for (const double h : steps) {
    EXPECT_EQ(integrator.step(h).outcome, Outcome::success) << "at t = " << integrator.time();
    errors.see(problem, integrator.time(), integrator.state());
  }
  return errors;
}

/// How large the steps are beside each other. The patterns are the same for all refinements, so that the ratio of neighbours
/// does not tend to 1: only then does a formula for equal steps lose its order.
struct Pattern {
  std::string name;
  double (*size)(int step);
};
const Pattern patterns[] = {
    {"waves", [](int n) { return 1 + 0.4 * std::sin(0.9 * n); }},
    {"jumps", [](int n) { return n % 3 ? 1.5 : 1.0; }},
    {"up_and_down", [](int n) { return std::pow(1.5, n % 6 < 3 ? n % 6 : 6 - n % 6); }},
};

/// n steps of a pattern that add up to the duration.
std::vector<double> steps_of(const Pattern& pattern, int n) {
  std::vector<double> steps;
  double sum = 0;
  for (int k = 0; k < n; ++k) sum += steps.emplace_back(pattern.size(k));
  for (double& h : steps) h *= duration / sum;
  return steps;
}

Measured with_equal_steps(const Problem& problem, const Method& method) {
  Measured measured;
  for (const int n : refinements(method)) measured.add(duration / n, run_to_the_end(problem, method, n));
  return measured;
}

Measured with_a_clipped_last_step(const Problem& problem, const Method& method) {
  Measured measured;
  for (const int n : refinements(method)) measured.add(duration / (n + 0.37), run_to_the_end(problem, method, n + 0.37));
  return measured;
}

Measured with_variable_steps(const Problem& problem, const Method& method, const Pattern& pattern) {
  Measured measured;
  for (const int n : refinements(method)) measured.add(duration / n, run_with(problem, method, steps_of(pattern, n)));
  return measured;
}

class Order : public testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  const Method& method = solver::method(std::get<0>(GetParam()));
  const Problem problem = problem_named(std::get<1>(GetParam()));
};
INSTANTIATE_TEST_SUITE_P(, Order,
                         testing::Combine(testing::ValuesIn(names(converging_methods())), testing::ValuesIn(names(problems()))),
                         [](const auto& test) { return identifier(std::get<0>(test.param)) + "_" + std::get<1>(test.param); });

TEST_P(Order, IsTheDeclaredOneWithEqualSteps) {
  DRAPE_SLOW();
  EXPECT_TRUE(has_order(with_equal_steps(problem, method), method.order));
}

TEST_P(Order, IsTheDeclaredOneWithAClippedLastStep) {
  DRAPE_SLOW();
  EXPECT_TRUE(has_order(with_a_clipped_last_step(problem, method), method.order));
}

TEST_P(Order, IsTheDeclaredOneWithVariableSteps) {
  DRAPE_SLOW();
  for (const Pattern& pattern : patterns)
    EXPECT_TRUE(has_order(with_variable_steps(problem, method, pattern), method.order)) << pattern.name;
}

// Negative controls: what the checks above must reject.

/// A row of the table with another step.
Method with_step(std::string_view name, void (*step)(Step&)) {
  Method row = solver::method(name);
  row.step = step;
  return row;
}
Method with_order(std::string_view name, int order) {
  Method row = solver::method(name);
  row.order = order;
  return row;
}

TEST(OrderCheck, RejectsWhatTheThesisPrintsForVariableSteps) {
  DRAPE_SLOW();
  const Method printed = with_step("sbdf2", [](Step& s) {  // f̂ = 2 f0 − f₋₁ for every w
    if (s.w() == 0) return imex_midpoint(s);
    const auto [c1, c2, c3] = bdf2_coefficients(s.w());
    Vectors &ax = s.scratch.ax, &av = s.scratch.av, &f_hat = s.scratch.f_hat;
    ax = c1 * s.y0().x - c2 * s.ym1().x;
    av = c1 * s.y0().v - c2 * s.ym1().v;
    f_hat = 2 * s.explicit_force(s.now(), s.t) - s.explicit_force(s.history[1], s.t - s.h / s.w());
    s.accept(s.stage->solve_linear({c3 * s.h, s.t + s.h, ax, av}, f_hat, s.y1()));
  });
  EXPECT_TRUE(has_order(with_equal_steps(free_particles(), printed), 2));
  for (const Pattern& pattern : patterns)
    EXPECT_FALSE(has_order(with_variable_steps(free_particles(), printed, pattern), 2)) << pattern.name;
}

TEST(OrderCheck, RejectsCoefficientsThatIgnoreTheRatioOfSteps) {
  DRAPE_SLOW();
  const Method constant = with_step("bdf2", [](Step& s) {
    if (s.w() == 0) return midpoint(s);
    const auto [c1, c2, c3] = bdf2_coefficients(1);
    Vectors &ax = s.scratch.ax, &av = s.scratch.av;
    ax = c1 * s.y0().x - c2 * s.ym1().x;
    av = c1 * s.y0().v - c2 * s.ym1().v;
    s.solve({c3 * s.h, s.t + s.h, ax, av}, solver::bdf2_error(1));
  });
  EXPECT_TRUE(has_order(with_equal_steps(free_particles(), constant), 2));
  EXPECT_FALSE(has_order(with_a_clipped_last_step(free_particles(), constant), 2));
  for (const Pattern& pattern : patterns)
    EXPECT_FALSE(has_order(with_variable_steps(free_particles(), constant, pattern), 2)) << pattern.name;
}

TEST(OrderCheck, RejectsForcesAtTheWrongTime) {
  DRAPE_SLOW();
  const Method early = with_step("midpoint", [](Step& s) {
    s.t -= s.h / 2;
    midpoint(s);
    s.t += s.h / 2;
  });
  EXPECT_FALSE(has_order(with_equal_steps(free_particles(), early), 2));
}

TEST(OrderCheck, RejectsMethodsThatAreWorseOrBetterThanDeclared) {
  DRAPE_SLOW();
  for (const auto& [name, order] :
       {std::pair("imex-euler", 2), {"implicit-euler", 2}, {"bdf2", 1}, {"sbdf2", 3}, {"verlet", 1}}) {
    const Method wrong = with_order(name, order);
    EXPECT_FALSE(has_order(with_equal_steps(free_particles(), wrong), wrong.order)) << name;
  }
}

TEST(OrderCheck, WantsThreeRefinementsAndNumbers) {
  DRAPE_SLOW();
  EXPECT_TRUE(has_order(Convergence{{8, 4, 2, 1}, {64, 16, 4, 1}}, 2));
  EXPECT_FALSE(has_order(Convergence{{4, 2, 1}, {16, 4, 1}}, 2));
  EXPECT_FALSE(has_order(Convergence{{8, 4, 2, 1}, {64, 16, 4}}, 2));
  EXPECT_FALSE(has_order(Convergence{{8, 4, 2, 1}, {64, 16, 4, std::nan("")}}, 2));
  EXPECT_FALSE(has_order(Convergence{{8, 4, 2, 1}, {64, 16, 4, 0}}, 2));
}

TEST(OrderCheck, AllowsATenthBetweenNeighbours) {
  DRAPE_SLOW();
  const auto last = [](double order) { return Convergence{{8, 4, 2, 1}, {64, 16, 4, 4 / std::exp2(order)}}; };
  EXPECT_TRUE(has_order(last(2.09), 2));
  EXPECT_FALSE(has_order(last(2.11), 2));
  EXPECT_TRUE(has_order(last(1.91), 2));
  EXPECT_FALSE(has_order(last(1.89), 2));
}

}  // namespace
}  // namespace drape::verify::orders_test
