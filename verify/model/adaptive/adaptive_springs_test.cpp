// Forces of springs that obstacles divide: as parts of the split equation, their derivatives, and what they do to momentum.

#include "model/adaptive/adaptive_springs.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include "verify/support/contact_scenes.hpp"

namespace drape::verify::adaptive_springs_test {
namespace {

using namespace contact_scenes;
using solver::SparseMatrix;
using solver::State;
using solver::Vectors;

constexpr double g = 9.81;

/// A square sheet of 0.4 m, its front upward at height 0, with a bar along y in it: from 0.085 to 0.295 m, its top at a height.
std::string over_a_bar(int n, double top, const std::string& more = "") {
  return fmt::format(
      "name = 'bar'\ngrid = {{ n = {}, size = 0.4 }}\nend.time = 0.3\n"
      "material = {{ tension = 300, damping = 0.15, density = 0.3 }}\n"
      "contact = {{ adaptive = true, distance = 1e-4 }}\n"
      "obstacles = [{{ shape = 'box', size = [0.21, 0.6, 0.2], position = [0.19, 0.2, {}] }}]\n{}",
      n, top - 0.1, more);
}

/// The same with a bar that rises, drifts and turns, by a number of degrees in 2 s.
std::string over_a_moving_bar(int n, double turn) {
  return fmt::format(
      "name = 'bar'\ngrid = {{ n = {}, size = 0.4 }}\nend.time = 0.3\n"
      "material = {{ tension = 300, damping = 0.15, density = 0.3 }}\n"
      "contact = {{ adaptive = true, distance = 1e-4 }}\n"
      "[[obstacles]]\nshape = 'box'\nsize = [0.21, 0.6, 0.2]\n"
      "motion = [{{ time = 0, position = [0.19, 0.2, -0.06] }},\n"
      "  {{ time = 2, position = [0.3, 0.1, 0.6], rotation = [0, 0, {}] }}]\n",
      n, turn);
}

const std::vector<std::string> damping_forms{"linear", "projected"};

Trial trial(const std::string& toml, const std::string& form = "linear", const std::vector<std::string>& sets = {}) {
  std::vector<model::Override> changes{model::parse_override("material.damping_form=" + form)};
  for (const std::string& set : sets) changes.push_back(model::parse_override(set));
  const model::Scene scene = model::parse_scene(toml, "test", changes);
  return {scene, model::compile(scene)};
}

Vectors random_field(const State& y, double size) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-size, size);
  return Vectors::NullaryExpr(y.x.rows(), 3, [&] { return any(random); });
}

/// A state near the start, as forces meet it during a step.
State later(const Trial& trial) {
  State y = trial.cloth.start;
  y.x += random_field(y, 5e-3);
  y.v += random_field(y, 0.3);
  return y;
}

std::int64_t divided(const Trial& trial) { return trial.cloth.ode.work->counter("divided_springs", ""); }

// --- Forces
// --------------------------------------------------------------------------------------------------------------------

/// The top of the bar is a hair above the sheet, which is stretched: the strain of parts is that of the whole.
TEST(AdaptiveSprings, ChangeNoForceOnALineAtRest) {
  const std::string toml = over_a_bar(4, 2e-12, "start.stretch = 1.2\n");
  const Trial with = trial(toml), without = trial(toml, "linear", {"contact.adaptive=false"});
  with.cloth.ode.step_forces->begin(0, with.cloth.start);
  ASSERT_EQ(divided(with), 8) << "two edges of the bar cut two springs in each of four rows: the bar is 1.5 cells broad";
  Vectors one, other;
  const State& y = with.cloth.start;
  with.cloth.ode.force(0, y.x, y.v, one);
  without.cloth.ode.force(0, y.x, y.v, other);
  ASSERT_GT(other.cwiseAbs().maxCoeff(), 1);
  EXPECT_LE((one - other).cwiseAbs().maxCoeff(), 1e-9 * other.cwiseAbs().maxCoeff());
}

/// Two particles of each row and the bar between them: forces by hand, Σ l_i = 0.085 + 0.21 + 0.105 at slopes.
TEST(AdaptiveSprings, PullAtTheEdgesOfTheObstacle) {
  constexpr double top = 0.05;
  const Trial over = trial(over_a_bar(2, top));
  const State& y = over.cloth.start;
  over.cloth.ode.step_forces->begin(0, y);
  ASSERT_EQ(divided(over), 2);
  Vectors f;
  over.cloth.ode.force(0, y.x, y.v, f);
  const double left = std::hypot(0.085, top), right = std::hypot(0.105, top), sum = left + 0.21 + right;
  const double strain = sum / 0.4 - 1, k = 300 * 0.2;
  for (const int row : {0, 1}) {
    EXPECT_NEAR((f.row(2 * row) - k * strain / left * Eigen::RowVector3d(0.085, 0, top)).norm(), 0, 1e-9) << row;
    EXPECT_NEAR((f.row(2 * row + 1) - k * strain / right * Eigen::RowVector3d(-0.105, 0, top)).norm(), 0, 1e-9) << row;
  }
}

/// A particle sees the edge of the bar in the place of its neighbour, whose velocity does not count: damping stops where it
/// moves as the bar does.
TEST(AdaptiveSprings, AreDampedAgainstTheVelocityOfTheObstacle) {
  const Eigen::RowVector3d drift(0.055, -0.05, 0.33), left(0.085, 0, 0.04), right(-0.105, 0, 0.04);
  const double length = 0.4 * left.norm() / (left.norm() + 0.21 + right.norm());
  for (const std::string& form : damping_forms) {
    Trial damped = trial(over_a_moving_bar(2, 0), form), elastic = trial(over_a_moving_bar(2, 0), form, {"material.damping=0"});
    const auto damping = [&](const Vectors& v) {
      const Vectors& x = damped.cloth.start.x;
      Vectors with, without;
      damped.cloth.ode.force(0, x, v, with);
      elastic.cloth.ode.force(0, x, v, without);
      return Vectors(with - without);
    };
    for (const Trial* one : {&damped, &elastic}) one->cloth.ode.step_forces->begin(0, one->cloth.start);
    const Eigen::RowVector3d along = form == "linear" ? drift : drift.dot(left.normalized()) * left.normalized();
    EXPECT_NEAR((damping(Vectors::Zero(4, 3)).row(0) - 0.15 * 0.2 / length * along).norm(), 0, 1e-8) << form;
    Vectors v = drift.replicate(4, 1);
    v.row(1) = v.row(3) = Eigen::RowVector3d(0, 0, 7);
    EXPECT_NEAR(damping(v).row(0).norm(), 0, 1e-8) << form;
    EXPECT_GT(damping(v).row(1).norm(), 0.1) << form;
  }
}

TEST(AdaptiveSprings, AreSplitAsTheirMatricesAre) {
  for (const std::string& form : damping_forms) {
    const Trial over = trial(over_a_moving_bar(4, 10), form);
    const solver::SplitOde& ode = over.cloth.ode;
    ode.step_forces->begin(0, over.cloth.start);
    ASSERT_GT(divided(over), 0);
    const State y = later(over);
    Vectors whole, explicit_part;
    ode.force(0.01, y.x, y.v, whole);
    ode.explicit_force(0.01, y.x, y.v, explicit_part);
    Vectors sum = explicit_part + ode.step_forces->stiffness() * y.x;
    if (ode.damping.nonZeros() > 0) sum += ode.step_forces->damping() * y.v;
    EXPECT_LE((sum - whole).cwiseAbs().maxCoeff(), 1e-11 * whole.cwiseAbs().maxCoeff()) << form;
    EXPECT_GT((ode.stiffness - ode.step_forces->stiffness()).norm(), 1) << form;
    EXPECT_LE(Vectors(explicit_part).norm(), 1e3) << form;
  }
}

TEST(AdaptiveSprings, HaveTheirJacobian) {
  for (const std::string& form : damping_forms) {
    const Trial over = trial(over_a_moving_bar(3, 10), form);
    const solver::SplitOde& ode = over.cloth.ode;
    SparseMatrix dx, dv;
    const State start = over.cloth.start;
    ode.jacobian(0, start.x, start.v, dx, dv);  // whose pattern is that of all later ones
    ode.step_forces->begin(0, start);
    ASSERT_GT(divided(over), 0);
    State y = later(over);
    ode.jacobian(0.01, y.x, y.v, dx, dv);
    const double step = 1e-6;
    for (Eigen::Index k = 0; k < y.x.size(); ++k) {
      const auto column = [&](Vectors State::*field) {
        double& value = (y.*field).data()[k];
        const double before = value;
        Vectors above, below;
        value = before + step;
        ode.force(0.01, y.x, y.v, above);
        value = before - step;
        ode.force(0.01, y.x, y.v, below);
        value = before;
        return Vectors((above - below) / (2 * step));
      };
      const Vectors by_x = column(&State::x), by_v = column(&State::v);
      const auto off = [&](const SparseMatrix& J, const Vectors& by) {
        return (Eigen::VectorXd(J.col(k)) - Eigen::Map<const Eigen::VectorXd>(by.data(), by.size())).cwiseAbs().maxCoeff();
      };
      EXPECT_LE(off(dx, by_x), 1e-5 * dx.norm()) << form << ", " << k;
      EXPECT_LE(off(dv, by_v), 1e-7 * dv.norm()) << form << ", " << k;
    }
  }
}

TEST(AdaptiveSprings, HaveTheEnergyOfTheirForces) {
  const Trial over = trial(over_a_moving_bar(3, 10), "linear", {"material.damping=0"});
  const solver::SplitOde& ode = over.cloth.ode;
  ode.step_forces->begin(0, over.cloth.start);
  ASSERT_GT(divided(over), 0);
  const State y = later(over);
  const double t = 0.01, step = 1e-6;
  Vectors f;
  ode.force(t, y.x, y.v, f);
  for (Eigen::Index k = 0; k < y.x.size(); ++k) {
    const auto energy = [&](double by) {
      State moved = y;
      moved.x.data()[k] += by;
      return solver::stored_energy(ode, t, moved);
    };
    EXPECT_NEAR(f.data()[k], (energy(-step) - energy(step)) / (2 * step), 1e-5 * f.norm()) << k;
  }
}

/// Also where parts are compressed: a bar in a slack sheet.
TEST(AdaptiveSprings, LeaveNewtonMatricesPositiveDefinite) {
  for (const std::string& form : damping_forms) {
    const Trial over = trial(over_a_bar(3, 0.05, "start.stretch = 0.5\n"), form);
    const solver::SplitOde& ode = over.cloth.ode;
    ode.step_forces->begin(0, over.cloth.start);
    ASSERT_GT(divided(over), 0);
    const State y = later(over);
    for (const solver::Jacobian part : {solver::Jacobian::whole, solver::Jacobian::tension}) {
      SparseMatrix J;
      ode.newton_matrix(0.01, y.x, y.v, 1, part, J);
      const Eigen::MatrixXd full = Eigen::MatrixXd(J).selfadjointView<Eigen::Upper>();
      EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(full).info(), Eigen::Success) << form;
    }
  }
}

/// Else stages would chase a force that moves with them.
TEST(AdaptiveSprings, StayTheSameDuringAStep) {
  const Trial over = trial(over_a_bar(4, 0.03));
  const solver::SplitOde& ode = over.cloth.ode;
  ode.step_forces->begin(0, over.cloth.start);
  const std::int64_t before = ode.step_forces->changes();
  State y = over.cloth.start, above = y;
  Vectors first, again;
  ode.force(0, y.x, y.v, first);
  above.x.col(2).array() += 1;
  ode.force(0, above.x, above.v, again);
  ode.force(0, y.x, y.v, again);
  EXPECT_EQ(first, again);
  ode.step_forces->begin(0, y);
  EXPECT_EQ(ode.step_forces->changes(), before) << "the same step";
  ode.step_forces->begin(0.01, above);
  EXPECT_EQ(ode.step_forces->changes(), before + 1);
  EXPECT_EQ(SparseMatrix(ode.step_forces->stiffness() - ode.stiffness).norm(), 0) << "nothing is divided";
}

// --- Momentum
// ------------------------------------------------------------------------------------------------------------------

class Balance : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, Balance, testing::ValuesIn(methods()), [](const auto& test) {
  std::string name = test.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

/// The weight of a sheet that lies over a bar is what its virtual particles bear. Both methods of Euler say so to the tolerance
/// of their stages, the others as far as the trapezoidal rule is right.
TEST_P(Balance, ClosesWithTheImpulsesOfVirtualParticles) {
  const std::string& method = GetParam();
  const bool exact = method == "implicit-euler" || method == "imex-euler";
  const Trial four = builtin("box_four");
  const double h = 0.001, weight = g * four.cloth.ode.mass.sum();
  solver::Options tight;
  tight.loop_tolerance = tight.cg_tolerance = 1e-12;
  tight.stage_accuracy = 1e-10;
  tight.stage = &solver::stage_kind("newton");
  const auto moments = run(four, method, h, tight);
  const auto momentum = [&](const Moment& moment) { return Eigen::Vector3d(moment.y.v.transpose() * four.cloth.ode.mass); };
  Eigen::Vector3d off = Eigen::Vector3d::Zero();
  double most = 0, borne = 0;
  for (std::size_t k = 1; k < moments.size(); ++k) {
    const Eigen::Vector3d fallen = (moments[k].t - moments[k - 1].t) * Eigen::Vector3d(0, 0, -weight);
    const Eigen::Vector3d missing = momentum(moments[k]) - momentum(moments[k - 1]) - moments[k].contacts.impulse - fallen;
    off += missing;
    most = std::max(most, missing.norm());
    borne += moments[k].contacts.impulse.z();
  }
  const double total = weight * four.scene.end;
  EXPECT_LE(off.norm(), 0.01 * total);
  EXPECT_GT(borne, 0.5 * total);
  if (exact) {
    EXPECT_LE(most, 1e-7 * h * weight);
  }
}

// --- Refusals
// ------------------------------------------------------------------------------------------------------------------

std::string refusal(const std::string& toml) {
  try {
    model::parse_scene(toml, "a.toml");
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(AdaptiveSprings, NeedASheetWithLinearTension) {
  const std::string obstacle = "obstacles = [{ shape = 'sphere', radius = 1, position = [0, 0, -2] }]\n";
  const std::string chain = refusal("grid = { n = [4, 1], size = [1, 0.1] }\ncontact.adaptive = true\n" + obstacle);
  EXPECT_THAT(chain, testing::HasSubstr("contact.adaptive: expected a sheet, without panels"));
  const std::string curve = refusal("grid.n = 3\nmaterial.weft_curve = [[0, 0], [1, 2]]\ncontact.adaptive = true\n" + obstacle);
  EXPECT_THAT(curve, testing::HasSubstr("contact.adaptive: expected tension by the moduli alone"));
}

}  // namespace
}  // namespace drape::verify::adaptive_springs_test
