// Damaged input never crashes a reader: seeded mutations of good files give an error or, for scenes, at most another scene.

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>

#include "model/scene_file/scene_file.hpp"
#include "results/file/journal.hpp"
#include "results/file/run_file.hpp"
#include "results/file/validate.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::fuzz_test {
namespace {

namespace fs = std::filesystem;

#ifdef DRAPE_SANITIZE
constexpr int rounds = 1;  // sanitizers make them ten times slower
#else
constexpr int rounds = 20;
#endif

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

/// A few bits, bytes or pieces are changed; one in ten is cut.
std::string mutated(std::string text, std::mt19937& random) {
  const auto place = [&] { return random() % text.size(); };
  for (auto changes = 1 + random() % 8; changes > 0; --changes) {
    const std::size_t p = place(), q = place(), length = random() % 16;
    switch (random() % 5) {
      case 0: text[p] = static_cast<char>(text[p] ^ (1 << random() % 8)); break;
      case 1: text[p] = static_cast<char>(random()); break;
      case 2: text[p] = static_cast<char>(random() % 2 == 0 ? 0 : 0xff); break;
      case 3: text.replace(p, length, text.substr(q, length)); break;
      default: text.insert(p, text.substr(q, length)); break;
    }
  }
  if (random() % 10 == 0) text.resize(place());
  return text;
}

/// Whether a reader refuses its input as it may; any other exception fails the test.
template <class Error, class Read>
bool refuses(const Read& read) {
  try {
    read();
    return false;
  } catch (const Error& error) {
    EXPECT_STRNE(error.what(), "");
    return true;
  }
}

TEST(Fuzz, EveryDamageOfARecordIsNoticed) {
  DRAPE_SLOW();
  const base::TemporaryFolder folder;
  const fs::path file = folder / "damaged.h5";
  std::mt19937 random(1);
  for (const char* name : {"runs-schema-4.h5", "tables-schema-4.h5"}) {
    const std::string good = content(fs::path(DRAPE_SOURCE_DIR) / "verify/data" / name);
    for (int k = 0; k < 25 * rounds; ++k) {
      const std::string bad = mutated(good, random);
      if (bad == good) continue;
      write(file, bad);
      EXPECT_TRUE(refuses<base::FileError>([&] { results::read_runs(file); })) << name << " " << k;
      EXPECT_TRUE(refuses<base::FileError>([&] { results::read_tables(file); })) << name << " " << k;
      EXPECT_TRUE(refuses<base::FileError>([&] { results::read_provenance(file); })) << name << " " << k;
      EXPECT_TRUE(refuses<base::FileError>([&] { results::validate(file); })) << name << " " << k;
    }
  }
}

TEST(Fuzz, ADamagedJournalHasOnlyWhatWasWritten) {
  const base::TemporaryFolder folder;
  const fs::path file = folder / "runs.h5", path = folder / "runs.h5.journal";
  const results::Provenance facts{{"program_hash", "1", ""}, {"sweep", "a", ""}};
  const results::Journal::Bytes value(100, 7);
  {
    results::Journal journal(file, facts, results::Start::fresh);
    for (const char* id : {"first", "second", "third"}) journal.add(id, value);
  }
  const std::string good = content(path);
  std::mt19937 random(2);
  int refused = 0, less = 0;
  for (int k = 0; k < 1000 * rounds; ++k) {
    write(path, mutated(good, random));
    refused += refuses<base::FileError>([&] {
      const results::Journal journal(file, facts, results::Start::resumed);
      for (const char* id : {"first", "second", "third"}) {
        const auto* found = journal.find(id);
        less += found == nullptr;
        EXPECT_TRUE(found == nullptr || *found == value) << k;
      }
    });
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(less, 0);
}

TEST(Fuzz, DamagedScenesAreScenesOrErrors) {
  const base::TemporaryFolder folder;
  const fs::path file = folder / "damaged.toml";
  std::mt19937 random(3);
  int refused = 0, accepted = 0;
  for (const char* name : {"hung-edge", "wind", "tablecloth", "box_swing", "curtain"}) {
    const std::string good = model::to_toml(model::load_scene(name));
    for (int k = 0; k < 100 * rounds; ++k) {
      write(file, mutated(good, random));
      ++(refuses<model::SceneError>([&] { model::load_scene(file.string()); }) ? refused : accepted);
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(accepted, 0);
}

std::string repeated(std::size_t count, const std::string& text) {
  std::string all;
  for (std::size_t k = 0; k < count; ++k) all += text;
  return all;
}

/// What readers of TOML stumble over: depth, length, controls, numbers out of range, quotes without an end.
const std::vector<std::string>& hostile_pieces() {
  static const std::vector<std::string> pieces{std::string(100'000, '['),
                                               repeated(50'000, "{a = "),
                                               repeated(50'000, "a."),
                                               repeated(20'000, "'a' . \"b\" . "),
                                               "[" + repeated(50'000, "a.") + "a]",
                                               std::string(300'000, 'x'),
                                               "\033[2J",
                                               "\xff\xfe",
                                               std::string(1, '\0'),
                                               "\u202e",
                                               "\\u009b",
                                               "\\ud800",
                                               "1e999",
                                               "9223372036854775808",
                                               "-9223372036854775808",
                                               "nan",
                                               "'''",
                                               "\"\"\"",
                                               "\\",
                                               "\r",
                                               "10000000",
                                               "\n[[pins]]\n",
                                               "\n[pins]\n",
                                               " = ",
                                               "0x",
                                               "1979-05-27T07:32:00Z",
                                               "#",
                                               "\n"};
  return pieces;
}

TEST(Fuzz, HostileScenesAreScenesOrErrors) {
  const base::TemporaryFolder folder;
  const fs::path file = folder / "hostile.toml";
  std::mt19937 random(4);
  int refused = 0, accepted = 0;
  for (const char* name : {"hung-edge", "curtain", "box_swing"}) {
    const std::string good = model::to_toml(model::load_scene(name));
    for (int k = 0; k < 30 * rounds; ++k) {
      std::string bad = good + "# ";
      for (auto pieces = 1 + random() % 3; pieces > 0; --pieces) {
        const std::size_t at = random() % 3 == 0 ? bad.size() : random() % (bad.size() + 1);  // at the end: in a comment
        bad.insert(at, hostile_pieces()[random() % hostile_pieces().size()]);
      }
      write(file, bad);
      ++(refuses<model::SceneError>([&] { model::load_scene(file.string()); }) ? refused : accepted);
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(accepted, 0);
}

TEST(Fuzz, HostileOverridesAreScenesOrErrors) {
  std::mt19937 random(5);
  const std::vector<model::KeyHelp> keys = model::scene_keys();
  for (int k = 0; k < 50 * rounds; ++k) {
    const auto piece = [&] { return hostile_pieces()[random() % hostile_pieces().size()]; };
    const std::string key = keys[random() % keys.size()].path + (random() % 4 == 0 ? piece() : "");
    refuses<model::SceneError>([&] {
      const model::Override change = model::parse_override(key + "=" + piece() + (random() % 2 == 0 ? piece() : ""));
      model::load_scene("hung-edge", {&change, 1});
    });
  }
}

}  // namespace
}  // namespace drape::verify::fuzz_test
