// The study `field`: who wins, by how much, and what a setting is worth elsewhere, from made-up runs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bench/runs/lag.hpp"
#include "bench/studies/field/winners.hpp"

namespace drape::verify::field_test {
namespace {

using bench::FieldRun;
using bench::FieldWinner;
using bench::Lead;
using bench::Settings;
using bench::SheetResult;
using results::Standing;

FieldRun made_up(const std::string& method, double value, double error, double ms, bool recommended = false) {
  FieldRun run{.method = method, .value = value, .recommended = recommended};
  run.error = error;
  run.times = {0.99 * ms, ms, 1.01 * ms};
  return run;
}

SheetResult sheet_of(const std::string& scene, std::vector<FieldRun> runs) {
  return {{scene, 5, 20, 1}, 5, 20, 1e-6, "", std::move(runs)};
}

SheetResult one_sheet() {
  return sheet_of("hung-edge", {made_up("bdf2", 0.01, 5e-3, 10, true), made_up("bdf2", 0.005, 5e-4, 20),
                                made_up("bdf3", 0.01, 5e-3, 12), made_up("sbdf2", 0.01, 5e-2, 2, true),
                                made_up("sbdf2", 0.0025, 5e-3, 8), made_up("verlet", 0.9, 1e-5, 20.05, true)});
}

FieldWinner at(const std::vector<FieldWinner>& winners, double error) {
  for (const FieldWinner& one : winners)
    if (one.error == error) return one;
  return {};
}

TEST(FieldWinner, IsTheQuickestWithTheErrorAndIsComparedWithAnotherFamily) {
  const std::vector<SheetResult> sheets{one_sheet()};
  const auto tuned = field_winners(sheets, Settings::tuned);
  const FieldWinner two_digits = at(tuned, 1e-2);
  EXPECT_EQ(two_digits.best->setting(), "sbdf2, h = 0.0025 s");
  EXPECT_EQ(two_digits.next->setting(), "bdf2, h = 0.01 s") << "not a method of its own family";
  EXPECT_DOUBLE_EQ(*two_digits.margin(), 10.0 / 8);
  EXPECT_EQ(two_digits.lead(), Lead::clear);
}

TEST(FieldWinner, HasOnlyTheSettingsThatItMay) {
  const std::vector<SheetResult> sheets{one_sheet()};
  const FieldWinner two_digits = at(field_winners(sheets, Settings::recommended), 1e-2);
  EXPECT_EQ(two_digits.best->setting(), "bdf2, h = 0.01 s");
  EXPECT_EQ(two_digits.next->setting(), "verlet, 0.9 of its limit");
}

TEST(FieldWinner, TiesWhereTimesOverlapAndIsAloneWhereNoOtherFamilyComes) {
  const std::vector<SheetResult> sheets{one_sheet()};
  const auto tuned = field_winners(sheets, Settings::tuned);
  EXPECT_EQ(at(tuned, 1e-3).lead(), Lead::tie);
  EXPECT_EQ(at(tuned, 1e-4).lead(), Lead::alone);
  EXPECT_FALSE(at(tuned, 1e-4).margin().has_value());
  EXPECT_EQ(at(field_winners({sheet_of("hung-edge", {})}, Settings::tuned), 1e-2).best, nullptr);
}

TEST(FieldWinner, IsNotSoughtBelowTheReference) {
  std::vector<SheetResult> sheets{one_sheet()};
  sheets[0].uncertainty = 1e-3;
  EXPECT_THAT(field_levels(sheets[0]), testing::ElementsAre(1e-1, 1e-2));
  sheets[0].uncertainty = NAN;
  EXPECT_THAT(field_levels(sheets[0]), testing::IsEmpty());
}

TEST(FieldWinner, IsNotARunThatFailedOrWasNotRepeated) {
  FieldRun failed = made_up("ros2", 0.01, 1e-3, 1), once = made_up("rk4", 0.01, 1e-3, 1);
  failed.outcome = solver::Outcome::unstable;
  once.times.resize(1);
  const std::vector<SheetResult> sheets{sheet_of("hung-edge", {failed, once, made_up("bdf2", 0.01, 5e-3, 10)})};
  EXPECT_EQ(at(field_winners(sheets, Settings::tuned), 1e-2).best->method, "bdf2");
}

TEST(TransferredSetting, IsThatOfTheTrainingSheet) {
  const std::vector<SheetResult> sheets{
      one_sheet(), sheet_of("hung-corners", {made_up("bdf2", 0.01, 5e-3, 10), made_up("bdf2", 0.005, 5e-4, 20),
                                             made_up("sbdf2", 0.0025, 0.3, 8), made_up("verlet", 0.9, 1e-5, 40)})};
  for (const bench::Transfer& row : transfers(sheets)) {
    EXPECT_EQ(row.sheet->sheet.scene, "hung-corners");
    if (row.error == 1e-2) {
      EXPECT_EQ(row.setting, "sbdf2, h = 0.0025 s");
      EXPECT_EQ(row.verdict(), (results::Verdict{Standing::missed, "error 0.3"}));
      EXPECT_DOUBLE_EQ(*row.ratio(), 0.8) << "quicker, but wrong";
    }
    if (row.error == 1e-3) {
      EXPECT_EQ(row.verdict().standing, Standing::met);
    }
  }
  EXPECT_THAT(transfers(sheets), testing::SizeIs(5)) << "from 1e-1 to 1e-5";
}

TEST(FieldAnswer, NamesTheFamilyThatWinsMostOften) {
  const std::vector<SheetResult> sheets{one_sheet(), one_sheet(), sheet_of("wind", {made_up("bdf2", 0.01, 5e-3, 10)})};
  for (const bench::FieldAnswer& row : field_answers(sheets)) {
    if (row.settings != Settings::tuned || row.error != 1e-2) continue;
    EXPECT_EQ(row.damping, "6 to 60");
    EXPECT_EQ(row.sheets, 3U);
    EXPECT_EQ(row.family, "semi-implicit");
    EXPECT_EQ(row.won, 2U);
    EXPECT_DOUBLE_EQ(*row.margin, 10.0 / 8);
  }
}

TEST(FieldFront, JoinsWhatNothingBeats) {
  const SheetResult sheet = one_sheet();
  std::vector<std::string> names;
  for (const FieldRun* run : front_of(sheet)) names.push_back(run->setting());
  EXPECT_THAT(
      names, testing::ElementsAre("sbdf2, h = 0.01 s", "sbdf2, h = 0.0025 s", "bdf2, h = 0.005 s", "verlet, 0.9 of its limit"));
}

TEST(Family, OfAMethodIsWhatItsStepSolves) {
  EXPECT_EQ(solver::method("bdf2").family(), "implicit multi-step");
  EXPECT_EQ(solver::method("midpoint").family(), "implicit one-step");
  EXPECT_EQ(solver::method("sbdf2").family(), "semi-implicit");
  EXPECT_EQ(solver::method("ros2").family(), "linearly implicit");
  EXPECT_EQ(solver::method("bridson").family(), "explicit") << "its springs are";
  for (const solver::Method& method : solver::methods()) EXPECT_FALSE(method.family().empty()) << method.name;
}

/// One particle that moves along x with a growing velocity.
reference::Trajectory accelerating() {
  reference::Trajectory motion;
  for (int k = 0; k <= 100; ++k) {
    const double t = 0.01 * k;
    solver::State y{solver::Vectors::Zero(1, 3), solver::Vectors::Zero(1, 3)};
    y.x(0, 0) = t * t, y.v(0, 0) = 2 * t;
    motion.times.push_back(t);
    motion.states.push_back(y);
  }
  return motion;
}

TEST(Delay, IsThatOfAMotionThatIsLate) {
  const reference::Trajectory motion = accelerating();
  for (const double tau : {0.05, -0.05}) {
    std::vector<double> times{0.3, 0.6, 0.9};
    std::vector<solver::State> late;
    for (const double t : times) late.push_back(bench::state_at(motion, t - tau));
    EXPECT_NEAR(bench::delay(times, late, motion).seconds, tau, 1e-9);
    EXPECT_NEAR(bench::delay(times, late, motion).left, 0, 1e-8);
  }
}

TEST(Delay, IsNotANumberWhereNothingMoves) {
  reference::Trajectory motion = accelerating();
  for (solver::State& y : motion.states) y.x.setZero(), y.v.setZero();
  EXPECT_TRUE(std::isnan(bench::delay(std::vector{0.5, 1.0}, std::vector{motion.states[1], motion.states[2]}, motion).seconds));
}

}  // namespace
}  // namespace drape::verify::field_test
