// The studies: their quick forms answer their questions as theory wants it, and what they find is recorded.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "model/scene_file/scene_file.hpp"
#include "reference/theory/amplification.hpp"
#include "results/analysis/order_fit.hpp"
#include "results/file/run_file.hpp"
#include "solver/methods.hpp"
#include "verify/support/bench_integrators.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::studies_test {
namespace {

using results::Column;
using results::Datum;
using results::fit_order;
using results::order_verdict;
using results::Role;
using results::Table;
using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::Field;
using testing::Gt;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsNan;
using testing::Lt;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

// --- The window of an order --------------------------------------------------------------------------------------------------

/// h = 1, ½, ¼, … and errors given.
struct Series {
  std::vector<double> h, errors;

  explicit Series(std::vector<double> e) : errors(std::move(e)) {
    for (std::size_t k = 0; k < errors.size(); ++k) h.push_back(std::exp2(-double(k)));
  }
  auto fit(double uncertainty = 0) const { return fit_order(h, errors, uncertainty); }
};

TEST(OrderFit, FindsTheWindowBetweenThePreasymptoticAndTheRoundOffEnd) {
  const auto fit = Series({0.3, 0.25, 4e-2, 1e-2, 2.5e-3, 6.25e-4, 5e-4, 6e-4}).fit();
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->first, 2);
  EXPECT_EQ(fit->last, 5);
  EXPECT_NEAR(fit->order, 2, 1e-12);
  EXPECT_NEAR(fit->lowest, 2, 1e-12);
  EXPECT_NEAR(fit->highest, 2, 1e-12);
}

TEST(OrderFit, LeavesOutErrorsThatTheReferenceCannotResolve) {
  const Series series({64, 16, 4, 1, 0.25});
  EXPECT_EQ(series.fit(0.02)->last, 4);
  EXPECT_EQ(series.fit(0.03)->last, 3);
  EXPECT_FALSE(series.fit(0.11)) << "three errors are two refinements";
}

TEST(OrderFit, NeedsThreeRefinementsOfASteadyOrder) {
  EXPECT_FALSE(Series({64, 16, 4}).fit());
  EXPECT_TRUE(Series({64, 16, 4, 1}).fit());
  EXPECT_FALSE(Series({64, 16, 4, 4 / std::exp2(2.11)}).fit());
  EXPECT_TRUE(Series({64, 16, 4, 4 / std::exp2(2.09)}).fit());
  EXPECT_FALSE(Series({64, 16, std::nan(""), 1}).fit());
  EXPECT_FALSE(Series({64, 16, 4, 0}).fit());
}

TEST(OrderFit, TakesTheFinestOfEquallyLongWindows) {
  const auto fit = Series({4096, 2048, 1024, 512, 64, 8, 1}).fit();
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->order, 3, 1e-12);
}

TEST(OrderFit, KnowsUnequalRefinements) {
  EXPECT_NEAR(fit_order(std::vector{1.0, 0.7, 0.2, 0.1}, std::vector{1.0, 0.49, 0.04, 0.01}, 0)->order, 2, 1e-12);
}

TEST(Verdict, IsWithinATenthToBothSides) {
  const auto of = [](double order) { return to_string(order_verdict(results::OrderFit{order, order, order, 0, 3}, 2)); };
  EXPECT_EQ(of(2.09), "met: 2 as declared");
  EXPECT_EQ(of(1.91), "met: 2 as declared");
  EXPECT_EQ(of(2.11), "missed: not 2");
  EXPECT_EQ(of(1.89), "missed: not 2");
  EXPECT_EQ(order_verdict(std::nullopt, 2), (results::Verdict{results::Standing::open, "no order to be seen"}));
}

// --- Tables ------------------------------------------------------------------------------------------------------------------

/// A table with all kinds of cells, and gaps.
Table some_table() {
  constexpr std::int64_t three = 3, four = 4;
  return {
      "some",
      "Some table",
      {{"name", "name", "", "who", Role::key, {"Ähre", "b, c", {}}, {}},
       {"n", "n", "1", "how many", Role::counter, {three, four, {}}, {}},
       {"x", "x", "m", "where", Role::quantity, {{}, 0.1 + 0.2, {}}, {}},
       {"not shown", "", "1", "not shown", Role::note, {{}, {}, 7.0}, {}, {"seven", "eight"}, "some", results::Part::detail}},
      false,
      results::Figure::convergence,
      true};
}

TEST(StudyTable, IsShownWithoutItsHiddenColumns) {
  EXPECT_EQ(to_text(some_table()),
            "name  n    x\n"
            "         [m]\n"
            "------------\n"
            "Ähre  3     \n"
            "b, c  4  0.3\n"
            "            \n");
}

TEST(StudyTable, ForTheFileIsShownWithAllItsColumns) {
  Table table = some_table();
  table.for_file = true;
  EXPECT_THAT(to_text(table), testing::HasSubstr("name  n    x  not shown\n"));
}

TEST(StudyTable, IsDrawnFromColumnsThatItHas) {
  Table table = some_table();
  draw(table, results::Figure::stability, {{results::Part::x, "n"}});
  EXPECT_EQ(find_column(table, "n")->part, results::Part::x);
  EXPECT_EQ(table.figure, results::Figure::stability);
  EXPECT_THROW(draw(table, results::Figure::stability, {{results::Part::y, "m"}}), std::invalid_argument);
}

TEST(StudyTable, HasAllColumnsInCsv) {
  EXPECT_EQ(to_csv(some_table()),
            "name,n,x,not shown\n"
            "Ähre,3,,\n"
            "\"b, c\",4,0.30000000000000004,\n"
            ",,,7\n");
}

TEST(StudyTable, IsReadBackFromItsFile) {
  const base::TemporaryFolder folder;
  const auto path = folder.path() / "tables.h5";
  results::RunFile file(path, {});
  file.add(some_table());
  EXPECT_THAT(results::read_tables(path), SizeIs(1)) << "on disk at once";
  Table second = some_table();
  second.name = "other";
  file.add(second);
  const auto tables = results::read_tables(path);
  ASSERT_THAT(tables, SizeIs(2));
  EXPECT_EQ(tables[0].name, "other");
  const Table &read = tables[1], written = some_table();
  EXPECT_EQ(read.description, written.description);
  EXPECT_EQ(read.figure, written.figure);
  EXPECT_TRUE(read.timed_rows);
  EXPECT_FALSE(read.for_file);
  ASSERT_EQ(read.columns.size(), written.columns.size());
  for (std::size_t k = 0; k < read.columns.size(); ++k) {
    EXPECT_EQ(read.columns[k].name, written.columns[k].name);
    EXPECT_EQ(read.columns[k].title, written.columns[k].title);
    EXPECT_EQ(read.columns[k].unit, written.columns[k].unit);
    EXPECT_EQ(read.columns[k].description, written.columns[k].description);
    EXPECT_EQ(read.columns[k].role, written.columns[k].role);
    EXPECT_EQ(read.columns[k].classes, written.columns[k].classes);
    EXPECT_EQ(read.columns[k].group, written.columns[k].group);
    EXPECT_EQ(read.columns[k].part, written.columns[k].part);
  }
  EXPECT_EQ(to_text(read), to_text(written));
  EXPECT_EQ(to_csv(read), to_csv(written));
}

TEST(StudyTable, IsReadBackWithoutRows) {
  const base::TemporaryFolder folder;
  results::RunFile file(folder.path() / "tables.h5", {});
  Table table = some_table();
  for (Column& column : table.columns) column.cells.clear();
  file.add(table);
  const auto tables = results::read_tables(folder.path() / "tables.h5");
  ASSERT_THAT(tables, SizeIs(1));
  EXPECT_THAT(tables[0].columns, SizeIs(table.columns.size()));
  EXPECT_EQ(rows(tables[0]), 0);
}

TEST(StudyTable, IsRefusedTwice) {
  const base::TemporaryFolder folder;
  results::RunFile file(folder.path() / "tables.h5", {});
  file.add(some_table());
  EXPECT_THROW(file.add(some_table()), base::FileError);
  EXPECT_THAT(results::read_tables(folder.path() / "tables.h5"), SizeIs(1)) << "and does no harm";
}

// --- The studies of the program
// ------------------------------------------------------------------------------------------------

/// All verdicts of a table, without the empty ones.
std::vector<std::string> verdicts(const Table& table) {
  std::vector<std::string> found;
  const Column* column = find_column(table, "verdict");
  for (std::size_t row = 0; row < rows(table); ++row)
    if (const std::string text = text_in(column, row); !text.empty()) found.push_back(text);
  return found;
}

/// The verdicts in the rows of a method.
std::vector<std::string> verdicts_of(const Table& table, const std::string& method) {
  std::vector<std::string> found;
  for (std::size_t row = 0; row < rows(table); ++row)
    if (text_in(find_column(table, "method"), row) == method) found.push_back(text_in(find_column(table, "verdict"), row));
  return found;
}

/// The numbers of a column in the rows whose column `key` is this text; NaN where there is none.
std::vector<double> numbers(const Table& table, const std::string& column, const std::string& key, const std::string& text) {
  const auto cells = [&](const std::string& name) -> const std::vector<Datum>& {
    return std::ranges::find(table.columns, name, &Column::name)->cells;
  };
  std::vector<double> found;
  for (std::size_t row = 0; row < cells(key).size(); ++row) {
    if (cells(key)[row] != Datum(text)) continue;
    const Datum& cell = cells(column)[row];
    if (const auto* count = std::get_if<std::int64_t>(&cell))
      found.push_back(static_cast<double>(*count));
    else
      found.push_back(std::holds_alternative<double>(cell) ? std::get<double>(cell) : std::nan(""));
  }
  return found;
}

class ProgramStudies : public testing::Test {
 protected:
  const BenchIntegrators program;

  std::vector<Table> tables(const std::string& study) const {
    program.output({"study", study, "--quick", "--out", "study.h5"});
    return results::read_tables(program.folder() / "study.h5");
  }
};

TEST_F(ProgramStudies, ModesAreAsInTheory) {
  DRAPE_SLOW();
  const auto all = tables("modes");
  EXPECT_THAT(all, SizeIs(3));
  for (const Table& table : all) {
    EXPECT_THAT(verdicts(table), SizeIs(table.columns[0].cells.size())) << table.name << ": one for each row";
    EXPECT_THAT(verdicts(table), Each(Not(StartsWith("missed")))) << table.name;
    for (const solver::Method& method : solver::methods()) {
      const std::size_t unknown = std::ranges::count(verdicts_of(table, std::string(method.name)), "no theory known");
      EXPECT_EQ(unknown > 0, !reference::has_theory(method.name)) << method.name << " in " << table.name;
      EXPECT_FALSE(verdicts_of(table, std::string(method.name)).empty()) << method.name << " is left out of " << table.name;
    }
  }
}

TEST_F(ProgramStudies, OrdersAreAsDeclared) {
  DRAPE_SLOW();
  const auto all = tables("orders");
  ASSERT_THAT(all, SizeIs(1));
  const auto found = verdicts(all[0]);
  constexpr int known = 13;
  ASSERT_THAT(found, SizeIs(testing::Ge(known)));
  EXPECT_THAT(std::vector(found.begin(), found.begin() + known),
              ElementsAre("met: 1 as declared", "met: 1 as declared", "met: 2 as declared", "met: 2 as declared",
                          "met: 2 as declared", "met: 2 as declared", "met: 2 as declared", "met: 2 as declared",
                          "met: 3 as declared", testing::_, "met: 3 as declared", "met: 4 as declared", testing::_))
      << "the reference ends the fourth order early; BDF(5) is not stable for what swings";
  EXPECT_THAT(std::vector(found.begin() + known, found.end()),
              Each(AnyOf(HasSubstr("as declared"), "no order to be seen", "missed: not 3", "missed: not 4")))
      << "what was added; the reference ends the fourth order of rk4 early, epirk4s3a has 4.5 on the soft sheet";
  EXPECT_THAT(found, Contains(HasSubstr("as declared")).Times(testing::Ge(16)));
}

TEST_F(ProgramStudies, TheChoiceIsTheQuickestWithItsError) {
  DRAPE_SLOW();
  const auto all = tables("choice");  // in the order of their names
  ASSERT_THAT(all, SizeIs(3));
  const Table &choice = all[0], &trials = all[1];
  ASSERT_EQ(rows(choice), 6u);
  ASSERT_EQ(trials.name, "trials: hung-corners d=0.5 n=5");
  for (std::size_t row = 0; row < rows(choice); ++row) {
    const double error = number_in(find_column(choice, "error"), row), time = number_in(find_column(choice, "ms"), row);
    EXPECT_FALSE(number_in(find_column(choice, "ratio"), row) < 1) << row;
    EXPECT_LE(number_in(find_column(choice, "lower"), row), time) << row;
    EXPECT_GE(number_in(find_column(choice, "upper"), row), time) << row;
    if (number_in(find_column(choice, "damping"), row) != 0.5) continue;
    bool found = false;
    for (std::size_t k = 0; k < rows(trials); ++k)
      found |= number_in(find_column(trials, "time"), k) == time && number_in(find_column(trials, "error"), k) <= error;
    EXPECT_TRUE(found) << "at " << error;
  }
}

TEST_F(ProgramStudies, WhatAutoChoosesReachesTheErrorAndIsComparedWithTheQuickest) {
  DRAPE_SLOW();
  const auto all = tables("auto");
  const auto table = [&](const std::string& name) { return *std::ranges::find(all, name, &Table::name); };
  const Table levels = table("auto"), summary = table("auto-summary");
  ASSERT_EQ(rows(levels), 14u);
  for (std::size_t row = 0; row < rows(levels); ++row) {
    const auto number = [&](const char* column) { return number_in(find_column(levels, column), row); };
    EXPECT_LE(number("error"), number("wanted")) << row;
    EXPECT_DOUBLE_EQ(number("ratio"), number("ms") / number("best_ms")) << row;
  }
  ASSERT_EQ(rows(summary), 2u);
  for (std::size_t row = 0; row < rows(summary); ++row)
    for (const char* column : {"levels", "reached"}) EXPECT_EQ(number_in(find_column(summary, column), row), 7) << row;
}

TEST_F(ProgramStudies, TheFieldHasAllMethodsAndWinnersWithMargins) {
  DRAPE_SLOW();
  const auto all = tables("field");  // in the order of their names
  const auto table = [&](const std::string& name) { return *std::ranges::find(all, name, &Table::name); };
  const Table runs = table("field: hung-corners d=50 n=5"), winners = table("field-winners");
  const auto methods = find_column(runs, "method")->cells;
  for (const solver::Method& method : solver::methods())
    EXPECT_THAT(methods, Contains(Datum(std::string(method.name)))) << method.name;
  EXPECT_THAT(numbers(runs, "uncertainty", "method", "bdf2"), Each(testing::Lt(1e-6)));
  EXPECT_THAT(numbers(runs, "systems", "method", "verlet"), Each(0));
  const Table cloth = table("field: tablecloth n=5");
  for (const Datum& name : find_column(cloth, "method")->cells)
    EXPECT_TRUE(solver::method(std::get<std::string>(name)).meets_obstacles) << std::get<std::string>(name);
  for (std::size_t row = 0; row < rows(winners); ++row) {
    EXPECT_FALSE(number_in(find_column(winners, "margin"), row) < 1) << row;
    EXPECT_EQ(text_in(find_column(winners, "family"), row) == "none", text_in(find_column(winners, "lead"), row) == "none");
  }
  EXPECT_EQ(winners.figure, results::Figure::map);
  EXPECT_GT(rows(table("field-answer")), 0U);
  EXPECT_GT(rows(table("field-transfer")), 0U);
}

TEST_F(ProgramStudies, ErrorsAreNearTheirTolerances) {
  DRAPE_SLOW();
  const auto all = tables("tolerance");
  ASSERT_THAT(all, SizeIs(3));
  const auto known = AnyOf("met: within 10", HasSubstr("under by"), "cost explodes", "fails");
  for (const char* name : {"tolerance-hung-edge", "tolerance-chain"}) {
    const auto found = verdicts(*std::ranges::find(all, name, &Table::name));
    EXPECT_THAT(found, AllOf(SizeIs(2 * small_problems::converging_methods().size()), Each(known)))
        << name << ": one for each row";
    EXPECT_THAT(found, Contains("met: within 10").Times(testing::Ge(8))) << name;
  }
  const Table& summary = *std::ranges::find(all, "tolerance-summary", &Table::name);
  for (const solver::Method& method : small_problems::converging_methods()) {
    const bool may_fail = (method.explicit_springs() && !method.sub_steps) || method.name == "imex-euler" ||
                          method.name == "desbrun";  // their cost explodes
    const testing::Matcher<std::string> proportional = testing::Eq("met: proportional"), none = testing::Eq("no run ends");
    EXPECT_THAT(verdicts_of(summary, std::string(method.name)),
                ElementsAre(may_fail ? testing::Matcher<std::string>(AnyOf(proportional, none)) : proportional))
        << method.name;
  }
}

TEST_F(ProgramStudies, EquilibriaConvergeAsDeclared) {
  DRAPE_SLOW();
  const auto all = tables("convergence");
  ASSERT_THAT(all, SizeIs(3));
  EXPECT_THAT(verdicts(all[0]), ElementsAre("met: exact as declared", "met: 1 as declared"));
  EXPECT_THAT(verdicts(all[1]), Contains("met: 2 as declared"));
  EXPECT_THAT(verdicts(all[2]), Contains("met: 2 as declared").Times(5));
  for (const Table& table : all) EXPECT_THAT(verdicts(table), Each(Not(StartsWith("missed")))) << table.name;
}

TEST_F(ProgramStudies, ReferencesAgree) {
  DRAPE_SLOW();
  const auto all = tables("references");
  ASSERT_THAT(all, SizeIs(2));
  EXPECT_THAT(verdicts(all[0]), AllOf(SizeIs(4), Each("met: as wanted")));  // growth
  EXPECT_THAT(verdicts(all[1]), AllOf(SizeIs(12), Each("met: agrees")));
}

TEST_F(ProgramStudies, WorkGrowsWithStiffnessAndFallsWithDampingAsInTheThesis) {
  DRAPE_SLOW();
  const auto all = tables("table-3.1");
  ASSERT_THAT(all, SizeIs(1));
  EXPECT_THAT(verdicts(all[0]), AllOf(SizeIs(3), Each("met: grows with k, falls with d")));
  EXPECT_THAT(numbers(all[0], "thesis_cg_iterations", "rows", "thesis"), ElementsAre(566, 52, 1160, 538));
}

TEST_F(ProgramStudies, MethodsDrapeTheTableclothButForArtificialDamping) {
  DRAPE_SLOW();
  const auto all = tables("table-3.2");
  ASSERT_THAT(all, SizeIs(2));
  const Table& table = all[0];
  const std::size_t gaining = 2;  // imex-midpoint gains energy where a falling sheet is held
  EXPECT_THAT(numbers(table, "sunk", "outcome", "success"), SizeIs(table.columns[0].cells.size() - gaining));
  EXPECT_THAT(numbers(table, "sunk", "method", "imex-midpoint"), SizeIs(4));
  EXPECT_THAT(numbers(table, "thesis_updates", "method", "bdf2"), ElementsAre(122, 122, IsNan(), IsNan()));
  const double truth = numbers(table, "sunk", "method", "verlet").at(1);
  for (const char* method : {"implicit-euler", "bdf2", "midpoint"})
    EXPECT_NEAR(numbers(table, "sunk", "method", method).at(2), truth, 0.05 * truth) << method;
  EXPECT_LT(numbers(table, "sunk", "method", "imex-euler").at(2), 0.2 * truth);
}

TEST_F(ProgramStudies, MethodsOfSecondOrderDressWithFewerIterations) {
  DRAPE_SLOW();
  const Table dress = tables("table-3.2").at(1);
  EXPECT_THAT(numbers(dress, "clearance", "outcome", "success"), AllOf(SizeIs(10), Each(testing::Ge(0.02 - 1e-9))));
  EXPECT_THAT(numbers(dress, "thesis_cg_iterations", "method", "sbdf2"), ElementsAre(15360, 15360));
  EXPECT_THAT(verdicts(dress), testing::Contains("met: fewer CG iterations than implicit-euler"));
}

TEST_F(ProgramStudies, GarmentsStayOutsideOfTheirBody) {
  DRAPE_SLOW();
  const auto all = tables("garments");
  ASSERT_THAT(all, SizeIs(5));
  for (const Table& table : all) {
    const double kept = model::load_scene(table.name.substr(std::string_view("garment-").size())).contact.distance;
    EXPECT_THAT(numbers(table, "clearance", "outcome", "success"), AllOf(SizeIs(6), Each(testing::Ge(kept - 1e-9))));
    for (const char* part : {"forces", "detection", "response", "rest"})
      EXPECT_THAT(numbers(table, part, "outcome", "success"), Each(testing::Gt(0))) << part;
  }
}

TEST_F(ProgramStudies, EulerSmoothsTheSheetInTheWindAndBdf2Less) {
  DRAPE_SLOW();
  const auto all = tables("figure-3.2");
  ASSERT_THAT(all, SizeIs(2));
  EXPECT_THAT(verdicts(all[0]), AllOf(SizeIs(3), Each("met: swings less")));
  EXPECT_THAT(verdicts(all[1]), AllOf(SizeIs(9), Each("smoothed by Euler")));
  EXPECT_THAT(numbers(all[1], "bending_ratio_bdf2", "waves", "1"), Contains(DoubleNear(1, 1e-2))) << "where damping is strong";
}

TEST_F(ProgramStudies, SemiImplicitMethodsLagAsPredicted) {
  DRAPE_SLOW();
  const auto all = tables("figure-3.3");
  ASSERT_THAT(all, SizeIs(1));
  EXPECT_THAT(verdicts(all[0]), AllOf(SizeIs(4), Each("met: as predicted")));
}

TEST_F(ProgramStudies, RestingOnTheBoxIsNoHarderThanSwinging) {
  DRAPE_SLOW();
  const auto all = tables("figure-4.3");  // in the order of their names
  ASSERT_THAT(all, SizeIs(3));
  const auto bars = numbers(all[1], "value", "method", "bdf2");
  ASSERT_THAT(bars, SizeIs(3));
  EXPECT_LE(bars[0], 1.5);
  EXPECT_THAT(all[2].columns, Contains(Field(&Column::name, "bdf2_contacts")));
  EXPECT_TRUE(all[2].for_file) << "every step";
  EXPECT_EQ(all[2].columns[0].cells.size() / 5, all[0].columns[0].cells.size());
}

TEST_F(ProgramStudies, VirtualParticlesKeepACoarseSheetOut) {
  DRAPE_SLOW();
  const auto all = tables("table-5.1");  // in the order of their names
  ASSERT_THAT(all, SizeIs(3));
  EXPECT_THAT(numbers(all[0], "virtual_particles", "scene", "round_table_100"), ElementsAre(Gt(10)));
  EXPECT_THAT(numbers(all[0], "topology", "scene", "round_table_100"), ElementsAre(Gt(0)));
  const auto divided = numbers(all[1], "divided", "method", "imex-euler"),
             orders = numbers(all[1], "order", "method", "imex-euler");
  ASSERT_THAT(divided, SizeIs(2));
  EXPECT_EQ(divided[0], 0);
  EXPECT_GT(divided[1], 0);
  EXPECT_THAT(orders, SizeIs(2));
  const auto distance = numbers(all[2], "distance", "scene", "round_table_100"),
             penetration = numbers(all[2], "penetration", "scene", "round_table_100");
  ASSERT_THAT(distance, SizeIs(2));
  EXPECT_THAT(distance, Each(AllOf(Gt(0), Lt(0.02))));
  EXPECT_GT(penetration[0], 10 * penetration[1]);
}

TEST_F(ProgramStudies, RaysFindWhatHalfSpacesFind) {
  const auto all = tables("detection");
  ASSERT_THAT(all, SizeIs(1));
  ASSERT_EQ(rows(all[0]), 4u);  // two detections, twice
  const auto of = [&](const std::string& column, const std::string& detection) {
    return numbers(all[0], column, "detection", detection);
  };
  EXPECT_THAT(of("constrained", "ray"), Each(Gt(1)));
  EXPECT_THAT(of("time", "ray"), Each(Gt(0)));
  EXPECT_THAT(of("inside", "half-spaces"), Each(0));
  EXPECT_THAT(of("inside", "ray"), Each(0));
  EXPECT_THAT(of("distance", "ray"), AllOf(SizeIs(2), Each(Lt(1e-3))));
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_LT(of("found", "ray")[k], of("found", "half-spaces")[k]);
    EXPECT_LT(of("distances", "ray")[k], of("distances", "half-spaces")[k]);
  }
}

/// Both seek the stability limit.
TEST_F(ProgramStudies, RunsOfTheAtlasCostTheSameWhateverRanBefore) {
  DRAPE_SLOW();
  const auto evaluations = [&](const std::string& methods) {
    const std::string file = methods + ".h5";
    program.output({"study", "stability", "--quick", "--method", methods, "--out", file});
    const auto all = results::read_tables(program.folder() / file);
    return numbers(*std::ranges::find(all, "stability-atlas", &Table::name), "evaluations", "method", "rk4-substeps");
  };
  EXPECT_THAT(evaluations("rk4-substeps"), AllOf(SizeIs(4), testing::ElementsAreArray(evaluations("verlet,rk4-substeps"))));
}

TEST_F(ProgramStudies, EveryCellOfTheAtlasEndsInAVerdict) {
  DRAPE_SLOW();
  const auto all = tables("stability");  // in the order of their names
  ASSERT_THAT(all, SizeIs(6));
  const auto table = [&](const std::string& name) { return *std::ranges::find(all, "stability-" + name, &Table::name); };
  EXPECT_THAT(verdicts(table("bar")), AllOf(SizeIs(3), Each("met: all converge")));
  const auto all_cells = verdicts(table("atlas"));
  EXPECT_THAT(all_cells, SizeIs(4 * (solver::methods().size() + 3)));
  const auto known =
      AnyOf("accurate", "stable but wrong", "stable, error unknown", "unstable", "not converged", "not finished");
  EXPECT_THAT(all_cells, Each(known));
  EXPECT_THAT(verdicts(table("stress")), AllOf(SizeIs(2 * 17), Each(known)));
  EXPECT_THAT(numbers(table("verdicts"), "accurate", "method", "bdf2"), ElementsAre(4));
  EXPECT_THAT(numbers(table("verdicts"), "not_converged", "method", "bdf2/fixed-point"), ElementsAre(1));
  EXPECT_THAT(numbers(table("verdicts"), "wrong", "method", "sbdf2"), ElementsAre(2)) << "of the slack sheets";
  EXPECT_LT(numbers(table("steps"), "accurate", "method", "sbdf2").at(0),
            numbers(table("steps"), "accurate", "method", "bdf2").at(0));
}

TEST_F(ProgramStudies, EveryStageSolverSolvesEveryStage) {
  const auto all = tables("stages");
  ASSERT_THAT(all, SizeIs(1));
  EXPECT_EQ(rows(all[0]), 3u * (11 + 10)) << "the printed loop has a right-hand side of its own";
  EXPECT_THAT(verdicts(all[0]), testing::IsEmpty()) << "of another sheet there is nothing to compare with";
  const auto updates = [&](const char* solver) { return numbers(all[0], "updates", "solver", solver); };
  for (const char* solver : {"fixed-point", "chebyshev 0.97", "lbfgs", "anderson", "vbd"}) {
    ASSERT_THAT(updates(solver), SizeIs(6)) << solver;
    EXPECT_LT(updates(solver)[0], updates(solver)[2]) << solver << ": from 0.1 |b| to 1e-5 |b|";
    EXPECT_LE(updates(solver)[2], updates(solver)[5]) << solver << ": |b| is more than the momentum";
  }
  EXPECT_LT(updates("anderson")[2], updates("lbfgs")[2]);
  EXPECT_LT(updates("lbfgs")[2], updates("fixed-point")[2]);
  EXPECT_LT(2 * updates("anderson")[2], updates("vbd")[2]);
}

TEST_F(ProgramStudies, StepsByPassesAreComparedWithConstantOnes) {
  DRAPE_SLOW();
  const auto all = tables("step-control");
  ASSERT_THAT(all, SizeIs(1));
  ASSERT_EQ(rows(all[0]), 5u + 6 + 3);
  EXPECT_THAT(verdicts(all[0]), SizeIs(6 + 3)) << "one for each controlled run";
  EXPECT_THAT(numbers(all[0], "changes", "policy", "constant"), Each(0));
  EXPECT_THAT(numbers(all[0], "changes", "policy", "passes"), Each(testing::Ge(1)));
  const auto largest = numbers(all[0], "largest", "policy", "passes");
  EXPECT_LE(largest.front(), largest.back()) << "with more passes allowed";
}

TEST_F(ProgramStudies, ConditionsAreThoseOfTheClosedForms) {
  const auto all = tables("conditioning");  // in the order of their names
  ASSERT_THAT(all, SizeIs(2));
  const auto found = numbers(all[0], "condition", "linear_solver", "jacobi");
  const auto known = numbers(all[0], "known", "linear_solver", "jacobi");
  const auto iterations = numbers(all[0], "iterations", "linear_solver", "jacobi");
  const auto sufficient = numbers(all[0], "sufficient", "linear_solver", "jacobi");
  ASSERT_THAT(found, SizeIs(3u * 3 + 3 + 1));
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_NEAR(found[k], known[k], 0.01 * known[k]);
    EXPECT_LE(iterations[k], sufficient[k]);
  }
  EXPECT_GT(found.back(), found.front()) << "they differ";
  EXPECT_EQ(rows(all[1]), 2u);
}

TEST_F(ProgramStudies, LimitsAreThoseOfTheTheory) {
  DRAPE_SLOW();
  const auto all = tables("limits");
  ASSERT_THAT(all, SizeIs(1));
  EXPECT_THAT(verdicts(all[0]), SizeIs(2 * 6));
  EXPECT_THAT(numbers(all[0], "onset", "method", "imex-euler"), Each(testing::DoubleNear(2, 0.1)));
  EXPECT_THAT(numbers(all[0], "onset", "method", "sbdf2"), Each(testing::DoubleNear(4.0 / 3, 0.07)));
  EXPECT_THAT(numbers(all[0], "onset", "method", "imex-midpoint"), Each(testing::DoubleNear(1, 0.05)));
}

TEST_F(ProgramStudies, FabricsBendAsWasPublished) {
  DRAPE_SLOW();
  program.output({"study", "fabrics", "--quick", "--method", "verlet", "--out", "study.h5"});
  std::map<std::string, std::vector<std::string>> judged;
  for (const Table& table : results::read_tables(program.folder() / "study.h5")) judged[table.name] = verdicts(table);
  EXPECT_THAT(judged["fabric-bending-tests"], AllOf(SizeIs(2 * 4), Each("met: within 5 %"))) << "along weft and warp";
  EXPECT_THAT(judged["cantilever"], AllOf(SizeIs(14), Each("met: within 1 %")));
  EXPECT_THAT(judged["creep"], AllOf(SizeIs(4), Each("met: below 1e-4")));
  EXPECT_TRUE(judged.contains("field-winners"));
}

/// The sample is stiff: on coarse meshes its coefficient lies near the published 0.83.
TEST_F(ProgramStudies, DrapeComesToRestNearWhatWasPublished) {
  DRAPE_SLOW();
  const auto all = tables("drape");
  ASSERT_THAT(all, SizeIs(3));
  const Table& samples = all[0];
  EXPECT_THAT(verdicts(samples), AllOf(SizeIs(4), Each("met: at rest")));
  const std::vector<double> coefficients = numbers(samples, "coefficient", "fabric", "cotton-broad");
  EXPECT_THAT(coefficients, AllOf(SizeIs(4), Each(testing::DoubleNear(0.83, 0.08))));
}

TEST_F(ProgramStudies, ScalingTellsWhatWasChosenAndWhatAnIterationMoves) {
  DRAPE_SLOW();
  const auto all = tables("scaling");  // in the order of their names
  ASSERT_THAT(all, SizeIs(3));
  EXPECT_THAT(numbers(all[0], "n", "linear_solver", "cholesky"), ElementsAre(20, 20, 40, 40));
  const auto iterations = numbers(all[0], "cg_iterations", "linear_solver", "cholesky");
  EXPECT_THAT(iterations, Each(0));
  // z, p, p, q and d, d, p, r, r, q, and the stencil: more than the matrix's bytes would be too much to claim.
  EXPECT_THAT(numbers(all[2], "bytes", "linear_solver", "none"), Each(AllOf(testing::Ge(240), testing::Le(260))));
  EXPECT_THAT(verdicts(all[1]), AllOf(SizeIs(3), Each(AnyOf("met", HasSubstr("missed: not met by")))));
}

}  // namespace
}  // namespace drape::verify::studies_test
