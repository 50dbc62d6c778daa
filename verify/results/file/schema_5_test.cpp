// A file that an earlier program wrote reads as if this one had: schema-5.h5 is `study stability --quick` of November 2026.

#include "results/file/schema_5.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "results/analysis/compare.hpp"
#include "results/file/validate.hpp"
#include "verify/support/tables.hpp"

namespace drape::verify::schema_5_test {
namespace {

using namespace results;
using testing::ElementsAre;

const std::filesystem::path file_of_5 = std::filesystem::path(DRAPE_SOURCE_DIR) / "verify/data/schema-5.h5";

TEST(SchemaFive, ReadsWithOutcomesAndParts) {
  const std::vector<Table> tables = read_tables(file_of_5);
  const auto atlas = std::ranges::find(tables, Figure::stability, &Table::figure);
  ASSERT_NE(atlas, tables.end());
  EXPECT_TRUE(atlas->for_file);
  EXPECT_FALSE(atlas->timed_rows);
  const Column& ending = *find_column(*atlas, Role::outcome);
  EXPECT_EQ(ending.part, Part::colour);
  ASSERT_EQ(ending.classes.size(), 6U);
  EXPECT_EQ(ending.classes.front(), "accurate");
  EXPECT_THAT(find_column(*atlas, "predicted")->classes, ElementsAre("stable", "unstable", "loop too slow"));
  EXPECT_EQ(find_column(*atlas, "nu")->part, Part::y);
}

TEST(SchemaFive, IsValidAndComparesWithItself) {
  EXPECT_THAT(validate(file_of_5), testing::IsEmpty());
  const Recording recording = read_recording(file_of_5);
  EXPECT_EQ(exit_code(compare(recording, recording, {.times = false})), 0);
}

TEST(SchemaFive, LeavesVerdictsBesideOutcomes) {
  Table table{"table",
              "",
              {column("verdict", "", Role::verdict, {"met: within 10", "fails"}),
               column("outcome", "", Role::verdict, {"success", "unstable"})}};
  complete(table);
  EXPECT_EQ(table.columns[0].role, Role::verdict);
  EXPECT_EQ(table.columns[1].role, Role::outcome);
}

TEST(SchemaFive, SaysWhoMadeATrialAndThatTheirRowsDependOnTimes) {
  Table trials{
      "trials: sheet",
      "",
      {column("code", "", Role::key, {"drape", "drape", "thesis", "cvode-bdf"}),
       column("method", "", Role::key, {"bdf2", "", "", ""}), column("error", "1", Role::error, {1e-1, 1e-2, 1e-3, 1e-4}),
       column("time", "ms", Role::time, {1.0, 2.0, 3.0, 4.0})}};
  trials.figure = Figure::work_precision;
  complete(trials);
  EXPECT_TRUE(trials.timed_rows);
  EXPECT_THAT(find_column(trials, "side")->cells, ElementsAre("ours", "ours", "ours", "SUNDIALS"));
  EXPECT_THAT(find_column(trials, "kind")->cells, ElementsAre("", "", "thesis", "cvode-bdf"));
  EXPECT_THAT(find_column(trials, "solvers")->cells, ElementsAre("automatic", "", "", ""));
  EXPECT_EQ(find_column(trials, "error")->part, Part::x);
}

TEST(SchemaFive, GroupsColumnsOverTimeByMethod) {
  Table table{"figure-4.3",
              "",
              {column("t", "s", Role::key, {0.1}), column("bdf2_CG", "1", Role::counter, {1.0}),
               column("sbdf2_CG", "1", Role::counter, {2.0})}};
  table.figure = Figure::over_time;
  complete(table);
  EXPECT_EQ(table.columns[0].part, Part::x);
  EXPECT_EQ(table.columns[1].group, "bdf2");
  EXPECT_EQ(table.columns[2].group, "sbdf2");
  EXPECT_EQ(table.columns[2].part, Part::y);
}

}  // namespace
}  // namespace drape::verify::schema_5_test
