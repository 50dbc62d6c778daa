// The three shapes of a list of runs say the same, and each can be read by whom it is for.

#include <gmock/gmock.h>

#include <algorithm>
#include <clocale>
#include <cstdlib>
#include <cwchar>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "results/analysis/runs_table.hpp"
#include "results/screen.hpp"
#include "solver/base/printable.hpp"

namespace drape::verify::results_table_test {
namespace {

using namespace results;
using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

RunRecord good_run() {
  RunRecord run;
  run.scene = "flag";
  run.method = "bdf2/cholesky";
  run.step = 0.01;
  run.outcome = solver::Outcome::success;
  run.steps.resize(2);
  run.work = {{"updates", "", 3}, {"cg_iterations", "", 42}};  // those of rejected steps included
  run.times_ms = {4, 1, 2, 3};
  run.numerical_stiffness = 1.0 / 3.0;
  run.stiffness_to_damping = std::numeric_limits<double>::infinity();
  run.last_good_time = 0.02;
  run.error = ErrorRecord{.rms = 1.23456789e-5,
                          .maximum = 2.5e-5,
                          .reference = "cvode-bdf",
                          .reference_tolerance = 1e-11,
                          .reference_error = 3e-10,
                          .growth = 0.5,
                          .energy = 1e-3,
                          .energy_spread = 1e-9,
                          .centre = 2e-6,
                          .centre_spread = 1e-9};
  run.motion_error = MotionErrorRecord{.position = 5e-5,
                                       .amplitude = 0.25,
                                       .relative = 2e-4,
                                       .velocity = 3e-3,
                                       .reference_velocity = 1e-8,
                                       .energy = 4e-3,
                                       .momentum = 6e-6,
                                       .angular_momentum = 7e-6};
  return run;
}

RunRecord failed_run() {
  RunRecord run = good_run();
  run.scene = "Fähnchen";
  run.outcome = solver::Outcome::not_converged;
  run.message = "said \"no\", twice\nand again";
  run.overrides = "material.damping=0.5";
  run.times_ms.clear();
  run.error.reset();
  run.motion_error.reset();
  return run;
}

const std::vector<RunRecord> runs{good_run(), failed_run()};

TEST(Csv, HasTheColumnsThatScriptsRelyOn) {
  EXPECT_EQ(
      to_csv(to_table(std::vector<RunRecord>{})),
      "scene,method,step,outcome,message,steps,starting_steps,updates,cg_iterations,wall_ms_min,wall_ms_median,wall_ms_max,"
      "error_rms,"
      "error_run,error_relative,reference,reference_error,error_max,growth,energy_error,centre_error,amplitude,"
      "velocity_error_run,energy_error_run,momentum_error_run,angular_momentum_error_run,clearance,energy_rise,contact_area,"
      "numerical_stiffness,stiffness_to_damping,last_good_time,accuracy,reason,set\n");
}

TEST(Csv, GivesTotalsQuantilesAndAllDigits) {
  EXPECT_THAT(
      to_csv(to_table(std::vector{good_run()})),
      HasSubstr("\nflag,bdf2/"
                "cholesky,0.01,success,,2,0,3,42,1,2.5,4,1.23456789e-05,5e-05,0.0002,cvode-bdf,3e-10,2.5e-05,0.5,0.001,2e-06,"
                "0.25,0.003,0.004,6e-06,7e-06,,,,"
                "0.3333333333333333,inf,0.02,,,\n"));
}

TEST(Csv, QuotesTextAndLeavesCellsWithoutValueEmpty) {
  EXPECT_THAT(
      to_csv(to_table(std::vector{failed_run()})),
      HasSubstr(
          "\nFähnchen,bdf2/cholesky,0.01,not converged,\"said \"\"no\"\", twice\\nand again\",2,0,3,42,,,,,,,,,,,,,,,,,,,,,"
          "0.3333333333333333,inf,0.02,,,material.damping=0.5\n"));
}

TEST(Csv, NumbersReadBackAsTheSameNumbers) {
  RunRecord run = good_run();
  for (const double number : {std::numbers::pi, 5e-324, 1.7976931348623157e308, 0.1 + 0.2}) {
    run.step = number;
    const std::string csv = to_csv(to_table(std::vector{run}));
    const std::string cell = csv.substr(csv.find("cholesky,") + 9);
    EXPECT_EQ(std::strtod(cell.c_str(), nullptr), number);
  }
}

TEST(Json, HasTheColumnsOfCsvAsKeysInTheirOrder) {
  const auto list = nlohmann::ordered_json::parse(to_json(to_table(runs)));
  ASSERT_THAT(list, SizeIs(2));
  std::string header;
  for (const auto& item : list[0].items()) header += (header.empty() ? "" : ",") + item.key();
  EXPECT_EQ(header + "\n", to_csv(to_table(std::vector<RunRecord>{})));
}

TEST(Json, KeepsValuesAndGivesNullWhereThereIsNone) {
  const auto list = nlohmann::json::parse(to_json(to_table(runs)));
  EXPECT_EQ(list[0]["error_rms"], 1.23456789e-5);
  EXPECT_EQ(list[0]["cg_iterations"], 42);
  EXPECT_EQ(list[0]["stiffness_to_damping"], nullptr) << "JSON knows no infinity";
  EXPECT_EQ(list[1]["scene"], "Fähnchen");
  EXPECT_EQ(list[1]["message"], failed_run().message);
  EXPECT_EQ(list[1]["error_rms"], nullptr);
  EXPECT_EQ(list[1]["wall_ms_median"], nullptr);
}

TEST(Json, ReplacesBytesThatAreNotUtf8) {
  RunRecord run = good_run();
  run.message = "\xff!";
  EXPECT_EQ(nlohmann::json::parse(to_json(to_table(std::vector{run})))[0]["message"], "\uFFFD!");
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// As the C library counts characters, which is not how the table does.
std::size_t characters(const std::string& line) {
  std::mbstate_t state{};
  const char* text = line.c_str();
  return std::mbsrtowcs(nullptr, &text, 0, &state);
}

TEST(Table, AllLinesAreEquallyWide) {
  ASSERT_NE(std::setlocale(LC_CTYPE, "C.UTF-8"), nullptr);
  std::vector<std::size_t> widths;
  for (const std::string& line : lines_of(to_text(to_table(runs)))) widths.push_back(characters(line));
  std::setlocale(LC_CTYPE, "C");
  ASSERT_THAT(widths, SizeIs(5));
  EXPECT_THAT(widths, Each(widths.front()));
}

TEST(Table, NumbersAlignAtTheRightAndTextAtTheLeft) {
  RunRecord longer = good_run();
  longer.method = "euler";
  longer.steps.resize(1234);
  const auto lines = lines_of(to_text(to_table(std::vector{good_run(), longer})));
  const auto column = [&](std::size_t line, const std::string& text) { return lines[line].find(text); };
  EXPECT_EQ(column(0, "method"), column(3, "bdf2"));
  EXPECT_EQ(column(0, "method"), column(4, "euler"));
  EXPECT_EQ(column(0, "steps") + 5, column(3, " 2 ") + 2);
  EXPECT_EQ(column(0, "steps") + 5, column(4, "1234") + 4);
}

TEST(Table, ShowsFourDigitsAndUnits) {
  const auto lines = lines_of(to_text(to_table(runs)));
  EXPECT_THAT(lines[1], AllOf(HasSubstr("[s]"), HasSubstr("[ms]"), Not(HasSubstr("[1]"))));
  EXPECT_THAT(lines[3], AllOf(StartsWith("flag "), HasSubstr(" 1.235e-05 "), HasSubstr(" 0.3333 ")));
}

TEST(Table, HasTheUnitsOfItsColumns) {
  const auto table = to_table(runs);
  std::string units;
  for (const Column& column : table.columns)
    if (!column.unit.empty() && column.unit != "1") units += column.name + " [" + column.unit + "] ";
  EXPECT_EQ(units, "step [s] wall_ms_min [ms] wall_ms_median [ms] wall_ms_max [ms] clearance [m] last_good_time [s] ");
}

TEST(Table, FailedRunShowsHowAndWhenInPlaceOfItsError) {
  const auto lines = lines_of(to_text(to_table(runs)));
  EXPECT_THAT(lines[4], AllOf(HasSubstr("not converged at 0.02 s"), Not(HasSubstr("e-05"))));
  RunRecord with_error = failed_run();
  with_error.error = good_run().error;
  EXPECT_THAT(to_text(to_table(std::vector{with_error})), Not(HasSubstr("1.235e-05")));
}

TEST(Table, ShowsNoErrorThatItsReferenceCannotResolve) {
  RunRecord run = good_run();
  run.error->reference_error = run.error->rms / 11;
  EXPECT_THAT(to_text(to_table(std::vector{run})), HasSubstr(" 1.235e-05 "));
  run.error->reference_error = run.error->rms / 9;
  EXPECT_THAT(to_text(to_table(std::vector{run})), AllOf(HasSubstr(" < 1e-05 "), Not(HasSubstr("1.235e-05"))));
  EXPECT_THAT(to_csv(to_table(std::vector{run})), HasSubstr(",1.23456789e-05,"));
}

TEST(Table, ShowsTheErrorOverTheRunAndOfItsMotionAsFarAsTheReferenceResolvesThem) {
  RunRecord run = good_run();
  EXPECT_THAT(to_text(to_table(std::vector{run})), AllOf(HasSubstr(" 5e-05 "), HasSubstr(" 0.0002 ")));
  run.error->reference_error = 6e-6;
  EXPECT_THAT(to_text(to_table(std::vector{run})), AllOf(HasSubstr(" < 6e-05 "), HasSubstr(" < 0.0002 ")));
  run.motion_error->position = run.motion_error->relative = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(to_text(to_table(std::vector{run})), HasSubstr(" nan "));
  run.error->growth = 101;
  EXPECT_THAT(to_text(to_table(std::vector{run})), Not(HasSubstr(" nan ")));
}

TEST(Table, ShowsStatisticsInPlaceOfPositionsThatAreNotComparable) {
  RunRecord run = good_run();
  EXPECT_THAT(to_text(to_table(std::vector{run})), Not(HasSubstr("energy error")));
  run.error->growth = 101;
  EXPECT_THAT(to_text(to_table(std::vector{run})), AllOf(HasSubstr(" growth 1e+02 "), HasSubstr(" 0.001 ± 1e-09 "),
                                                         HasSubstr(" 2e-06 ± 1e-09 "), Not(HasSubstr("e-05"))));
  EXPECT_THAT(to_csv(to_table(std::vector{run})), HasSubstr(",1.23456789e-05,"));
}

TEST(Table, LeavesOutColumnsThatNoRunHasAValueFor) {
  EXPECT_THAT(to_text(to_table(runs)), AllOf(HasSubstr(" set "), HasSubstr("reference")));
  EXPECT_THAT(to_text(to_table(std::vector{good_run()})), Not(HasSubstr(" set")));
  EXPECT_THAT(to_text(to_table(std::vector{failed_run()})), Not(HasSubstr("reference")));
}

TEST(WorkCount, IsZeroForAKindTheRunDoesNotKnow) {
  RunRecord run;
  run.work = {{"cg_iterations", "iterations of CG", 41}, {"matvec", "products of matrix and vector", 7}};
  EXPECT_EQ(work_count(run, "matvec"), 7);
  EXPECT_EQ(work_count(run, "force/bending"), 0);
}

// --- On a screen
// ---------------------------------------------------------------------------------------------------------------

/// A table with columns of most roles: two keys, and two numbers of every role.
Table roles_table() {
  Table table{"roles", "columns of all roles", {}};
  const auto add = [&](const char* title, const char* unit, Role role, Datum cell) {
    table.columns.push_back({title, title, unit, "", role, {cell, cell}, {}});
  };
  add("who", "", Role::key, "hung-corners");
  add("how", "", Role::key, "midpoint/fixed-point/cholesky");
  add("work", "1", Role::counter, 1234.0);
  add("more work", "1", Role::counter, 5678.0);
  add("time", "ms", Role::time, 1.5);
  add("most time", "ms", Role::time, 2.5);
  add("error", "1", Role::error, 1e-5);
  add("over the run", "1", Role::error, 2e-5);
  add("of the reference", "1", Role::uncertainty, 1e-9);
  add("remark", "", Role::note, "words and more words that say little");
  return table;
}

TEST(Screen, ThatIsWideEnoughShowsTheTableAsItIs) {
  const std::string all = to_text(roles_table());
  EXPECT_EQ(to_text(roles_table(), {.columns = lines_of(all).front().size()}), all);
  EXPECT_THAT(all, Not(HasSubstr("not shown")));
}

TEST(Screen, HoldsEveryLine) {
  for (const Table& table : {roles_table(), to_table(runs)})
    for (const std::size_t columns : {40, 60, 80, 100, 120})
      for (const std::string& line : lines_of(to_text(table, {.columns = columns})))
        EXPECT_LE(base::characters(line), columns) << line;
}

TEST(Screen, LeavesOutNotesAndUncertaintiesFirstAndKeysNever) {
  const auto left_out = [](std::size_t columns) {
    const auto all = lines_of(to_text(roles_table(), {.columns = columns}));
    EXPECT_THAT(all.front(), AllOf(HasSubstr("who"), HasSubstr("how")));
    std::string text;  // it may be broken
    for (auto line = std::ranges::find_if(all, [](const auto& any) { return any.starts_with("not shown"); }); line != all.end();
         ++line)
      text += *line + ' ';
    return text;
  };
  EXPECT_EQ(left_out(107), "not shown: more work; --wide shows all ");
  EXPECT_EQ(left_out(90), "not shown: more work, most time, over the run, remark; --wide shows all ");
  EXPECT_EQ(left_out(40),
            "not shown: work, more work, time, most time, error, over the run, of the reference, remark; --wide shows all ");
}

TEST(Screen, BreaksTextsAtSpacesAndNames) {
  Table table{"texts", "", {}};
  table.columns.push_back(
      {"a", "a long title", "", "", Role::key, {"one two three four five six", "midpoint/fixed-point/cholesky"}, {}});
  EXPECT_EQ(to_text(table, {.columns = 16}),
            "a long title    \n"
            "----------------\n"
            "one two three   \n"
            "four five six   \n"
            "midpoint/fixed- \n"
            "point/cholesky  \n");
}

TEST(Screen, WithColoursMarksWhatIsGoodAndWhatIsNot) {
  const std::string green = "\033[32m", red = "\033[31m";
  const auto lines = lines_of(to_text(to_table(runs), {.colours = true}));
  EXPECT_THAT(lines[0], StartsWith("\033[1m"));
  EXPECT_THAT(lines[3], Not(HasSubstr(red)));
  EXPECT_THAT(lines[4], HasSubstr(red + "not converged at 0.02 s"));
  Table verdicts{"verdicts", "", {}};
  verdicts.columns.push_back(
      {"v", "v", "", "", Role::verdict, {check(true, "fine", ""), check(false, "", "not"), Verdict{}}, {}});
  const auto marked = lines_of(to_text(verdicts, {.colours = true}));
  EXPECT_THAT(marked[2], StartsWith(green + "met: fine"));
  EXPECT_THAT(marked[3], StartsWith(red + "missed: not"));
  EXPECT_THAT(marked[4], Not(HasSubstr("\033")));
  EXPECT_THAT(to_text(to_table(runs)), Not(HasSubstr("\033")));
}

}  // namespace
}  // namespace drape::verify::results_table_test
