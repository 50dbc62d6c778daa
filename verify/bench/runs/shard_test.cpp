// The parts of a sweep that processes share: whose a checkpoint is, what a part does without the others, and their locks.

#include "bench/runs/shard.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <atomic>
#include <chrono>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "bench/runs/checkpoint.hpp"
#include "bench/runs/machine_lock.hpp"
#include "solver/base/lock_file.hpp"
#include "solver/base/temporary.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::shard_test {
namespace {

namespace fs = std::filesystem;
using namespace bench;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

const results::Provenance facts{{"program_hash", "1", ""}, {"cpu", "x", ""}, {"sweep", "a", ""}};

TEST(Shard, IsNamedByItsNumberAndTheirCount) {
  const auto share = share_named("2/5");
  ASSERT_TRUE(share.has_value());
  EXPECT_EQ(to_string(*share), "2/5");
  EXPECT_EQ(shard_file("a/b.h5", *share), "a/b.h5.shard-2-of-5");
  for (const char* text :
       {"", "1", "1/", "/2", "0/2", "3/2", "-1/2", "1/2 ", " 1/2", "1/10001", "1/2/3", "1.0/2", "1/99999999999"})
    EXPECT_FALSE(share_named(text).has_value()) << text;
}

TEST(Shard, OfACheckpointDependsOnItsKeyAlone) {
  // So that processes of all versions agree; and every shard has some of what is to be done.
  EXPECT_THAT((std::array{shard_of("a", 4), shard_of("d", 4), shard_of("f", 4), shard_of("k", 4)}), ElementsAre(4, 3, 3, 2));
  std::map<int, int> counts;
  for (int k = 0; k < 1000; ++k) ++counts[shard_of(fmt::format("group 0: hung-edge bdf2 h = {}", k), 4)];
  for (const int number : {1, 2, 3, 4}) EXPECT_NEAR(counts[number], 250, 50);
}

/// A sweep of two parts of three rows, and what each part makes of its rows. Returns the sum, and adds what it computed.
int sweep(Checkpoint& checkpoint, std::vector<std::string>& computed) {
  int sum = 0;
  checkpoint.each(std::array{"a", "b"}, [&](const std::string& part) {
    checkpoint.begin(part);
    int of_part = 0;
    checkpoint.each(std::array{1, 2, 3}, [&](int row) {
      const auto compute = [&](int value) {
        computed.push_back(fmt::format("{} {} {}", part, row, value));
        return value;
      };
      const int first = checkpoint.once(fmt::format("row {}", row), [&] { return compute(row); });
      of_part += checkpoint.once(fmt::format("square {}", row), [&] { return compute(first * first); });
    });
    sum += checkpoint.timed("sum", [&] {
      computed.push_back(part + " sum");
      return of_part;
    });
  });
  return sum;
}

struct Place {
  base::TemporaryFolder folder;
  fs::path out = folder / "a.h5";

  /// A shard, as far as it comes in one go; -1 where it waits for others.
  int compute(const Share& share, std::vector<std::string>& computed) const {
    results::Journal journal(shard_file(out, share), facts, results::Start::resumed);
    Shards shards(share, checkpoints_beside(out, share, facts));
    MachineLock machine;
    Checkpoint checkpoint(journal, 1, &shards, &machine);
    try {
      return sweep(checkpoint, computed);
    } catch (const ComputedElsewhere&) {
      EXPECT_FALSE(shards.missing().empty());
      for (const auto& [id, number] : shards.missing()) EXPECT_NE(number, share.number) << id;
      return -1;
    }
  }
};

TEST(Shard, ComputesItsOwnOnceAndAllTogetherEverything) {
  for (const int count : {1, 2, 3, 5}) {
    SCOPED_TRACE(count);
    const Place place;
    std::vector<std::string> computed;
    int sum = -1;
    for (int round = 0; round < 3; ++round)
      for (int number = 1; number <= count; ++number) sum = place.compute({number, count}, computed);
    EXPECT_EQ(sum, 28);
    EXPECT_THAT(computed, UnorderedElementsAre("a 1 1", "a 1 1", "a 2 2", "a 2 4", "a 3 3", "a 3 9", "a sum", "b 1 1", "b 1 1",
                                               "b 2 2", "b 2 4", "b 3 3", "b 3 9", "b sum"));
  }
}

TEST(Shard, KeepsTogetherWhatDependsOnEachOther) {
  const Place place;
  int busy = 0;
  for (const int number : {1, 2, 3}) {
    std::vector<std::string> computed;
    place.compute({number, 3}, computed);
    busy += computed.empty() ? 0 : 1;
    for (const char* part : {"a", "b"})
      for (const int row : {1, 2, 3}) {
        const auto has = [&](int value) {
          return std::ranges::count(computed, fmt::format("{} {} {}", part, row, value)) >= (row == 1 ? 2 : 1);
        };
        EXPECT_EQ(has(row), has(row * row));
      }
  }
  EXPECT_GE(busy, 2) << "rows are shared";
}

TEST(Shard, IsNotContinuedFromJournalsOfAnotherProgram) {
  const Place place;
  const results::Provenance others{{"program_hash", "2", ""}, {"cpu", "x", ""}, {"sweep", "a", ""}};
  results::Journal(shard_file(place.out, {2, 2}), others, results::Start::fresh).add("x", {1});
  try {
    checkpoints_beside(place.out, {1, 2}, facts);
    ADD_FAILURE();
  } catch (const base::FileError& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("a.h5.shard-2-of-2.journal: cannot be merged: it was written by another program"));
  }
}

TEST(MachineLock, LetsTimesBeMeasuredAlone) {
  std::atomic<int> inside = 0;
  std::atomic<bool> disturbed = false;
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([&] {
      MachineLock lock;
      for (int turn = 0; turn < 3; ++turn) {
        ++inside;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        --inside;
        lock.alone();
        disturbed = disturbed || inside != 0;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        disturbed = disturbed || inside != 0;
        lock.beside_others();
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_FALSE(disturbed);
}

TEST(LockFile, IsHeldByOneAtATimeAndThenGone) {
  const base::TemporaryFolder folder;
  {
    base::LockFile first(folder / "lock");
    ASSERT_TRUE(first.try_lock());
    base::LockFile second(folder / "lock");
    EXPECT_FALSE(second.try_lock());
  }
  EXPECT_FALSE(fs::exists(folder / "lock"));
  EXPECT_TRUE(base::LockFile(folder / "lock").try_lock());
  EXPECT_TRUE(base::LockFile(folder / "missing" / "lock").try_lock()) << "where nothing can be locked nothing is waited for";
}

}  // namespace
}  // namespace drape::verify::shard_test
