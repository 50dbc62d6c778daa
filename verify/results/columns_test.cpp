// Tables of rows: every column has a cell for each row, whatever the row lacks.

#include "results/columns.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace drape::verify::columns_test {
namespace {

using namespace results;

struct Leg {
  double length;
};

struct Animal {
  const char* name;
  std::optional<Leg> front, back;
};

constexpr ColumnOf<Animal> animal_columns[] = {
    {"name", "name", "", "who", Role::key, field<&Animal::name>, [](const Animal& a) { return std::string(a.name) + "!"; }},
};
constexpr ColumnOf<Leg> leg_columns[] = {
    {"{}_length", "{} leg", "m", "of the {} legs", Role::quantity, field<&Leg::length>},
    {"{}_twice", "", "m", "", Role::note, [](const Leg& leg) -> Datum { return 2 * leg.length; }},
};

const std::vector<Animal> animals{{"bird", {}, Leg{0.5}}, {"dog", Leg{1}, Leg{2}}};

TEST(Columns, AreEquallyLongWhateverARowLacks) {
  Table table = make_table("animals", "", animal_columns, animals);
  add_columns(table, leg_columns, animals, [](const Animal& a) { return a.front; }, {"front", "front", "fore"});
  add_columns(table, leg_columns, animals, [](const Animal& a) { return a.back ? &*a.back : nullptr; },
              {"back", "back", "hind"});
  EXPECT_EQ(to_csv(table),
            "name,front_length,front_twice,back_length,back_twice\n"
            "bird,,,0.5,1\n"
            "dog,1,2,2,4\n");
  EXPECT_EQ(to_text(table),
            "name   front leg  back leg\n"
            "             [m]       [m]\n"
            "--------------------------\n"
            "bird!                  0.5\n"
            "dog!           1         2\n");
  EXPECT_EQ(find_column(table, "front_length")->description, "of the fore legs");
}

TEST(Columns, AreThereWithoutRows) {
  const Table table = make_table("animals", "", animal_columns, std::vector<Animal>());
  EXPECT_EQ(rows(table), 0u);
  EXPECT_EQ(to_csv(table), "name\n");
  EXPECT_EQ(to_text(table), "no rows\n");
}

}  // namespace
}  // namespace drape::verify::columns_test
