// Texts of others on their way to a terminal, and names that may have been meant.

#include "solver/base/printable.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <random>

#include "solver/base/registry.hpp"

namespace drape::verify::printable_test {
namespace {

using base::characters;
using base::nearest_name;
using base::printable;
using base::printable_lines;
using base::shortened;

TEST(Printable, LeavesTextOfAllLanguagesAlone) {
  for (const std::string text : {"", "plain", "ν_h ≤ 1 m/s²", "Fähnchen \\ 'x' \"y\"", "日本語", "🙂"}) {
    EXPECT_EQ(base::printable(text), text);
    EXPECT_EQ(base::printable_lines(text), text);
  }
}

TEST(Printable, EscapesWhatActsOnATerminal) {
  EXPECT_EQ(base::printable("a\033[31m\a\b\x7f"), R"(a\u001b[31m\u0007\u0008\u007f)");
  EXPECT_EQ(base::printable("\n\r\t"), R"(\n\r\t)");
  EXPECT_EQ(base::printable(std::string("a\0b", 3)), R"(a\u0000b)");
  EXPECT_EQ(base::printable("\u009b0m\u0085"), R"(\u009b0m\u0085)") << "C1 controls";
  EXPECT_EQ(base::printable("\u202eabc\u2066\u200b\u2028\ufeff"), R"(\u202eabc\u2066\u200b\u2028\ufeff)")
      << "direction, width, lines";
}

TEST(Printable, EscapesBytesThatAreNoText) {
  EXPECT_EQ(base::printable("\xff\xfe"), R"(\xff\xfe)");
  EXPECT_EQ(base::printable("\xc0\x8a"), R"(\xc0\x8a)") << "a line feed in too many bytes";
  EXPECT_EQ(base::printable("\xed\xa0\x80"), R"(\xed\xa0\x80)") << "a surrogate";
  EXPECT_EQ(base::printable("\xf4\x90\x80\x80"), R"(\xf4\x90\x80\x80)") << "beyond Unicode";
  EXPECT_EQ(base::printable("\xe2\x82"), R"(\xe2\x82)") << "cut off";
  EXPECT_EQ(base::printable("\x9b\x30m"), R"(\x9b0m)") << "a control of one byte";
}

TEST(Printable, OfLinesKeepsLineFeedsOnly) { EXPECT_EQ(base::printable_lines("a\n\tb\r\n"), "a\n\\tb\\r\n"); }

TEST(Printable, OfNoiseHasNoControlsAndIsItsOwn) {
  std::mt19937 random(1);
  for (int k = 0; k < 2000; ++k) {
    std::string noise(random() % 40, ' ');
    for (char& byte : noise) byte = static_cast<char>(random());
    const std::string shown = base::printable(noise);
    for (const unsigned char byte : shown) EXPECT_TRUE(byte >= 0x20 && byte != 0x7f);
    EXPECT_EQ(base::printable(shown), shown);
    EXPECT_NO_THROW(nlohmann::json(shown).dump()) << "no UTF-8";
  }
}

TEST(Printable, LeavesTheMeaningOfJson) {
  const nlohmann::json json{{"a\u202e", "\033\u009b\n \\ \" ü"}};
  EXPECT_EQ(nlohmann::json::parse(base::printable_lines(json.dump(2))), json);
}

TEST(Shortened, CountsCharactersNotBytes) {
  EXPECT_EQ(base::characters("νν"), 2u);
  EXPECT_EQ(base::shortened("ννν", 3), "ννν");
  EXPECT_EQ(base::shortened("ννν", 2), "νν... (3 characters)");
}

TEST(Quoted, IsOfAtMost200Characters) {
  EXPECT_EQ(base::quoted(std::string(200, 'a')), std::string(200, 'a'));
  EXPECT_EQ(base::quoted(std::string(5 << 20, 'a')), std::string(200, 'a') + "... (5242880 characters)");
}

TEST(NearestName, IsWhatMayHaveBeenMeant) {
  const std::vector<std::string_view> names{"bdf2", "sbdf2", "midpoint", "hung-edge", "material.density"};
  EXPECT_EQ(base::nearest_name("bdf", names), "bdf2");
  EXPECT_EQ(base::nearest_name("BDF2", names), "bdf2");
  EXPECT_EQ(base::nearest_name("mid-point", names), "midpoint");
  EXPECT_EQ(base::nearest_name("hung_edge", names), "hung-edge");
  EXPECT_EQ(base::nearest_name("material.densty", names), "material.density");
  EXPECT_EQ(base::nearest_name("midpiont", names), "midpoint");
  EXPECT_EQ(base::nearest_name("bfd2", names), "bdf2") << "two neighbours exchanged are one mistake";
  EXPECT_EQ(base::nearest_name("DBF2", names), "bdf2");
}

TEST(NearestName, IsNoneIfNoneIsNear) {
  const std::vector<std::string_view> names{"bdf2", "midpoint"};
  for (const std::string name : {"rk4", "", "verlet", "xxxxxxxxxxxx", "fbd2"})
    EXPECT_EQ(base::nearest_name(name, names), "") << name;
  EXPECT_EQ(base::nearest_name(std::string(1 << 20, 'm'), names), "");
  EXPECT_EQ(base::nearest_name("bdf2", {}), "");
}

}  // namespace
}  // namespace drape::verify::printable_test
