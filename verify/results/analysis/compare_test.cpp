// Comparisons of two recordings: what must be called a regression is, what is the same is not.

#include "results/analysis/compare.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "solver/base/statistics.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/tables.hpp"

namespace drape::verify::compare_test {
namespace {

using namespace results;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

// --- Rank tests ----------------------------------------------------------------------------------------------------------

TEST(RankTest, IsExactForSmallSamples) {
  const std::vector<double> a{1, 2, 3}, b{4, 5, 6}, c{2.5, 3.5};
  EXPECT_DOUBLE_EQ(base::rank_test(a, b).slower, 1.0 / 20);
  EXPECT_DOUBLE_EQ(base::rank_test(a, b).faster, 1);
  EXPECT_DOUBLE_EQ(base::rank_test(b, a).faster, 1.0 / 20);
  EXPECT_DOUBLE_EQ(base::rank_test(a, c).slower, 2.0 / 10);  // U = 5 of 6: orders with U = 6 or 5
  EXPECT_DOUBLE_EQ(base::rank_test(a, b).superiority, 1);
  EXPECT_DOUBLE_EQ(base::rank_test(a, a).superiority, 0.5);
  EXPECT_DOUBLE_EQ(base::rank_test(a, std::vector<double>{2, 4, 6}).ratio, 2);
}

/// All orders of 4 + 3 times, counted one by one.
TEST(RankTest, AgreesWithCountingOrders) {
  const std::vector<double> a{1, 3, 4, 6}, b{2, 5, 7};  // U = 1 + 3 + 4
  int all = 0, as_large = 0;
  for (unsigned chosen = 0; chosen < 128; ++chosen) {
    if (std::popcount(chosen) != 3) continue;
    int u = 0;
    for (int i = 0; i < 7; ++i)
      for (int j = 0; j < i; ++j) u += (chosen >> i & 1) && !(chosen >> j & 1);
    ++all;
    as_large += u >= 8;
  }
  EXPECT_DOUBLE_EQ(base::rank_test(a, b).slower, double(as_large) / all);
}

TEST(RankTest, OfLargeSamplesContinuesThatOfSmallOnes) {
  std::vector<double> a, b;
  for (int k = 0; k < 30; ++k) a.push_back(k), b.push_back(k + 5.5);
  const double exact = base::rank_test(a, b).slower;
  a.push_back(14.2), b.push_back(14.3);
  EXPECT_NEAR(base::rank_test(a, b).slower / exact, 1, 0.35);
}

TEST(Holm, CorrectsStepByStep) {
  EXPECT_THAT(base::holm(std::vector{0.004, 0.3, 0.0024, 0.02}, 0.01), ElementsAre(false, false, true, false));
  EXPECT_THAT(base::holm(std::vector{0.003, 0.3, 0.0024, 0.02}, 0.01), ElementsAre(true, false, true, false));
  EXPECT_THAT(base::holm(std::vector{0.003, 0.3, 0.0026, 0.02}, 0.01), ElementsAre(false, false, false, false));
}

// --- Recordings ----------------------------------------------------------------------------------------------------------

RunRecord run(const std::string& method) {
  RunRecord run;
  run.scene = "flag";
  run.scene_keys = {{"grid.n", "[20, 20]", ""}, {"material.damping", "[50, 50]", "N s/m"}};
  run.method = method;
  run.step = 0.01;
  run.until = 1;
  run.outcome = solver::Outcome::success;
  run.last_good_time = 1;
  run.parameters = {{"loop_tolerance", 1e-5, "1", ""}};
  run.work = {{"updates", "", 100}, {"force/tension", "", 300}};
  run.error = ErrorRecord{.rms = 1e-3, .maximum = 2e-3, .reference = "two", .reference_error = 1e-5, .energy = 1e-2};
  return run;
}

constexpr int cells = 8;

Recording recording() {
  Recording recording{{{"cpu", "fast", ""}, {"cores", "2", ""}, {"compile_flags", "-O3", ""}}, {}, {}};
  for (int k = 0; k < cells; ++k) recording.runs.push_back(run("method" + std::to_string(k)));
  return recording;
}

/// Times as they scatter: with a long tail.
class Clock {
 public:
  explicit Clock(unsigned seed) : random_(seed) {}
  void time(Recording& recording, int repetitions, double spread, double factor = 1) {
    for (std::size_t k = 0; k < recording.runs.size(); ++k) {
      std::lognormal_distribution<double> times(std::log(factor * (1 + static_cast<double>(k))), spread);
      recording.runs[k].times_ms.clear();
      for (int r = 0; r < repetitions; ++r) recording.runs[k].times_ms.push_back(times(random_));
    }
  }

 private:
  std::mt19937 random_;
};

Recording timed(unsigned seed, double spread = 0.05, int repetitions = 10) {
  Recording recorded = recording();
  Clock(seed).time(recorded, repetitions, spread);
  return recorded;
}

std::vector<std::string> texts_in(const Aspect& aspect, const std::string& name) {
  std::vector<std::string> texts;
  for (const Column& c : aspect.worst.columns)
    if (c.name == name)
      for (const Datum& cell : c.cells) texts.push_back(std::get<std::string>(cell));
  return texts;
}

TEST(Compare, FindsNothingInARecordingAndItself) {
  const Recording a = timed(1);
  const Comparison comparison = compare(a, a);
  for (const Aspect* aspect : {&comparison.accuracy, &comparison.work, &comparison.time}) {
    EXPECT_EQ(aspect->change, Change::same) << aspect->reason;
    EXPECT_EQ(rows(aspect->worst), 0u);
  }
  EXPECT_EQ(exit_code(comparison), 0);
}

TEST(Compare, FindsACounterThatDiffersByOne) {
  const Recording a = timed(1);
  Recording b = a;
  ++b.runs[3].work[1].count;
  const Comparison more = compare(a, b);
  EXPECT_EQ(more.work.change, Change::regression);
  EXPECT_THAT(texts_in(more.work, "cell"), ElementsAre(HasSubstr("method3")));
  EXPECT_THAT(texts_in(more.work, "quantity"), ElementsAre("force/tension"));
  EXPECT_THAT(texts_in(more.work, "b"), ElementsAre("301"));
  EXPECT_EQ(more.accuracy.change, Change::same);
  EXPECT_EQ(exit_code(more), 1);
  const Comparison less = compare(b, a);
  EXPECT_EQ(less.work.change, Change::better);
  EXPECT_EQ(exit_code(less), 0);
}

TEST(Compare, FindsAnErrorThatGrewBeyondItsUncertaintyAndNoOther) {
  const Recording a = timed(1);
  const auto with_error = [&](double rms) {
    Recording b = a;
    b.runs[2].error->rms = rms;
    return compare(a, b);
  };
  EXPECT_EQ(with_error(1.04e-3).accuracy.change, Change::regression);
  EXPECT_EQ(with_error(1.029e-3).accuracy.change, Change::same) << "1e-3 · 1.01 + 2 · 1e-5";
  EXPECT_EQ(with_error(0.9e-3).accuracy.change, Change::better);
  EXPECT_EQ(with_error(NAN).accuracy.change, Change::regression);
  EXPECT_EQ(exit_code(with_error(1.04e-3)), 1);
  EXPECT_THAT(texts_in(with_error(1.04e-3).accuracy, "b"), ElementsAre("0.00104 ± 1e-05"));
}

TEST(Compare, LooksAtEnergiesWherePositionsSayLittle) {
  Recording a = timed(1);
  a.runs[0].error->growth = 1000;
  Recording b = a;
  b.runs[0].error->rms *= 5;
  EXPECT_EQ(compare(a, b).accuracy.change, Change::same);
  b.runs[0].error->energy *= 5;
  EXPECT_EQ(compare(a, b).accuracy.change, Change::regression);
}

TEST(Compare, FindsRunsThatFailNow) {
  const Recording a = timed(1);
  Recording b = a;
  b.runs[5].outcome = solver::Outcome::not_converged;
  b.runs[5].error.reset();
  EXPECT_EQ(compare(a, b).accuracy.change, Change::regression);
  EXPECT_EQ(compare(b, a).accuracy.change, Change::better);
}

TEST(Compare, SaysWhatMakesCellsDifferent) {
  const Recording a = timed(1);
  Recording b = a;
  for (RunRecord& r : b.runs) r.parameters[0].value = 1e-6;
  const Comparison comparison = compare(a, b);
  EXPECT_EQ(comparison.accuracy.change, Change::not_comparable);
  EXPECT_THAT(texts_in(comparison.accuracy, "b")[0], HasSubstr("parameter loop_tolerance (1e-05 and 1e-06)"));
  EXPECT_EQ(exit_code(comparison), 2);
  b = a;
  b.runs[0].scene_keys[1].value = "[5, 5]";
  EXPECT_THAT(texts_in(compare(a, b).accuracy, "b"), ElementsAre("differs in scene: material.damping ([50, 50] and [5, 5])"));
  EXPECT_EQ(exit_code(compare(a, b)), 2);
  EXPECT_EQ(exit_code(compare(Recording(), Recording())), 2);
}

TEST(Compare, DoesNotMindNewCells) {
  const Recording b = timed(1);
  Recording a = b;
  a.runs.pop_back();
  EXPECT_EQ(exit_code(compare(a, b)), 0);
}

// --- Times ---------------------------------------------------------------------------------------------------------------

/// How often times of the same program are called slower. The spread is so large that only the tests hold them back.
int false_alarms(int trials, const CompareOptions& options) {
  int alarms = 0;
  Clock clock(7);
  Recording a = recording(), b = a;
  for (int trial = 0; trial < trials; ++trial) {
    clock.time(a, 10, 0.5);
    clock.time(b, 10, 0.5, options.quiet ? 1 : 1.7);
    alarms += compare(a, b, options).time.change == Change::regression;
  }
  return alarms;
}

TEST(CompareTimes, FalselyAlarmsOnceInAHundredComparisonsAtMostButNotMuchLess) {
  DRAPE_SLOW();
  constexpr int trials = 1000;  // of 1 %: 10 ± 3
  EXPECT_THAT(false_alarms(trials, {.quiet = true}), AllOf(testing::Ge(2), testing::Le(19)));
  EXPECT_THAT(false_alarms(trials, {}), AllOf(testing::Ge(2), testing::Le(19)));
}

TEST(CompareTimes, FindsOneCellThatIsAFifthSlowerWhateverTheMachine) {
  int found = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Recording a = timed(2 * seed);
    Recording b = recording();
    Clock(2 * seed + 1).time(b, 10, 0.05, 1.8);
    for (double& time : b.runs[4].times_ms) time *= 1.2;
    const Aspect time = compare(a, b).time;
    found += time.change == Change::regression && texts_in(time, "cell")[0].find("method4") != std::string::npos;
  }
  EXPECT_GE(found, 19);
}

TEST(CompareTimes, FindsThatAllAreAFifthSlowerOnAQuietMachine) {
  const Recording a = timed(1, 0.05, 3);  // too few for single cells
  Recording b = recording();
  Clock(2).time(b, 3, 0.05, 1.2);
  EXPECT_EQ(compare(a, b, {.quiet = true}).time.change, Change::regression);
  EXPECT_THAT(texts_in(compare(a, b, {.quiet = true}).time, "cell"), ElementsAre("all together"));
  EXPECT_EQ(compare(b, a, {.quiet = true}).time.change, Change::better);
}

TEST(CompareTimes, TellWhatAllShareWithoutJudgingIt) {
  Recording b = recording();
  Clock(2).time(b, 10, 0.05, 1.2);
  const Aspect time = compare(timed(1), b).time;
  EXPECT_EQ(time.change, Change::same);
  EXPECT_THAT(time.reason, HasSubstr("all share the ratio 1.2"));
}

TEST(CompareTimes, SayWhyTheyCannotBeCompared) {
  const Recording a = timed(1);
  Recording b = a;
  b.provenance[0].value = "slow";
  EXPECT_EQ(compare(a, b).time.change, Change::not_comparable);
  EXPECT_EQ(compare(a, b).time.reason, "cpu differ: fast and slow");
  EXPECT_EQ(exit_code(compare(a, b)), 2);
  EXPECT_EQ(exit_code(compare(a, b, {.times = false})), 0);
  EXPECT_THAT(compare(timed(1, 0.05, 3), timed(2, 0.05, 3)).time.reason, HasSubstr("too few repetitions"));
  b = a;
  b.runs.resize(4);
  EXPECT_THAT(compare(b, a).time.reason, HasSubstr("4 cells with times: fewer than 5"));
}

// --- Tables --------------------------------------------------------------------------------------------------------------

Table orders(double order, const Datum& verdict, double rms, std::int64_t updates, double wall) {
  return {"orders",
          "",
          {column("method", "", Role::key, {"bdf2"}), column("fitted_order", "1", Role::order, {order}),
           column("rms", "m", Role::error, {rms}), column("updates", "1", Role::counter, {updates}),
           column("wall", "s", Role::time, {wall}), column("verdict", "", Role::verdict, {verdict})}};
}

TEST(CompareTables, JudgeOrdersErrorsAndCountersButNoTimes) {
  const Verdict met{Standing::met, "2 as declared"}, missed{Standing::missed, "not 2"};
  const Table good = orders(2.01, met, 1e-4, 10, 1);
  const auto against = [&](const Table& b) { return compare({{}, {}, {good}}, {{}, {}, {b}}); };
  EXPECT_EQ(exit_code(against(orders(2.02, met, 1e-4, 10, 5))), 0);
  EXPECT_EQ(against(orders(1.9, met, 1e-4, 10, 1)).accuracy.change, Change::regression);
  EXPECT_EQ(against(orders(2.01, missed, 1e-4, 10, 1)).accuracy.change, Change::regression);
  EXPECT_EQ(against(orders(2.01, met, 1.1e-4, 10, 1)).accuracy.change, Change::regression);
  EXPECT_EQ(against(orders(2.01, met, 0.9e-4, 10, 1)).accuracy.change, Change::better);
  EXPECT_EQ(against(orders(2.01, met, 1e-4, 11, 1)).work.change, Change::regression);
  EXPECT_THAT(against(good).work.reason, HasSubstr("1 cells"));
  EXPECT_EQ(compare({{}, {}, {good}}, {{}, {}, {}}).accuracy.change, Change::not_comparable);
}

/// A row with an outcome.
Table ending(const std::string& outcome, std::vector<std::string> classes = {}) {
  Table table{"endings", "", {column("outcome", "", Role::outcome, {outcome})}};
  table.columns[0].classes = std::move(classes);
  return table;
}

TEST(CompareTables, JudgeOutcomesByWhetherTheyAreGood) {
  const auto judged = [](const Table& a, const Table& b) { return compare({{}, {}, {a}}, {{}, {}, {b}}); };
  const Table good = ending("success"), bad = ending("not converged"), other = ending("unstable");
  EXPECT_EQ(judged(bad, good).accuracy.change, Change::better);
  EXPECT_EQ(judged(good, bad).accuracy.change, Change::regression);
  EXPECT_EQ(judged(bad, other).accuracy.change, Change::changed);
  EXPECT_EQ(exit_code(judged(bad, other)), 0);
  EXPECT_THAT(judged(bad, other).accuracy.reason, HasSubstr("0 worse, 0 better, 1 changed"));
  EXPECT_THAT(texts_in(judged(bad, other).accuracy, "b"), ElementsAre("unstable"));
  const std::vector<std::string> classes{"accurate", "stable but wrong", "unstable"};
  const auto between = [&](const char* a, const char* b) {
    return judged(ending(a, classes), ending(b, classes)).accuracy.change;
  };
  EXPECT_EQ(between("unstable", "accurate"), Change::better);
  EXPECT_EQ(between("accurate", "stable but wrong"), Change::regression);
  EXPECT_EQ(between("stable but wrong", "unstable"), Change::changed);
}

TEST(CompareTables, JudgeVerdictsByTheirStandings) {
  const Datum met = Verdict{Standing::met, "below"}, open = Verdict{Standing::open, "no contact"}, classified = "no contact";
  const auto change = [](const Datum& a, const Datum& b) {
    return compare({{}, {}, {orders(2, a, 1e-4, 10, 1)}}, {{}, {}, {orders(2, b, 1e-4, 10, 1)}}).accuracy.change;
  };
  EXPECT_EQ(change(open, met), Change::better);
  EXPECT_EQ(change(met, open), Change::regression);
  EXPECT_EQ(change(classified, open), Change::same) << "a text without a standing is open";
}

/// A row with one number, and what the reference of its error is uncertain by.
Table one_number(Role role, double value, double uncertainty) {
  return {"numbers", "", {column("number", "1", role, {value}), column("uncertainty", "1", Role::uncertainty, {uncertainty})}};
}

TEST(CompareTables, JudgeNoNoise) {
  const auto change = [](Role role, double a, double b, double uncertainty) {
    return compare({{}, {}, {one_number(role, a, uncertainty)}}, {{}, {}, {one_number(role, b, 2 * uncertainty)}})
        .accuracy.change;
  };
  EXPECT_EQ(change(Role::error, 1e-8, 2e-8, 1e-9), Change::regression);
  EXPECT_EQ(change(Role::error, 1e-8, 2e-8, 1e-8), Change::same);
  EXPECT_EQ(change(Role::quantity, 1e-8, 2e-8, 0), Change::regression);
  EXPECT_EQ(change(Role::quantity, 0, 1e-13, 0), Change::same) << "round-off";
  for (const Role untold : {Role::note, Role::time}) EXPECT_EQ(change(untold, 1e-8, 2e-8, 0), Change::same);
}

/// Errors with ever smaller steps.
Table curve(std::vector<Datum> steps, std::vector<Datum> errors) {
  const std::vector<Datum> uncertainties(steps.size(), 1e-9);
  return {"curve",
          "",
          {column("step", "s", Role::key, std::move(steps)), column("error", "1", Role::error, std::move(errors)),
           column("uncertainty", "1", Role::uncertainty, uncertainties)}};
}

TEST(CompareTables, MatchRowsByTheirKeys) {
  const auto judged = [](const Table& a, const Table& b) { return compare({{}, {}, {a}}, {{}, {}, {b}}).accuracy; };
  const Table whole = curve({0.1, 0.05, 0.025}, {1e-3, 1e-4, 5e-9});
  EXPECT_EQ(judged(whole, curve({0.025, 0.05, 0.1}, {5e-9, 1e-4, 1e-3})).change, Change::same) << "in another order";
  EXPECT_EQ(judged(whole, curve({0.1, 0.05}, {1e-3, 1e-4})).change, Change::same) << "the error is not resolved";
  EXPECT_EQ(judged(whole, curve({0.1, 0.025}, {1e-3, 5e-9})).change, Change::not_comparable);
  EXPECT_EQ(judged(curve({0.1}, {1e-3}), curve({0.1, 0.05}, {1e-3, 1e-4})).change, Change::not_comparable);
  EXPECT_EQ(judged(whole, curve({0.1, 0.05}, {1e-3, 2e-4})).change, Change::regression);
}

TEST(CompareTables, MayLackRowsOnlyWhereTimesDecideWhichThereAre) {
  Table both{"times", "", {column("method", "", Role::key, {"a", "b"}), column("time", "ms", Role::time, {1.0, 2.0})}};
  Table one{"times", "", {column("method", "", Role::key, {"a"}), column("time", "ms", Role::time, {1.0})}};
  const auto change = [&] { return compare({{}, {}, {both}}, {{}, {}, {one}}).accuracy.change; };
  EXPECT_EQ(change(), Change::not_comparable);
  both.timed_rows = one.timed_rows = true;
  EXPECT_EQ(change(), Change::same);
}

}  // namespace
}  // namespace drape::verify::compare_test
