// Who is how quick over several scenes: hand-made trials with known ratios.

#include "results/analysis/ranking.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "results/columns.hpp"

namespace drape::verify::ranking_test {
namespace {

using results::ColumnOf;
using results::field;
using results::Role;
using results::Table;

struct Trial {
  const char *code, *method;
  double error, time;
  int repetitions = 5;  ///< 0: it failed
  double uncertainty = 1e-9;
};

constexpr ColumnOf<Trial> columns[] = {
    {"code", "", "", "", Role::key, field<&Trial::code>},
    {"method", "", "", "", Role::key, field<&Trial::method>},
    {"uncertainty", "", "1", "", Role::uncertainty, field<&Trial::uncertainty>},
};
constexpr ColumnOf<Trial> measured_columns[] = {
    {"error", "", "1", "", Role::error, field<&Trial::error>},
    {"time", "", "ms", "", Role::time, field<&Trial::time>},
    {"repetitions", "", "1", "", Role::time, field<&Trial::repetitions>},
};

Table trials(const std::string& scene, const std::vector<Trial>& list) {
  Table table = make_table("trials: " + scene, "", columns, list);
  add_columns(table, measured_columns, list, [](const Trial& trial) { return trial.repetitions > 0 ? &trial : nullptr; });
  return table;
}

/// The row of a method at an error of 1e-1 to 1e-7.
struct Row {
  double scenes = NAN, reached = NAN, mean = NAN, least = NAN, largest = NAN;
};

Row row_of(const Table& ranking, const std::string& method, int digits) {
  const auto number = [&](const char* column, std::size_t row) { return number_in(find_column(ranking, column), row); };
  for (std::size_t row = 0; row < rows(ranking); ++row)
    if (text_in(find_column(ranking, "method"), row) == method && std::lround(-std::log10(number("error", row))) == digits)
      return {number("scenes", row), number("reached", row), number("mean", row), number("least", row), number("largest", row)};
  return {};
}

TEST(Ranking, IsTheGeometricMeanAndTheRangeOverTheScenesThatAreReached) {
  const std::vector<Table> tables{
      trials("one", {{"drape", "", 1e-4, 1}, {"drape", "a", 1e-4, 2}, {"drape", "a", 1e-2, 1.5}, {"drape", "b", 5e-2, 3}}),
      trials("two", {{"explicit", "", 1e-4, 2}, {"drape", "a", 1e-4, 16}, {"drape", "b", 1e-7, 0, 0}})};
  const Table ranking = results::ranking(tables);
  const Row fine = row_of(ranking, "a", 4), coarse = row_of(ranking, "a", 1), some = row_of(ranking, "b", 1),
            none = row_of(ranking, "b", 4);
  EXPECT_EQ(fine.reached, 2);
  EXPECT_NEAR(fine.mean, 4, 1e-12) << "of 2 and 8";
  EXPECT_EQ(fine.least, 2);
  EXPECT_EQ(fine.largest, 8);
  EXPECT_EQ(coarse.least, 1.5) << "the coarser of its trials is quicker";
  EXPECT_EQ(some.scenes, 2);
  EXPECT_EQ(some.reached, 1);
  EXPECT_DOUBLE_EQ(some.mean, 3);
  EXPECT_EQ(none.scenes, 2);
  EXPECT_EQ(none.reached, 0);
  EXPECT_TRUE(std::isnan(none.mean) && std::isnan(none.least) && std::isnan(none.largest));
}

TEST(Ranking, CountsOnlyOursTimedRepeatedlyWhereTheReferenceResolvesTheError) {
  std::vector<Trial> list{
      {"cvode-bdf", "", 1e-4, 0.1}, {"drape", "", 1e-4, 0.5, 1}, {"drape", "", 1e-4, 1}, {"drape", "a", 1e-4, 3}};
  const Table all = results::ranking(std::vector{trials("one", list), Table{"winners", "", {}}});
  EXPECT_DOUBLE_EQ(row_of(all, "a", 3).mean, 3);
  EXPECT_EQ(row_of(all, "a", 3).scenes, 1);
  EXPECT_TRUE(std::isnan(row_of(all, "a", 5).scenes)) << "nothing of ours reaches it";
  for (Trial& trial : list) trial.uncertainty = 1e-4;
  const Table uncertain = results::ranking(std::vector{trials("one", list)});
  EXPECT_DOUBLE_EQ(row_of(uncertain, "a", 3).mean, 3);
  EXPECT_TRUE(std::isnan(row_of(uncertain, "a", 4).scenes));
}

TEST(Ranking, OfNothingIsEmpty) { EXPECT_EQ(rows(results::ranking({})), 0u); }

}  // namespace
}  // namespace drape::verify::ranking_test
