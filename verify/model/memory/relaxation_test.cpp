// Sheets that remember: a chain of Maxwell elements against its exact motion, for every method; cycles of a strip against
// closed forms; what is stored and lost.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <unsupported/Eigen/MatrixFunctions>

#include "model/cloth.hpp"
#include "reference/reference.hpp"
#include "reference/sundials/arkode.hpp"
#include "reference/sundials/cvode.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/model_fixtures.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::relaxation_test {
namespace {

using model::Cloth;
using model::Scene;
using model::Spectrum;
using solver::Method;
using solver::Outcome;
using solver::State;
using solver::Vectors;
using namespace small_problems;

const Spectrum spectrum{{2, 0.25}, {15, 0.2}, {90, 0.15}};

/// A strip of 5 particles in a line, its first at rest, whose motion stays in the line.
Scene chain() {
  Scene scene;
  scene.name = "chain";
  scene.sheet.grid = {.nu = 5, .nv = 1, .size_u = 1, .size_v = 0.5};
  scene.sheet.material.density = 1;
  scene.sheet.material.tension = {20, 20};
  scene.sheet.material.relaxation.maxwell = spectrum;
  scene.sheet.gravity = {2, 0, 0};
  scene.pins = {{.where = {}, .particles = {{0, 0}}}};
  scene.start.stretch = {1.1, 1};
  return scene;
}

/// d(x, v, z, 1)/dt = A (x, v, z, 1) of the chain: linear, since no edge turns.
Eigen::MatrixXd linear_motion(const Scene& scene, const Cloth& cloth) {
  const int n = 5, edges = n - 1, lines = static_cast<int>(spectrum.size());
  const int v = n, z = 2 * n, one = z + edges * lines;
  const double l = scene.sheet.grid.spacing_u(), pull = scene.sheet.material.tension.weft * scene.sheet.grid.size_v;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(one + 1, one + 1);
  for (int i = 1; i < n; ++i) {
    A(i, v + i) = 1;
    A(v + i, one) = scene.sheet.gravity.x();
  }
  for (int e = 0; e < edges; ++e)
    for (const int end : {e, e + 1}) {
      if (end == 0) continue;
      const double weight = (end == e ? 1 : -1) * pull / cloth.ode.mass[end];
      A(v + end, e + 1) += weight / l;
      A(v + end, e) -= weight / l;
      A(v + end, one) -= weight;
      for (int k = 0; k < lines; ++k) A(v + end, z + e * lines + k) -= weight * spectrum[k].part;
    }
  for (int e = 0; e < edges; ++e)
    for (int k = 0; k < lines; ++k) {
      const int row = z + e * lines + k;
      A(row, e + 1) = spectrum[k].rate / l;
      A(row, e) = -spectrum[k].rate / l;
      A(row, one) = -spectrum[k].rate;
      A(row, row) = -spectrum[k].rate;
    }
  return A;
}

State exact_state(const Scene& scene, const Cloth& cloth, double t) {
  const Eigen::MatrixXd A = linear_motion(scene, cloth);
  Eigen::VectorXd y0(A.rows());
  y0 << cloth.start.x.col(0), cloth.start.v.col(0), cloth.start.z, 1;
  const Eigen::VectorXd y1 = (t * A).exp() * y0;
  State state = cloth.start;
  state.x.col(0) = y1.head(5);
  state.v.col(0) = y1.segment(5, 5);
  state.z = y1.segment(10, cloth.start.z.size());
  return state;
}

constexpr double duration = 0.4;  // [s]

struct Errors {
  double x, v, z;
};

Errors errors(const Method& method, int steps, double unequal) {
  const Scene scene = chain();
  const Cloth cloth = model::compile(scene);
  solver::Integrator integrator(cloth.ode, method, tight(), cloth.start);
  const double h = duration / steps;
  for (int k = 0; k < steps; ++k)
    EXPECT_EQ(integrator.step(k % 2 == 0 ? (1 + unequal) * h : (1 - unequal) * h).outcome, Outcome::success);
  const State &y = integrator.state(), exact = exact_state(scene, cloth, duration);
  return {(y.x - exact.x).norm(), (y.v - exact.v).norm(), (y.z - exact.z).norm()};
}

class Remembering : public testing::TestWithParam<std::string> {
 protected:
  const Method& method = solver::method(GetParam());
};
INSTANTIATE_TEST_SUITE_P(, Remembering, testing::ValuesIn(names(converging_methods())),
                         [](const auto& test) { return identifier(test.param); });

/// From where on the order rules to where round-off does.
std::vector<int> refinements(const Method& method) {
  if (method.name == "bdf4") return {768, 896, 1024, 1280};
  if (method.order == 5) return {576, 640, 768, 896};
  if (method.order == 4) return {192, 256, 384, 512};
  return {256, 512, 1024, 2048};
}

TEST_P(Remembering, HasTheDeclaredOrder) {
  DRAPE_SLOW();
  const double tolerance = method.order == 5 ? 0.15 : 0.1;  // round-off comes before the fifth order has settled
  for (const double unequal : {0.0, 0.2}) {
    Convergence x, v, z;
    for (const int n : refinements(method)) {
      const Errors now = errors(method, n, unequal);
      for (auto [list, error] : {std::pair{&x, now.x}, {&v, now.v}, {&z, now.z}})
        list->steps.push_back(duration / n), list->errors.push_back(error);
    }
    EXPECT_TRUE(has_order(x, method.order, tolerance)) << "positions, unequal = " << unequal;
    EXPECT_TRUE(has_order(v, method.order, tolerance)) << "velocities, unequal = " << unequal;
    EXPECT_TRUE(has_order(z, method.order, tolerance)) << "internal variables, unequal = " << unequal;
  }
}

/// A step of n sub-steps is n steps: also to what is remembered.
TEST(Relaxation, IsRememberedFromSubStepToSubStep) {
  for (const char* name : {"verlet", "rk4-substeps", "bridson", "xpbd"}) {
    const Cloth whole = model::compile(chain()), parted = model::compile(chain());
    solver::Options options = tight();
    const bool projects = std::string_view(name) == "xpbd";
    solver::Integrator one(whole.ode, solver::method(name), options, whole.start);
    ASSERT_EQ(one.step(duration).outcome, Outcome::success) << name;
    const auto count = projects ? options.sub_steps : whole.ode.work->counter("substeps", "");
    ASSERT_GE(count, 3) << name;
    options.sub_steps = 1;
    solver::Integrator many(parted.ode, solver::method(name), options, parted.start);
    for (int k = 0; k < count; ++k)
      ASSERT_EQ(many.step(duration / static_cast<double>(count)).outcome, Outcome::success) << name;
    EXPECT_LT((one.state().x - many.state().x).norm(), 1e-10) << name;
    EXPECT_LT((one.state().z - many.state().z).norm(), 1e-10) << name;
    EXPECT_GT(one.state().z.norm(), 1e-3) << name;
  }
}

// What must fail: without the right path a method loses its order.

/// The table's row with another order, as which it asks for a path.
Method declared_as(std::string_view name, int order) {
  Method method = solver::method(name);
  method.order = order;
  return method;
}

Convergence positions(const Method& method) {
  Convergence c;
  for (const int n : refinements(method)) c.steps.push_back(duration / n), c.errors.push_back(errors(method, n, 0).x);
  return c;
}

TEST(Relaxation, OnALinearPathOrdersAboveTwoAreLost) {
  EXPECT_FALSE(has_order(positions(declared_as("esdirk3", 2)), 3));
  EXPECT_TRUE(has_order(positions(declared_as("esdirk3", 2)), 2));
}

TEST(Relaxation, OnACubicPathOrderFiveIsLost) { EXPECT_FALSE(has_order(positions(declared_as("bdf5", 4)), 5)); }

// --- Prescribed strains: a strip between two hands ---------------------------------------------------------------------------

/// One edge, both ends of which are moved by hand, and its pull.
class Strip {
 public:
  /// With what a harmonic pull ε sin ωt has left at t = 0, if there is one.
  explicit Strip(const Spectrum& relaxation, double amplitude = 0, double omega = 0) {
    scene_.sheet.grid = {.nu = 2, .nv = 1, .size_u = 0.2, .size_v = 0.05};
    scene_.sheet.material.tension = {300, 300};
    scene_.sheet.material.relaxation.maxwell = relaxation;
    cloth_ = model::compile(scene_);
    y_ = cloth_.start;
    for (std::size_t l = 0; l < relaxation.size(); ++l) {
      const double rate = relaxation[l].rate;
      y_.z[static_cast<Eigen::Index>(l)] = amplitude * (rate / std::complex<double>(rate, omega)).imag();
    }
    cloth_.ode.memory->begin(2, 0, y_);
  }

  /// Goes to this strain at time t. Returns the stress k (ε − Σ Y ζ) [N/m].
  double go(double t, double strain) {
    y_.x(1, 0) = y_.x(0, 0) + (1 + strain) * scene_.sheet.grid.size_u;
    cloth_.ode.memory->carry(t, y_);
    cloth_.ode.memory->pass(t, y_);
    Vectors f;
    cloth_.ode.force(t, y_.x, y_.v, f);
    return f(0, 0) / scene_.sheet.grid.size_v;
  }

  /// Stored energy over area [J/m²].
  double energy(double t) const { return solver::stored_energy(cloth_.ode, t, y_) / (0.2 * 0.05); }

 private:
  Scene scene_;
  Cloth cloth_;
  State y_;
};

constexpr double k = 300;
using std::numbers::pi;

/// ζ at the end of a ramp from strain a to b in a time h: the exact solution of dζ/dt = ω (ε − ζ).
double after_ramp(double zeta, double omega, double h, double a, double b) {
  const double decay = std::exp(-omega * h), speed = (b - a) / h;
  return b - speed / omega + (zeta - a + speed / omega) * decay;
}

TEST(Relaxation, OfATriangleWaveIsExactHoweverLongTheSteps) {
  Strip strip(spectrum);
  std::vector<double> zeta(spectrum.size(), 0.0);
  double t = 0, before = 0;
  for (const double strain : {0.05, 0.0, 0.08, -0.02, 0.0, 0.08, 0.08})
    for (int half = 1; half <= 2; ++half) {
      const double h = half == 1 ? 0.03 : 0.05, to = half == 1 ? before + 0.375 * (strain - before) : strain;
      double stress = to;
      const double from = half == 1 ? before : before + 0.375 * (strain - before);
      for (std::size_t l = 0; l < spectrum.size(); ++l) {
        zeta[l] = after_ramp(zeta[l], spectrum[l].rate, h, from, to);
        stress -= spectrum[l].part * zeta[l];
      }
      EXPECT_NEAR(strip.go(t += h, to), k * stress, 1e-12 * k) << "at t = " << t;
      if (half == 2) before = strain;
    }
}

struct Loop {
  double area, closed_form;
};

/// The loop of stress and strain of a strip that is pulled harmonically, over one period of many: ∮ σ dε/dt dt, for which the
/// rectangle rule is exact.
Loop loop(const Spectrum& relaxation, double omega, int steps) {
  constexpr double amplitude = 0.03;
  Strip strip(relaxation, amplitude, omega);
  const double h = 2 * pi / omega / steps;
  double area = 0;
  for (int n = 1; n <= steps; ++n) {
    const double sigma = strip.go(h * n, amplitude * std::sin(omega * h * n));
    area += sigma * amplitude * omega * std::cos(omega * h * n) * h;
  }
  return {area, pi * amplitude * amplitude * k * complex_modulus(relaxation, omega).imag()};
}

TEST(Relaxation, LosesInAPeriodWhatTheComplexModulusSays) {
  const Spectrum relaxation = model::constant_quality(10, {1, 1000});
  for (const double omega : {2.0, 30.0, 500.0}) {
    Convergence c;
    for (const int steps : {50, 100, 200, 400}) {
      const Loop now = loop(relaxation, omega, steps);
      c.steps.push_back(1.0 / steps), c.errors.push_back(std::abs(now.area / now.closed_form - 1));
    }
    EXPECT_TRUE(has_order(c, 2)) << "omega = " << omega;
    EXPECT_LT(c.errors[2], 1e-4) << "omega = " << omega;
  }
}

/// The work on a straight path less what is stored: exactly, at any length of the steps.
TEST(Relaxation, LosesEnergyInEveryStep) {
  for (const double h : {1e-4, 1e-2, 1.0}) {
    Strip strip(spectrum);
    const Vectors strains = noise(40, 7);
    double strain = 0, stored = 0;
    std::vector<double> zeta(spectrum.size(), 0.0);
    for (int n = 0; n < strains.rows(); ++n) {
      const double now = 0.1 * strains(n, 0);
      double work = k * 0.5 * (now * now - strain * strain);
      for (std::size_t l = 0; l < spectrum.size(); ++l) {
        const auto [rate, part] = spectrum[l];
        const double after = after_ramp(zeta[l], rate, h, strain, now);
        // ∫ ζ dε over the ramp, with ζ = ε − dζ/dt/ω
        const double integral = (now - strain) * (0.5 * (now + strain) - (after - zeta[l]) / (rate * h));
        work -= k * part * integral;
        zeta[l] = after;
      }
      strip.go((n + 1) * h, now);
      const double energy = strip.energy((n + 1) * h);
      EXPECT_GE(work - (energy - stored), -1e-13 * k) << "step " << n << " of " << h;
      strain = now, stored = energy;
    }
  }
}

// --- Sheets ------------------------------------------------------------------------------------------------------------------

Scene sheet() {
  Scene scene;
  scene.name = "sheet";
  scene.sheet.grid = {.nu = 4, .nv = 4, .size_u = 0.4, .size_v = 0.4};
  scene.sheet.material.density = 0.3;
  scene.sheet.material.tension = {60, 40};
  scene.sheet.material.shear = 8;
  scene.sheet.material.bend = {1e-3, 1e-3};
  scene.sheet.material.relaxation.maxwell = spectrum;
  scene.sheet.gravity = {0, 0, -9.81};
  scene.pins = {{.where = {}, .particles = {{0, 3}, {3, 3}}}};
  return scene;
}

TEST(Relaxation, IsTheSameToCvodeToArkodeAndToBdf2) {
  const Scene scene = sheet();
  const Cloth cloth = model::compile(scene);
  const std::vector<double> times{0.1, 0.3};
  const reference::SolveOptions options{.rtol = 1e-9, .size = 0.4};
  const auto adams = reference::cvode_adams(cloth.ode, cloth.start, 0, times, options);
  const auto bdf = reference::cvode(cloth.ode, cloth.start, 0, times, options);
  const auto esdirk = reference::arkode_esdirk(cloth.ode, cloth.start, 0, times, options);
  const auto erk = reference::arkode_erk(cloth.ode, cloth.start, 0, times, options);
  for (const auto* other : {&bdf, &esdirk, &erk})
    for (std::size_t n = 0; n < times.size(); ++n) {
      EXPECT_LT((other->states[n].x - adams.states[n].x).norm(), 1e-7);
      EXPECT_LT((other->states[n].z - adams.states[n].z).norm(), 1e-6);
    }
  Convergence c;
  for (const int steps : {150, 300, 600, 1200}) {
    solver::Integrator integrator(cloth.ode, solver::method("bdf2"), tight(), cloth.start);
    EXPECT_EQ(integrate(integrator, 0.3, 0.3 / steps).outcome, Outcome::success);
    c.steps.push_back(0.3 / steps), c.errors.push_back((integrator.state().x - adams.states[1].x).norm());
  }
  EXPECT_TRUE(has_order(c, 2));
}

/// Where a path begins, and on a linear path, which the slope of its end belongs to.
TEST(Relaxation, HasItsDerivativesInTheJacobian) {
  const Scene scene = sheet();
  const Cloth cloth = model::compile(scene);
  State y = sheets::deformed(scene.sheet.grid, 3);
  y.z = Eigen::VectorXd::Map(noise(cloth.ode.memory->variables() / 3, 5).data(), cloth.ode.memory->variables());
  y.z *= 0.1;
  cloth.ode.memory->begin(2, 0, y);
  const State moved = sheets::deformed(scene.sheet.grid, 4);
  for (const double t : {0.0, 0.05}) {
    solver::SparseMatrix dx, dv;
    cloth.ode.jacobian(t, moved.x, moved.v, dx, dv);
    constexpr double step = 1e-6;
    double largest_entry = 0, worst = 0;
    for (Eigen::Index i = 0; i < moved.x.size(); ++i) {
      Vectors ahead = moved.x, behind = moved.x, f1, f0;
      ahead.data()[i] += step;
      behind.data()[i] -= step;
      cloth.ode.force(t, ahead, moved.v, f1);
      cloth.ode.force(t, behind, moved.v, f0);
      const Vectors difference = (f1 - f0) / (2 * step);
      const Eigen::VectorXd column = Eigen::MatrixXd(dx).col(i);
      const Eigen::VectorXd numerical = Eigen::VectorXd::Map(difference.data(), difference.size());
      worst = std::max(worst, (column - numerical).cwiseAbs().maxCoeff());
      largest_entry = std::max(largest_entry, numerical.cwiseAbs().maxCoeff());
    }
    EXPECT_LT(worst, 1e-6 * largest_entry) << "t = " << t;
  }
}

TEST(Relaxation, IsRestartedFromAState) {
  const Scene scene = sheet();
  const Cloth cloth = model::compile(scene), again = model::compile(scene);
  solver::Integrator whole(cloth.ode, solver::method("midpoint"), tight(), cloth.start);
  EXPECT_EQ(integrate(whole, 0.1, 0.01).outcome, Outcome::success);
  const State between = whole.state();
  EXPECT_EQ(integrate(whole, 0.2, 0.01).outcome, Outcome::success);
  solver::Integrator rest(again.ode, solver::method("midpoint"), tight(), between, 0.1);
  EXPECT_EQ(integrate(rest, 0.2, 0.01).outcome, Outcome::success);
  EXPECT_LT((rest.state().x - whole.state().x).norm(), 1e-10);
  EXPECT_LT((rest.state().z - whole.state().z).norm(), 1e-10);
  State forgetful = between;
  forgetful.z.setZero();
  solver::Integrator other(again.ode, solver::method("midpoint"), tight(), forgetful, 0.1);
  EXPECT_EQ(integrate(other, 0.2, 0.01).outcome, Outcome::success);
  EXPECT_GT((other.state().x - whole.state().x).norm(), 1e-4);
}

TEST(Relaxation, CostsNothingWhereThereIsNone) {
  Scene scene = sheet();
  scene.sheet.material.relaxation = {};
  const Cloth cloth = model::compile(scene);
  EXPECT_EQ(cloth.ode.memory, nullptr);
  solver::Integrator integrator(cloth.ode, solver::method("verlet"), {}, cloth.start);
  EXPECT_EQ(integrate(integrator, 0.1, 0.01).outcome, Outcome::success);
  EXPECT_EQ(integrator.state().z.size(), 0);
  EXPECT_EQ(cloth.ode.work->counter("memory_updates", ""), 0);
}

}  // namespace
}  // namespace drape::verify::relaxation_test
