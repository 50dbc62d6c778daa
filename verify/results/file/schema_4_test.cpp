// A file that an earlier program wrote reads as if this one had: schema-4.h5 is `study orders --quick` of November 2026.

#include "results/file/schema_4.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "results/analysis/compare.hpp"
#include "results/file/validate.hpp"
#include "results/verdict.hpp"

namespace drape::verify::schema_4_test {
namespace {

using namespace results;

const std::filesystem::path old_file = std::filesystem::path(DRAPE_SOURCE_DIR) / "verify/data/schema-4.h5";

TEST(SchemaFour, ReadsWithRolesVerdictsAndFigures) {
  const std::vector<Table> tables = read_tables(old_file);
  ASSERT_EQ(tables.size(), 1U);
  const Table& table = tables[0];
  EXPECT_EQ(table.figure, Figure::convergence);
  const auto role = [&](const char* name) { return find_column(table, name)->role; };
  EXPECT_EQ(role("method"), Role::key);
  EXPECT_EQ(role("step"), Role::key);
  EXPECT_EQ(role("error"), Role::error);
  EXPECT_EQ(role("uncertainty"), Role::uncertainty);
  EXPECT_EQ(role("order"), Role::note);
  EXPECT_EQ(role("fitted_order"), Role::order);
  EXPECT_EQ(role("spread"), Role::note);
  int met = 0, missed = 0;
  for (std::size_t row = 0; row < rows(table); ++row) {
    const Standing verdict = standing(find_column(table, Role::verdict)->cells[row]);
    met += verdict == Standing::met ? 1 : 0;
    missed += verdict == Standing::missed ? 1 : 0;
  }
  EXPECT_EQ(met, 13);
  EXPECT_EQ(missed, 0);
  EXPECT_EQ(text_in(find_column(table, Role::verdict), 0), "met: 1 as declared") << "in the first row of the curve";
}

TEST(SchemaFour, IsValidAndComparesWithItself) {
  EXPECT_THAT(validate(old_file), testing::IsEmpty());
  const Recording recording = read_recording(old_file);
  EXPECT_EQ(exit_code(compare(recording, recording, {.times = false})), 0);
}

TEST(OldScenes, AreReadKeyByKeyFromTheirText) {
  const auto rows = [](const std::string& toml) {
    std::vector<std::string> texts;
    for (const auto& [key, value, unit] : keys_in(toml)) texts.push_back(key + ": " + value);
    return texts;
  };
  EXPECT_THAT(rows("name = \"a = b\"\ngrid.n = [5, 3]\npins = []\n"),
              testing::ElementsAre("name: \"a = b\"", "grid.n: [5, 3]"));
  EXPECT_THAT(rows("pins = [{ particles = [[0, 19], [19, 19], ] }, { where = \"}, {\\\"\" }]\n"),
              testing::ElementsAre("pins: { particles = [[0, 19], [19, 19]] }", "pins: { where = \"}, {\\\"\" }"));
  EXPECT_THAT(rows("obstacles = [{ shape = \"plane\", motion = [{ time = 0 }, { time = 1 }] }]\n"),
              testing::ElementsAre("obstacles: { shape = \"plane\", motion = [{ time = 0 }, { time = 1 }] }"));
}

TEST(SchemaFour, SaysWhatIsNotAsItWasWanted) {
  const auto usual = [](const char* text) { return written_verdict(text, 4); };
  EXPECT_EQ(usual("NOT 4"), Datum(Verdict{Standing::missed, "not 4"}));
  EXPECT_EQ(usual("BDF(2) is NOT nearer"), Datum(Verdict{Standing::missed, "BDF(2) is not nearer"}));
  EXPECT_EQ(usual("as in theory"), Datum(Verdict{Standing::met, "as in theory"}));
  EXPECT_EQ(usual("no theory known"), Datum(Verdict{Standing::open, "no theory known"}));
  EXPECT_EQ(usual("stable but wrong"), Datum("stable but wrong"));
}

TEST(SchemaFive, OfTheFirstFilesBeginsVerdictsWithTheirStandings) {
  const auto worded = [](const char* text) { return written_verdict(text, 5); };
  EXPECT_EQ(worded("missed: not met by 1.30: never"), Datum(Verdict{Standing::missed, "not met by 1.30: never"}));
  EXPECT_EQ(worded("met"), Datum(Verdict{Standing::met}));
  EXPECT_EQ(worded("under: not resolved"), Datum("under: not resolved"));
  EXPECT_EQ(worded("methodical"), Datum("methodical"));
}

}  // namespace
}  // namespace drape::verify::schema_4_test
