// Sweeps that are killed, interrupted or too large: nothing that was finished is lost, and the resumed file is the one that an
// uninterrupted sweep writes, except for times.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "results/file/journal.hpp"
#include "results/file/run_file.hpp"
#include "results/file/validate.hpp"
#include "solver/methods.hpp"
#include "verify/support/all_but_times.hpp"
#include "verify/support/bench_integrators.hpp"
#include "verify/support/record_text.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::resume_test {
namespace {

using std::chrono::duration;
using std::chrono::steady_clock;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

/// Six cells, 25 particles each, with their motions.
const Words small_sweep{"run",  "--scene",        "hung-edge",    "--set",     "grid.n=5",         "--until",
                        "0.05", "--method",       "bdf2,sbdf2",   "--step",    "0.01,0.005,0.002", "--repeat",
                        "2",    "--no-reference", "--trajectory", "every=0.01"};

/// Three tables, each row a checkpoint.
const Words small_study{"study", "modes", "--quick"};

/// Kills a sweep repeatedly at random moments, resuming it in between, starting again whenever it is finished. In the end it
/// is finished once more.
void kill_and_resume(const Words& sweep, int kills, std::mt19937& random) {
  const BenchIntegrators program;
  const auto begin = steady_clock::now();
  program.output(sweep + Words{"--out", "whole.h5"});
  const double seconds = duration<double>(steady_clock::now() - begin).count();
  const std::string expected = all_but_times(program.folder() / "whole.h5");
  const std::size_t whole = 2 * program.files().size();  // with what is written beside an HDF5 file
  const Words resumed = sweep + Words{"--out", "killed.h5", "--resume"};
  for (bool finished = false; kills > 0 || !finished;) {
    RunningProgram running(program.command(resumed));
    if (kills > 0) {
      std::this_thread::sleep_for(duration<double>(std::uniform_real_distribution(0.0, 0.5 * seconds)(random)));
      running.send(SIGKILL);
    }
    const ProgramResult result = running.wait();
    EXPECT_THAT(result.err, IsEmpty());
    kills -= result.exit_code == 128 + SIGKILL;
    finished = result.exit_code == 0;
    if (!finished) continue;
    EXPECT_EQ(all_but_times(program.folder() / "killed.h5"), expected);
    EXPECT_THAT(results::validate(program.folder() / "killed.h5"), IsEmpty());
    EXPECT_THAT(program.files(), SizeIs(whole)) << "journals and temporary files are gone";
    for (const auto& [name, content] : program.files())
      if (name.starts_with("killed")) std::filesystem::remove(program.folder() / name);
  }
}

#ifdef DRAPE_SANITIZE
constexpr int kills_of_each = 5;  // each start takes half a second
#else
constexpr int kills_of_each = 25;
#endif

TEST(Resume, ARunKilledAtAnyMomentEndsAsIfItHadNotBeen) {
  std::mt19937 random(1);
  kill_and_resume(small_sweep, kills_of_each, random);
}

TEST(Resume, AStudyKilledAtAnyMomentEndsAsIfItHadNotBeen) {
  DRAPE_SLOW();
  std::mt19937 random(2);
  kill_and_resume(small_study, kills_of_each, random);
}

TEST(Resume, TakesWhatTheJournalHasAndComputesTheRest) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  program.output(small_study + Words{"--out", "whole.h5"});
  const auto none = nlohmann::json::array();
  const nlohmann::json row{{"method", "bdf2"},
                           {"share", 1.0},
                           {"limit", {42.5}},
                           {"bound", none},
                           {"verdict", {{"standing", 1}, {"detail", "planted"}}}};
  results::Journal(program.folder() / "a.h5", results::read_provenance(program.folder() / "whole.h5"), results::Start::fresh)
      .add("stability: bdf2 1", nlohmann::json::to_cbor(row));
  const std::string out = program.output(small_study + Words{"--out", "a.h5", "--resume", "--format", "csv"});
  EXPECT_THAT(lines(out), Contains(HasSubstr("42.5")).Times(1));
  const auto rows = [&](const char* file) {
    return results::read_tables(program.folder() / file).back().columns.front().cells.size();
  };
  EXPECT_EQ(rows("a.h5"), rows("whole.h5"));
}

TEST(Resume, WithoutAFileBeginsIt) {
  const BenchIntegrators program;
  program.output(small_sweep + Words{"--out", "a.h5", "--resume"});
  EXPECT_THAT(results::read_runs(program.folder() / "a.h5"), SizeIs(6));
}

/// What it says, with the exit code of bad input, about the same file afterwards.
std::string refusal(const BenchIntegrators& program, const Words& arguments) {
  const auto before = program.files();
  const ProgramResult result = program.run(arguments);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_EQ(program.files(), before);
  return result.err;
}

TEST(Resume, AFinishedSweepIsOnlyShown) {
  const BenchIntegrators program;
  const Words sweep = small_sweep + Words{"--out", "a.h5", "--format", "csv"};
  const std::string shown = program.output(sweep);
  const auto before = program.files();
  EXPECT_EQ(program.output(sweep + Words{"--resume"}), shown);
  EXPECT_EQ(program.files(), before);
}

TEST(Resume, IsRefusedForAnotherSweepAndForFilesThatAreNone) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  program.output(small_sweep + Words{"--out", "a.h5"});
  EXPECT_THAT(refusal(program, small_study + Words{"--out", "a.h5", "--resume"}),
              AllOf(HasSubstr("a.h5: cannot be continued"), HasSubstr("something else"), HasSubstr("--out")));
  EXPECT_THAT(refusal(program, small_sweep + Words{"--out", "a.h5", "--resume", "--time-limit", "9"}),
              HasSubstr("something else"));
  program.write("text.h5", "a user's results");
  EXPECT_THAT(refusal(program, small_sweep + Words{"--out", "text.h5", "--resume"}), HasSubstr("text.h5: "));
  std::filesystem::resize_file(program.folder() / "a.h5", std::filesystem::file_size(program.folder() / "a.h5") / 2);
  EXPECT_THAT(refusal(program, small_sweep + Words{"--out", "a.h5", "--resume"}),
              AllOf(HasSubstr("a.h5: "), HasSubstr("truncated")));
}

// --- Two processes, and interruptions ------------------------------------------------------------------------------------

/// Waits for a file at most a minute.
bool appears(const std::filesystem::path& file) {
  for (int k = 0; k < 60'000 && !std::filesystem::exists(file); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return std::filesystem::exists(file);
}

/// Four groups of runs.
const Words large_sweep{"study", "hung-sheets", "--quick", "--repeat", "1", "--no-reference", "--out", "a.h5"};

TEST(Sweep, RefusesASecondProcessAndEndsWithWhatIsDone) {
  DRAPE_SLOW();
  const std::size_t group = 6 + solver::methods().size();
  const BenchIntegrators program;
  RunningProgram first(program.command(large_sweep));
  ASSERT_TRUE(appears(program.folder() / "a.h5")) << "with the first group";
  const ProgramResult second = program.run(large_sweep + Words{"--resume"});
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_THAT(second.err, HasSubstr("a.h5: another process is recording in it"));

  first.send(SIGTERM);
  const ProgramResult interrupted = first.wait();
  EXPECT_EQ(interrupted.exit_code, 128 + SIGTERM);
  EXPECT_THAT(interrupted.out, IsEmpty());
  EXPECT_THAT(lines(interrupted.err), SizeIs(1));
  EXPECT_THAT(interrupted.err, AllOf(HasSubstr("SIGTERM"), HasSubstr("--resume --out a.h5")));
  const auto runs = results::read_runs(program.folder() / "a.h5");
  EXPECT_GE(runs.size(), group);
  EXPECT_EQ(runs.size() % group, 0);
  EXPECT_THAT(results::validate(program.folder() / "a.h5"), IsEmpty());

  program.output(large_sweep + Words{"--resume"});
  const auto all = results::read_runs(program.folder() / "a.h5");
  EXPECT_EQ(all.size(), 4 * group);
  for (std::size_t k = 0; k < runs.size(); ++k) EXPECT_EQ(as_text(all[k]), as_text(runs[k])) << "not run again: equal times";
}

TEST(Sweep, InterruptedBeforeAnythingIsDoneLeavesNothing) {
  const BenchIntegrators program;
  const Words hanging{"run",    "--scene", "hung-edge", "--until", "1000", "--method",
                      "verlet", "--step",  "0.01",      "--out",   "a.h5", "--no-reference"};
  RunningProgram running(program.command(hanging));
  ASSERT_TRUE(appears(program.folder() / "a.h5.journal"));
  running.send(SIGINT);
  const ProgramResult interrupted = running.wait();
  EXPECT_EQ(interrupted.exit_code, 128 + SIGINT);
  EXPECT_THAT(interrupted.err, HasSubstr("nothing is recorded"));
  EXPECT_THAT(program.files(), IsEmpty());
}

// --- Limits --------------------------------------------------------------------------------------------------------------

/// Cells of a sheet that are beyond a limit, and one that is not.
std::vector<Row> limited(const Words& options) {
  const BenchIntegrators program;
  const Words command = Words{"run", "--method", "sbdf2", "--repeat", "1", "--no-reference", "--out", "a.h5"} + options;
  const std::vector<Row> rows = parse_csv(program.output(command + Words{"--format", "csv"}));
  EXPECT_THAT(results::validate(program.folder() / "a.h5"), IsEmpty());
  return rows;
}

TEST(Limits, OfTimeMakesAHangingCellAResult) {
  const auto rows = limited({"--scene", "hung-edge", "--until", "500", "--step", "100,0.0001", "--time-limit", "0.2"});
  ASSERT_THAT(rows, SizeIs(2));
  EXPECT_THAT(rows[0].at("outcome"), Not(testing::AnyOf("out of time", "")));
  EXPECT_EQ(rows[1].at("outcome"), "out of time");
  EXPECT_EQ(rows[1].at("message"), "longer than 0.2 s");
  EXPECT_EQ(rows[1].at("wall_ms_median"), "") << "it is not repeated";
  EXPECT_GT(number(rows[1], "steps"), 0);
  EXPECT_NEAR(number(rows[1], "last_good_time"), 0.0001 * number(rows[1], "steps"), 1e-9);
}

#ifndef DRAPE_SANITIZE  // AddressSanitizer ends a program that has no memory
TEST(Limits, OfMemoryMakesAHugeCellAResult) {
  const Words tiny{"--scene", "hung-edge", "--until", "0.01", "--step", "0.01", "--memory-limit", "20"};
  EXPECT_EQ(limited(tiny + Words{"--set", "grid.n=500"}).at(0).at("outcome"), "out of memory");
  EXPECT_EQ(limited(tiny + Words{"--set", "grid.n=5"}).at(0).at("outcome"), "success");
}
#endif

}  // namespace
}  // namespace drape::verify::resume_test
