// Sweeps in shards: the merged file is that of one process except for times, whatever is killed; what does not belong together
// is refused, and what is missing is named.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "bench/commands/shell_words.hpp"
#include "bench/runs/shard.hpp"
#include "results/file/run_file.hpp"
#include "results/file/validate.hpp"
#include "verify/support/all_but_times.hpp"
#include "verify/support/bench_integrators.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::merge_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

/// Six runs of 25 particles, timed and compared with their reference, with their motions.
const Words small_sweep{"run",
                        "--scene",
                        "hung-edge",
                        "--set",
                        "grid.n=5",
                        "--set",
                        "material.damping=5",
                        "--until",
                        "0.05",
                        "--method",
                        "bdf2,sbdf2",
                        "--step",
                        "0.01,0.005,0.002",
                        "--repeat",
                        "2",
                        "--trajectory",
                        "every=0.01"};

/// Three tables without times.
const Words small_study{"study", "modes", "--quick", "--method", "bdf2,sbdf2,midpoint"};

Words shard_of_sweep(const Words& sweep, int number, int count) {
  return sweep + Words{"--out", "a.h5", "--shard", fmt::format("{}/{}", number, count)};
}

std::string journal(int number, int count) { return fmt::format("a.h5.shard-{}-of-{}.journal", number, count); }

Words merge_of(int count) {
  Words words{"merge", "a.h5"};
  for (int number = 1; number <= count; ++number) words.push_back(journal(number, count));
  return words;
}

/// Computes all shards, one after the other, until they are complete. Returns the number of rounds.
int compute_all(const BenchIntegrators& program, const Words& sweep, int count) {
  for (int round = 1; round <= 5; ++round) {
    std::string said;
    for (int number = 1; number <= count; ++number) said = program.output(shard_of_sweep(sweep, number, count));
    if (said.find("all shards are complete") != std::string::npos) return round;
  }
  return 0;
}

void expect_merges_to_the_same(const Words& sweep, int count) {
  const BenchIntegrators program;
  const std::string shown = program.output(sweep + Words{"--out", "whole.h5"});
  EXPECT_THAT(compute_all(program, sweep, count), AllOf(testing::Ge(1), testing::Le(3)));
  const std::string merged = program.output(merge_of(count));
  EXPECT_EQ(all_but_times(program.folder() / "a.h5"), all_but_times(program.folder() / "whole.h5"));
  EXPECT_THAT(results::validate(program.folder() / "a.h5"), IsEmpty());
  EXPECT_EQ(value_of(results::read_provenance(program.folder() / "a.h5"), "command_line"),
            "bench_integrators " + joined(sweep, " ") + " --out a.h5");
  EXPECT_EQ(lines(merged).size(), lines(shown).size());
  EXPECT_FALSE(fs::exists(program.folder() / "a.h5.journal"));
}

TEST(Merge, OfASweepIsTheFileOfOneProcess) { expect_merges_to_the_same(small_sweep, 3); }

TEST(Merge, OfAStudyIsTheFileOfOneProcess) {
  DRAPE_SLOW();
  expect_merges_to_the_same(small_study, 4);
}

TEST(Merge, OfKilledShardsThatWereContinuedIsTheFileOfOneProcess) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  program.output(small_study + Words{"--out", "whole.h5"});
  std::mt19937 random(1);
  int killed = 0;
  for (int k = 0; killed < 10 && k < 100; ++k) {
    RunningProgram running(program.command(shard_of_sweep(small_study, 1 + k % 2, 2)));
    std::this_thread::sleep_for(std::chrono::duration<double>(std::uniform_real_distribution(0.0, 0.15)(random)));
    running.send(SIGKILL);
    const ProgramResult result = running.wait();
    EXPECT_THAT(result.err, IsEmpty());
    killed += result.exit_code == 128 + SIGKILL;
  }
  EXPECT_GE(compute_all(program, small_study, 2), 1);
  program.output(merge_of(2));
  EXPECT_EQ(all_but_times(program.folder() / "a.h5"), all_but_times(program.folder() / "whole.h5"));
}

/// What it says; the same files are there afterwards.
std::string refusal(const BenchIntegrators& program, const Words& arguments, int exit_code) {
  const auto before = program.files();
  const ProgramResult result = program.run(arguments);
  EXPECT_EQ(result.exit_code, exit_code);
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_TRUE(program.files() == before);
  return result.err;
}

TEST(Merge, NamesWhatIsMissingAndWhoComputesIt) {
  const BenchIntegrators program;
  program.output(shard_of_sweep(small_study, 1, 3));
  program.output(shard_of_sweep(small_study, 3, 3));
  const Words some{"merge", "a.h5", journal(1, 3), journal(3, 3)};
  EXPECT_THAT(refusal(program, some, 1), AllOf(HasSubstr("a.h5: not yet recorded: shards 2 of 3 lack "),
                                               HasSubstr("' of shard 2"), HasSubstr("--shard i/3")));
  EXPECT_FALSE(fs::exists(program.folder() / "a.h5"));
  program.output(shard_of_sweep(small_study, 2, 3));
  program.output(merge_of(3));
  EXPECT_THAT(refusal(program, merge_of(3), 2), HasSubstr("a.h5: is recorded already"));
  EXPECT_THAT(refusal(program, shard_of_sweep(small_study, 1, 3), 2), HasSubstr("a.h5"));
}

/// Writes a journal like another one, where `change` has changed the facts of its origin and its checkpoints.
void forge(const BenchIntegrators& program, const std::string& from, const std::string& to, const std::string& fact,
           const std::string& value, const auto& change) {
  const fs::path path = program.folder() / from;
  auto [lasting, entries] = results::read_journal(path);
  results::Provenance origin = bench::origin_of(path);
  const auto share = bench::share_named(value_of(origin, "shard"));
  std::erase_if(origin, [](const results::Fact& one) { return one.name == "shard"; });
  for (results::Provenance* facts : {&lasting, &origin})
    for (results::Fact& one : *facts)
      if (one.name == fact) one.value = value;
  change(entries);
  fs::remove(program.folder() / to);
  entries.insert_or_assign(bench::origin_id, bench::origin(origin, *share));
  std::string file = to;
  file.erase(file.size() - std::string(".journal").size());
  results::Journal forged(program.folder() / file, lasting, results::Start::fresh);
  for (const auto& [id, bytes] : entries) forged.add(id, bytes);
}

const auto nothing = [](const auto&) {};

TEST(Merge, RefusesShardsOfDifferentSweepsProgramsAndDivisions) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  ASSERT_GE(compute_all(program, small_study, 2), 1);
  for (const char* fact : {"git_commit", "compile_flags", "program_hash"}) {
    forge(program, journal(2, 2), "b.journal", fact, "another", nothing);
    EXPECT_THAT(refusal(program, {"merge", "a.h5", journal(1, 2), "b.journal"}, 2),
                AllOf(HasSubstr("b.journal: cannot be merged"), HasSubstr(fmt::format("{} is another there", fact))));
  }
  forge(program, journal(2, 2), "b.journal", "sweep", "another", nothing);
  EXPECT_THAT(refusal(program, {"merge", "a.h5", journal(1, 2), "b.journal"}, 2),
              AllOf(HasSubstr("b.journal: cannot be merged"), HasSubstr("something else")));
  program.output(shard_of_sweep(small_study, 1, 3));
  EXPECT_THAT(refusal(program, {"merge", "a.h5", journal(1, 2), journal(1, 3)}, 2),
              AllOf(HasSubstr("it is shard 1/3"), HasSubstr("expected the same number of shards")));
  program.write("notes.txt", "a user's notes");
  EXPECT_THAT(refusal(program, {"merge", "a.h5", "notes.txt"}, 2), HasSubstr("notes.txt: is not a journal"));
  EXPECT_THAT(refusal(program, {"merge", "a.h5", "missing"}, 2), HasSubstr("missing"));
}

TEST(Merge, RefusesCheckpointsThatAreThereTwiceWithDifferentResults) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  ASSERT_GE(compute_all(program, small_study, 2), 1);
  std::string id;
  forge(program, journal(2, 2), "again.journal", "", "", [&](auto& entries) {
    auto one = entries.begin();
    while (one->first == bench::origin_id) ++one;
    id = one->first;
    one->second.back() ^= 1;
  });
  const Words twice{"merge", "a.h5", journal(1, 2), journal(2, 2), "again.journal"};
  EXPECT_THAT(refusal(program, twice, 2), AllOf(HasSubstr("1 checkpoints are there twice with different results"),
                                                HasSubstr(fmt::format("'{}' in {} and again.journal", id, journal(2, 2)))));
  forge(program, journal(2, 2), "again.journal", "", "", nothing);
  program.output(twice);  // equal results are one
}

TEST(Merge, TakesShardsOfSeveralMachinesUnlessThereAreTimes) {
  DRAPE_SLOW();
  const BenchIntegrators study, timed;
  ASSERT_GE(compute_all(study, small_study, 2), 1);
  forge(study, journal(2, 2), "b.journal", "cpu", "Z80", nothing);
  study.output({"merge", "a.h5", journal(1, 2), "b.journal"});
  EXPECT_THAT(value_of(results::read_provenance(study.folder() / "a.h5"), "cpu"), testing::EndsWith("; Z80"));
  ASSERT_GE(compute_all(timed, small_sweep, 2), 1);
  forge(timed, journal(2, 2), "b.journal", "cpu", "Z80", nothing);
  EXPECT_THAT(refusal(timed, {"merge", "a.h5", journal(1, 2), "b.journal"}, 2),
              AllOf(HasSubstr("a.h5: cannot be recorded: shards have times of different machines"), HasSubstr("Z80")));
}

TEST(Merge, RefusesShardsThatAreNone) {
  const BenchIntegrators program;
  for (const char* share : {"0/2", "3/2", "x", "1/0", ""})
    EXPECT_THAT(refusal(program, small_study + Words{"--out", "a.h5", "--shard", share}, 2),
                AllOf(HasSubstr("--shard"), HasSubstr("i/n")))
        << share;
  EXPECT_THAT(refusal(program, small_study + Words{"--shard", "1/2"}, 2), HasSubstr("--out"));
  EXPECT_THAT(refusal(program, small_sweep + Words{"--shard", "1/2", "--out", "a.h5", "--report", "page"}, 2),
              HasSubstr("--report"));
  EXPECT_THAT(refusal(program, small_sweep + Words{"--shard", "1/2", "--out", "a.h5", "--frames", "page"}, 2),
              HasSubstr("--frames"));
}

TEST(ShellWords, AreThoseThatWereWritten) {
  const Words words{"study", "two words", "it's", "", "a\\b", "'", "grid.n=5", "\n"};
  Words written;
  for (const std::string& word : words) written.push_back(bench::shell_word(word));
  EXPECT_EQ(bench::shell_words(joined(written, " ")), words);
}

}  // namespace
}  // namespace drape::verify::merge_test
