// The journal of a sweep: what was finished is found again, whatever happened to the process that wrote it.

#include "results/file/journal.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>

#include "results/file/journal.hpp"
#include "solver/base/temporary.hpp"
#include "verify/support/file_size_limit.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::journal_test {
namespace {

namespace fs = std::filesystem;
using namespace results;
using testing::AllOf;
using testing::HasSubstr;
using testing::Pointee;
using Bytes = Journal::Bytes;

const Provenance ours{{"program_hash", "1", ""}, {"sweep", "a", ""}, {"started", "now", ""}};

/// A file to be, and its journal.
struct Place {
  base::TemporaryFolder folder;
  fs::path file = folder / "runs.h5", journal = folder / "runs.h5.journal";

  Journal open(Start start = Start::resumed, const Provenance& facts = ours) const { return {file, facts, start}; }
};

template <class Action>
std::string complaint(const Action& action) {
  try {
    action();
  } catch (const base::FileError& error) {
    return error.what();
  }
  return "";
}

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Leaves a journal of three checkpoints of very different sizes.
void write_three(const Place& place) {
  Journal journal = place.open(Start::fresh);
  journal.add("first", {1, 2, 3});
  journal.add("empty", {});
  journal.add("large", Bytes(1000, 7));
}

TEST(Journal, RemembersWhatEarlierProcessesFinished) {
  const Place place;
  write_three(place);
  {
    Journal journal = place.open();
    EXPECT_THAT(journal.find("first"), Pointee(Bytes{1, 2, 3}));
    EXPECT_THAT(journal.find("empty"), Pointee(Bytes{}));
    EXPECT_EQ(journal.find("other"), nullptr);
    journal.add("other", {4});
  }
  const Journal journal = place.open();
  EXPECT_THAT(journal.find("other"), Pointee(Bytes{4}));
  EXPECT_THAT(journal.find("large"), Pointee(Bytes(1000, 7)));
}

TEST(Journal, CutsOffWhatAKillLeftIncomplete) {
  const Place place;
  write_three(place);
  const std::string whole = content(place.journal);
  const auto two = whole.size() - 1000;
  for (std::size_t size = 0; size < whole.size(); size += size + 20 < two ? 1 : 97) {
    std::ofstream(place.journal, std::ios::binary) << whole.substr(0, size);
    std::size_t found = 0;
    {
      Journal journal = place.open();
      for (const char* id : {"first", "empty", "large"}) found += journal.find(id) != nullptr;
      EXPECT_EQ(journal.find("large"), nullptr);
      EXPECT_TRUE(journal.find("first") != nullptr || journal.find("empty") == nullptr);
      journal.add("next", {5});
    }
    const Journal again = place.open();
    EXPECT_THAT(again.find("next"), Pointee(Bytes{5})) << "cut to " << size;
    EXPECT_EQ(again.find("first") != nullptr, found > 0);
  }
}

TEST(Journal, LetsOnlyOneProcessRecord) {
  const Place place;
  const Journal first = place.open(Start::fresh);
  for (const Start start : {Start::fresh, Start::resumed})
    EXPECT_THAT(complaint([&] { place.open(start); }), AllOf(HasSubstr("runs.h5: another process"), HasSubstr("--out")));
}

TEST(Journal, IsGoneWhenThereIsNothingInIt) {
  const Place place;
  { const Journal journal = place.open(); }
  EXPECT_FALSE(fs::exists(place.journal));
  write_three(place);
  EXPECT_TRUE(fs::exists(place.journal));
  place.open().clear();
  EXPECT_FALSE(fs::exists(place.journal));
}

TEST(Journal, RefusesWhatIsNotItsOwn) {
  const Place place;
  write_three(place);
  const std::string whole = content(place.journal);
  EXPECT_THAT(complaint([&] { place.open(Start::fresh); }), AllOf(HasSubstr("runs.h5.journal"), HasSubstr("--resume")));
  const Provenance other_program{{"program_hash", "2", ""}, {"sweep", "a", ""}},
      other_sweep{{"program_hash", "1", ""}, {"sweep", "b", ""}};
  EXPECT_THAT(complaint([&] { place.open(Start::resumed, other_program); }), HasSubstr("program_hash is 1 there and 2 here"));
  EXPECT_THAT(complaint([&] { place.open(Start::resumed, other_sweep); }), HasSubstr("something else"));
  EXPECT_EQ(content(place.journal), whole);
  std::ofstream(place.journal) << "a user's notes";
  EXPECT_THAT(complaint([&] { place.open(); }), HasSubstr("runs.h5.journal: is not a journal"));
  EXPECT_EQ(content(place.journal), "a user's notes");
}

TEST(Journal, AFullDiskLosesOnlyTheLastCheckpoint) {
  const Place place;
  {
    Journal journal = place.open(Start::fresh);
    journal.add("first", {1});
    const FileSizeLimit full_disk(300);
    EXPECT_THAT(complaint([&] { journal.add("lost", Bytes(1000, 7)); }), HasSubstr("runs.h5.journal: cannot be written"));
    EXPECT_EQ(journal.find("lost"), nullptr);
    journal.add("second", {2});
  }
  const Journal journal = place.open();
  EXPECT_THAT(journal.find("first"), Pointee(Bytes{1}));
  EXPECT_THAT(journal.find("second"), Pointee(Bytes{2}));
  EXPECT_EQ(journal.find("lost"), nullptr);
}

TEST(Journal, RemovesWhatKilledProcessesLeftInItsFolderButNothingElse) {
  const Place place;
  const base::Temporary of_the_living(place.folder.path(), base::Temporary::Kind::file);
  for (const char* left : {".drape-tmp-1-0", ".drape-tmp-123456-7"}) std::ofstream(place.folder / left) << "x";
  fs::create_directories(place.folder / ".drape-tmp-5-0" / "new");
  for (const char* others : {"runs.h5.tmp-123", ".drape-tmp-backup", "drape-tmp-1-0"})
    std::ofstream(place.folder / others) << "x";
  const Journal journal = place.open();
  for (const char* left : {".drape-tmp-1-0", ".drape-tmp-123456-7", ".drape-tmp-5-0"})
    EXPECT_FALSE(fs::exists(place.folder / left)) << left;
  for (const char* others : {"runs.h5.tmp-123", ".drape-tmp-backup", "drape-tmp-1-0"})
    EXPECT_TRUE(fs::exists(place.folder / others)) << others;
  EXPECT_TRUE(fs::exists(of_the_living.path()));
}

TEST(Journal, ThatIsNoRegularFileIsRefused) {
  const Place pipe, device;
  ASSERT_EQ(mkfifo(pipe.journal.c_str(), 0666), 0);
  fs::create_symlink("/dev/zero", device.journal);
  for (const Place* place : {&pipe, &device})
    EXPECT_THAT(complaint([&] { place->open(); }), HasSubstr("runs.h5.journal: is a device or pipe"));
}

TEST(Journal, OfDeeplyNestedListsIsNoJournal) {
  const Place place;
  std::ofstream(place.journal) << std::string(10'000'000, '\x81');
  EXPECT_THAT(complaint([&] { place.open(); }), HasSubstr("runs.h5.journal: is not a journal"));
}

}  // namespace
}  // namespace drape::verify::journal_test
