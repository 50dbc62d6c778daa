// What report says of files on one screen.

#include "results/analysis/overview.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "results/analysis/conclusion.hpp"
#include "verify/support/tables.hpp"

namespace drape::verify::overview_test {
namespace {

const results::Datum two = results::Verdict{results::Standing::met, "2 as declared"};
const results::Datum not_three = results::Verdict{results::Standing::missed, "not 3"};
const results::Datum no_order = results::Verdict{results::Standing::open, "no order to be seen"};

using results::Datum;
using results::Recording;
using results::Role;
using results::RunRecord;
using results::Table;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

Recording recording(const Table& table) { return {{}, {}, {table}}; }

/// A table of the overview, which is the only one beside the conclusion.
std::string shown(const Recording& recording, const std::string& name) {
  const std::vector<Table> tables = results::overview({&recording, 1});
  EXPECT_LE(tables.size(), 2);
  return results::to_csv(*std::ranges::find(tables, name, &Table::name));
}

/// What is concluded, sentence by sentence.
std::vector<std::string> conclusion(const Recording& recording) {
  const Table table = results::conclusion({&recording, 1});
  std::vector<std::string> sentences;
  for (std::size_t row = 0; row < rows(table); ++row)
    sentences.push_back(text_in(find_column(table, "subject"), row) + ": " + text_in(find_column(table, "conclusion"), row));
  return sentences;
}

TEST(Overview, CountsOrdersThatAreAsDeclaredAndNamesTheOthers) {
  const Table table{"orders-sheet",
                    "",
                    {column("method", "", Role::key, {"bdf2", "bdf2", "bdf3", "bdf5"}),
                     column("verdict", "", Role::verdict, {{}, two, not_three, no_order}),
                     column("fitted_order", "1", Role::order, {{}, 2.01, 2.5, {}})}};
  EXPECT_EQ(shown(recording(table), "orders"),
            "table,good,others\norders-sheet,1 of 3,bdf3: missed: not 3 but 2.50; bdf5: no order to be seen\n");
}

TEST(Overview, ShowsHeadlineTablesWhole) {
  const Table other{"quickest", "Who is quick", {column("k", "1", Role::key, std::vector<results::Datum>(12, 1.5))}};
  Table headline = other;
  headline.headline = true;
  const Table without_rows{"nothing", "", {}, true};
  const Recording all{{}, {}, {other, headline, without_rows}};
  const std::vector<Table> tables = results::overview({&all, 1});
  ASSERT_THAT(tables, SizeIs(1));
  EXPECT_EQ(tables[0].description, "Who is quick");
  EXPECT_EQ(results::to_csv(tables[0]), results::to_csv(headline));
}

RunRecord run(const char* method, double error, double ms) {
  RunRecord run;
  run.scene = "sheet";
  run.method = method;
  run.step = 0.01;
  run.outcome = solver::Outcome::success;
  run.times_ms = {ms};
  run.error.emplace().rms = error;
  run.error->growth = 1;
  return run;
}

TEST(Overview, NamesTheQuickestRunAtEachErrorThatIsResolved) {
  RunRecord lucky = run("lucky", 1e-9, 0.1), folded = run("folded", 1e-9, 0.1);
  lucky.error->reference_error = 1e-4;
  folded.error->growth = 1e6;
  const Recording recording{{}, {run("slow", 1e-5, 3), run("quick", 1e-2, 0.05), run("slower", 1e-5, 4), lucky, folded}, {}};
  EXPECT_EQ(shown(recording, "quickest-runs"),
            "scene,1e-1,1e-2,1e-3,1e-4,1e-5,1e-6,1e-7\nsheet,quick 0.01,quick 0.01,lucky 0.01,slow 0.01,slow 0.01,,\n");
}

TEST(Overview, ShowsWhatFailedAndWhy) {
  RunRecord failed = run("bdf2", 0, 1);
  failed.error.reset();
  failed.overrides = "k=1";
  failed.outcome = solver::Outcome::unstable;
  failed.message = "too much energy";
  failed.last_good_time = 0.12;
  EXPECT_EQ(shown({{}, {failed}, {}}, "failures"),
            "scene,method,step,outcome,reached,message\nsheet k=1,bdf2,0.01,unstable,0.12,too much energy\n");
}

TEST(Overview, ShowsTenOfWhatIsNotAsItWasWanted) {
  const std::vector<Datum> bars(24, "faster"), errors(24, 0.1);
  std::vector<Datum> verdicts;
  for (int k = 0; k < 24; ++k) verdicts.push_back(k % 2 == 0 ? two : not_three);
  const Table table{"bars",
                    "",
                    {column("bar", "", Role::key, bars), column("error", "1", Role::key, errors),
                     column("verdict", "", Role::verdict, verdicts)}};
  const Recording all = recording(table);
  const Table not_met = results::overview({&all, 1}).at(0);
  EXPECT_EQ(rows(not_met), 10);
  EXPECT_THAT(not_met.description, HasSubstr("2 more"));
  EXPECT_EQ(text_in(find_column(not_met, "row"), 9), "faster error 0.1");
}

TEST(Overview, ShowsWhatIsNotAsItWasWantedInAnyColumnOfATableForUsers) {
  const Datum met = results::Verdict{results::Standing::met};
  Table table{"table",
              "",
              {column("method", "", Role::key, {"a", "b", "c"}),
               column("first", "", Role::verdict, {met, met, results::Verdict{results::Standing::missed, "one"}}),
               column("second", "", Role::verdict, {met, results::Verdict{results::Standing::missed, "two"}, met}),
               column("outcome", "", Role::outcome, {"unstable", "success", {}}),
               column("class", "", Role::outcome, {"wrong", "wrong", "right"})}};
  table.columns.back().classes = {"right", "wrong"};
  EXPECT_EQ(shown(recording(table), "not-met"),
            "table,row,verdict\ntable,a,unstable\ntable,b,missed: two\ntable,c,missed: one\n");
  table.for_file = true;
  const Recording all = recording(table);
  EXPECT_THAT(results::overview({&all, 1}), IsEmpty());
}

TEST(Conclusion, SaysOfRunsWhoIsQuickWhoIsWrongAndWhoFails) {
  RunRecord failed = run("unlucky", 0, 1);
  failed.error.reset();
  failed.outcome = solver::Outcome::unstable;
  EXPECT_THAT(conclusion({{}, {run("slow", 1e-5, 3), run("quick", 1e-2, 0.05), run("wrong", 0.3, 1), failed}, {}}),
              ElementsAre("sheet: The quickest with an error of at most 1 % of the size is quick, h = 0.01 s, in 0.05 ms; "
                          "of at most 0.01 %, slow, h = 0.01 s, in 3 ms.",
                          "sheet: Stable and wrong: wrong, h = 0.01 s, ends 30 % of the size away.",
                          "sheet: Ended unstable: unlucky."));
}

TEST(Conclusion, NamesTheWorstRunsOfThreeMethods) {
  EXPECT_THAT(conclusion({{}, {run("a", 0.2, 1), run("a", 0.1, 1), run("b", 0.06, 1), run("c", 0.9, 1), run("d", 0.5, 1)}, {}}),
              ElementsAre("sheet: Stable and wrong: c, h = 0.01 s, ends 90 % of the size away; d, h = 0.01 s, 50 %; "
                          "a, h = 0.01 s, 20 %; and 1 more."));
}

TEST(Conclusion, SaysOfTablesHowManyOrdersAreAsDeclaredAndWhichAreNot) {
  const Table orders{
      "orders-sheet",
      "",
      {column("method", "", Role::key, {"bdf2", "bdf2", "bdf3"}), column("verdict", "", Role::verdict, {"", two, not_three}),
       column("fitted_order", "1", Role::order, {2.0, 2.0, 2.0})}};
  EXPECT_THAT(conclusion({{}, {}, {orders}}),
              ElementsAre("orders-sheet: 1 of 2 methods converge with the order they declare; bdf3: missed: not 3 but 2.00."));
}

TEST(Conclusion, RepeatsWhatHeadlineTablesSayOfTheirRows) {
  Table table{
      "ratios", "", {column("scene", "", Role::key, {"sheet", "chain"}), column("words", "", Role::note, {"Twice.", "Once."})}};
  results::draw(table, results::Figure::none, {{results::Part::caption, "words"}});
  EXPECT_THAT(conclusion({{}, {}, {table}}), IsEmpty());
  table.headline = true;
  EXPECT_THAT(conclusion({{}, {}, {table}}), ElementsAre("sheet: Twice.", "chain: Once."));
}

TEST(Overview, OfNothingIsEmpty) { EXPECT_THAT(results::overview({}), IsEmpty()); }

}  // namespace
}  // namespace drape::verify::overview_test
