// bench_integrators run: what it prints and records, as the programs that call it see it.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "bench/runs/record.hpp"
#include "bench/runs/timing.hpp"
#include "model/scene_file/scene_file.hpp"
#include "verify/support/bench_integrators.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::program_run_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::Ge;
using testing::Gt;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Le;
using testing::Lt;
using testing::MatchesRegex;
using testing::Not;
using testing::Pair;
using testing::SizeIs;

/// 25 particles for 0.05 s.
const Words tiny{"run", "--scene", "hung-edge", "--set", "grid.n=5", "--until", "0.05"};
const Words one_run = tiny + Words{"--method", "bdf2", "--step", "0.01"};

/// bdf2 cannot converge, verlet does not care.
const Words stalled =
    tiny + Words{"--method", "bdf2,verlet", "--step", "0.01", "--max-updates", "1", "--loop-tolerance", "1e-12"};

/// Damping that these methods treat explicitly, far beyond their limit: they grow until they overflow.
const Words unstable{"run",
                     "--scene",
                     "hung-edge",
                     "--set",
                     "grid.n=5",
                     "--set",
                     "material.damping_form=projected",
                     "--set",
                     "material.damping=5000",
                     "--method",
                     "sbdf2,imex-euler",
                     "--step",
                     "0.01"};

std::vector<Row> csv(const BenchIntegrators& program, const Words& arguments) {
  return parse_csv(program.output(arguments + Words{"--format", "csv"}));
}

Words names(const BenchIntegrators& program) {
  Words all;
  for (const auto& [name, content] : program.files()) all.push_back(name);
  return all;
}

/// What a Python script prints that finds the files, opened by another reader than ours, in `files`.
std::string h5py(const BenchIntegrators& program, const std::string& script, const Words& file_names) {
  const std::string opening = "import h5py, sys\nfiles = [h5py.File(name) for name in sys.argv[1:]]\n";
  Command python = program.command(Words{"-c", opening + script} + file_names);
  python.program = "/usr/bin/python3";
  const ProgramResult result = run_program(python);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.out;
}

// --- Output --------------------------------------------------------------------------------------------------------------

TEST(ProgramRun, PrintsARowOfCsvForEveryMethodAndStep) {
  const BenchIntegrators program;
  const std::vector<Row> rows = csv(program, tiny + Words{"--method", "sbdf2/cholesky,bdf2", "--step", "0.01,0.005"});
  Words order;
  for (const Row& row : rows) {
    order.push_back(row.at("method") + " " + row.at("step"));
    EXPECT_THAT(row, IsSupersetOf<Row::value_type>({{"scene", "hung-edge"}, {"outcome", "success"}, {"message", ""}}));
    EXPECT_EQ(row.at("reference"), "cvode-bdf + arkode-esdirk");
  }
  EXPECT_THAT(order, ElementsAre("sbdf2/cholesky 0.01", "sbdf2/cholesky 0.005", "bdf2 0.01", "bdf2 0.005"));
}

TEST(ProgramRun, PrintsSaneNumbers) {
  const BenchIntegrators program;
  const std::vector<Row> rows =
      csv(program, tiny + Words{"--method", "bdf2/fixed-point/ic0,sbdf2/ic0,verlet", "--step", "0.01,0.005"});
  ASSERT_THAT(rows, SizeIs(6));
  for (const Row& row : rows) {
    const std::string& method = row.at("method");
    const double steps = number(row, "steps"), updates = number(row, "updates");
    EXPECT_DOUBLE_EQ(steps * number(row, "step"), 0.05);
    EXPECT_EQ(updates > steps, method == "bdf2/fixed-point/ic0");
    EXPECT_EQ(updates == steps, method == "sbdf2/ic0");
    EXPECT_EQ(updates == 0, method == "verlet");
    EXPECT_EQ(number(row, "cg_iterations") > updates, method != "verlet");
    EXPECT_THAT(number(row, "wall_ms_min"), Gt(0));
    EXPECT_THAT(number(row, "wall_ms_median"), AllOf(Ge(number(row, "wall_ms_min")), Le(number(row, "wall_ms_max"))));
    EXPECT_THAT(number(row, "error_rms"), AllOf(Gt(0), Lt(0.01)));
    EXPECT_THAT(number(row, "reference_error"), AllOf(Gt(0), Lt(1e-6)));
  }
  EXPECT_THAT(number(rows[3], "error_rms"), Lt(number(rows[2], "error_rms") / 2)) << "sbdf2 with half the step";
}

TEST(ProgramRun, DividesErrorsByTheSizeOfTheScene) {
  const BenchIntegrators program;
  const std::vector<Row> rows = csv(program, tiny + Words{"--method", "imex-euler,verlet", "--step", "0.01",
                                                          "--verlet-fraction", "0.3", "--repeat", "1", "--out", "a.h5"});
  const double distance = std::stod(h5py(program,
                                         "x, y = [run['final_state/x'][:] for run in files[0]['runs'].values()]\n"
                                         "print(((x - y) ** 2).sum(axis=1).mean() ** 0.5)",
                                         {"a.h5"}));
  ASSERT_THAT(number(rows[1], "error_rms"), Lt(number(rows[0], "error_rms") / 100));
  EXPECT_NEAR(number(rows[0], "error_rms") * 0.8 / distance, 1, 0.01) << "the sides are 0.8 m long";
}

TEST(ProgramRun, PrintsTheSameAsJson) {
  const BenchIntegrators program;
  const Words command = tiny + Words{"--method", "bdf2,verlet", "--step", "0.01"};
  const auto json = nlohmann::json::parse(program.output(command + Words{"--format", "json"}));
  const std::vector<Row> rows = csv(program, command);
  ASSERT_THAT(json, SizeIs(2));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_THAT(json[i].at("wall_ms_median").get<double>(), Gt(0));
    for (const char* key : {"scene", "method", "outcome", "message", "reference"}) EXPECT_EQ(json[i].at(key), rows[i].at(key));
    for (const char* key : {"step", "steps", "updates", "cg_iterations", "error_rms", "reference_error"})
      EXPECT_EQ(json[i].at(key), number(rows[i], key)) << key;
  }
}

TEST(ProgramRun, PrintsATableForPeopleUnlessToldOtherwise) {
  const BenchIntegrators program;
  for (const Words& format : {Words{}, {"--format", "table"}}) {
    const std::string file = format.empty() ? "a.h5" : "b.h5";
    EXPECT_THAT(lines(program.output(one_run + format + Words{"--out", file})),
                AllOf(Contains(MatchesRegex("hung-edge +bdf2 +0\\.01 +5 .*")), Contains("recorded in " + file)));
  }
}

TEST(ProgramRun, MeasuresNoErrorsWithoutAReference) {
  const BenchIntegrators program;
  EXPECT_THAT(csv(program, one_run + Words{"--no-reference"}),
              ElementsAre(IsSupersetOf<Row::value_type>({{"error_rms", ""}, {"reference", ""}, {"reference_error", ""}})));
  EXPECT_FALSE(std::filesystem::exists(program.cache()));
}

TEST(ProgramRun, FailsIfItsOutputIsLost) {
  const BenchIntegrators program;
  Command command = program.command(one_run + Words{"--format", "csv"});
  command.output = "/dev/full";
  const ProgramResult result = run_program(command);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "bench_integrators: standard output: No space left on device\n");
}

TEST(ProgramRun, HandsEveryOptionToTheSolver) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  const Words command = tiny + Words{"--method", "bdf2/fixed-point/ic0,verlet,bdf2", "--step", "0.01"};
  const std::vector<Row> usual = csv(program, command);
  const auto with = [&](const Words& option) { return csv(program, command + option); };
  EXPECT_THAT(number(with({"--loop-tolerance", "1e-9"})[0], "updates"), Gt(number(usual[0], "updates")));
  EXPECT_THAT(number(with({"--cg-tolerance", "1e-9"})[0], "cg_iterations"), Gt(number(usual[0], "cg_iterations")));
  EXPECT_THAT(number(with({"--verlet-fraction", "0.1"})[1], "error_rms"), Lt(number(usual[1], "error_rms")));
  const Words loop = tiny + Words{"--method", "bdf2/fixed-point", "--step", "0.01"};
  EXPECT_THAT(csv(program, loop + Words{"--passes", "2"})[0], Contains(Row::value_type("updates", "10"))) << "in five steps";
  EXPECT_THAT(number(with({"--control", "0", "5"})[0], "steps"), Gt(number(usual[0], "steps")));
  EXPECT_THAT(number(with({"--stage-accuracy", "1e-6"})[2], "updates"), Gt(number(usual[2], "updates")));
  EXPECT_THAT(number(with({"--tolerance", "1e-7"})[2], "steps"), Gt(number(usual[2], "steps")));
}

// --- Scenes --------------------------------------------------------------------------------------------------------------

TEST(ProgramSet, OverridesTheKeysThatOtherProgramsUse) {
  const BenchIntegrators program;
  Words command = one_run + Words{"--out", "a.h5"};
  for (const char* set :
       {"grid.n=4", "material.tension=2000", "material.damping=5", "material.shear=30", "material.bend=0.001"})
    command = command + Words{"--set", set};
  program.output(command);
  EXPECT_THAT(lines(h5py(program, "print(files[0]['runs/000'].attrs['scene_toml'])", {"a.h5"})),
              IsSupersetOf({"grid.n = [4, 4]", "grid.size = [0.8, 0.8]", "material.tension = [2000, 2000]",
                            "material.damping = [5, 5]", "material.shear = 30", "material.bend = [0.001, 0.001]"}));
}

TEST(ProgramSet, ChangesTheMotionByEveryKey) {
  const BenchIntegrators program;
  Words files;
  for (const std::string set :
       {"grid.n=5", "grid.n=4", "material.tension=2000", "material.damping=5", "material.shear=30", "material.bend=0.001"}) {
    files.push_back(set + ".h5");
    program.output(one_run + Words{"--set", set, "--no-reference", "--out", files.back()});
  }
  EXPECT_EQ(h5py(program, "print(len({file['runs/000/final_state/x'][:].tobytes() for file in files}))", files), "6\n");
}

TEST(ProgramSet, TakesListsTheLastOneCountsAndAllAreRecorded) {
  const BenchIntegrators program;
  program.output(one_run + Words{"--set", "grid.n=[6, 4]", "--out", "a.h5"});
  EXPECT_EQ(h5py(program, "run = files[0]['runs/000']\nprint(len(run['final_state/x']), run.attrs['overrides'])", {"a.h5"}),
            "24 grid.n=5 grid.n=[6, 4]\n");
}

TEST(ProgramScene, MayBeAFileOfTheUser) {
  const BenchIntegrators program;
  program.write("flag.toml",
                "name = \"my flag\"\ngrid.n = [3, 5]\nmaterial.tension = 100\nforces.gravity = [0, 0, -9.81]\n"
                "pins = [{ where = \"upper edge\" }]\nend.time = 0.02\n");
  EXPECT_THAT(csv(program, {"run", "--scene", "flag.toml", "--method", "bdf2", "--step", "0.01", "--out", "a.h5"}),
              ElementsAre(IsSupersetOf<Row::value_type>({{"scene", "my flag"}, {"outcome", "success"}, {"steps", "2"}})));
  EXPECT_EQ(h5py(program, "print(len(files[0]['runs/000/final_state/x']))", {"a.h5"}), "15\n");
}

TEST(ProgramThreads, AreRecordedWhereTheSheetIsLargeEnoughForThem) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  for (const auto& [n, threads, file] : {std::tuple("5", "2", "a.h5"), {"200", "1", "b.h5"}, {"200", "2", "c.h5"}})
    program.output({"run", "--scene", "hung-edge", "--set", std::string("grid.n=") + n, "--method", "imex-euler/mic0", "--step",
                    "0.001", "--until", "0.001", "--threads", threads, "--no-reference", "--repeat", "1", "--out", file});
  const std::string script = "print([int(file['runs/000/parameters/threads'][()]) for file in files])";
  EXPECT_EQ(h5py(program, script, {"a.h5", "b.h5", "c.h5"}), "[1, 1, 2]\n");
}

// --- Failures are results ------------------------------------------------------------------------------------------------

TEST(ProgramFailure, IsARowWithReasonAndLastGoodTime) {
  const BenchIntegrators program;
  const std::vector<Row> rows = csv(program, stalled);
  ASSERT_THAT(rows, SizeIs(2));
  EXPECT_THAT(rows[0], IsSupersetOf<Row::value_type>({{"outcome", "not converged"}, {"last_good_time", "0"}, {"steps", "0"}}));
  EXPECT_THAT(rows[0], IsSupersetOf<Row::value_type>({{"error_rms", ""}, {"reference", ""}, {"reference_error", ""}}));
  EXPECT_THAT(rows[0].at("message"), HasSubstr("not converged after 1 updates"));
  EXPECT_THAT(rows[1], IsSupersetOf<Row::value_type>({{"outcome", "success"}, {"message", ""}, {"last_good_time", "0.05"}}));
  EXPECT_THAT(number(rows[1], "error_rms"), Gt(0));
}

TEST(ProgramFailure, HalfWayTellsHowFarItCame) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  const std::vector<Row> rows = csv(program, unstable);
  ASSERT_THAT(rows, SizeIs(2));
  for (const Row& row : rows) {
    EXPECT_EQ(row.at("outcome"), "unstable");
    EXPECT_THAT(row.at("message"), HasSubstr("its energy was"));
    EXPECT_EQ(row.at("error_rms"), "");
    EXPECT_THAT(number(row, "last_good_time"), AllOf(Gt(0), Lt(0.98)));
    EXPECT_NEAR(number(row, "last_good_time"), number(row, "steps") * 0.01, 1e-12);
  }
}

TEST(ProgramFailure, IsShownInEveryFormatAndRecorded) {
  const BenchIntegrators program;
  const auto json = nlohmann::json::parse(program.output(stalled + Words{"--format", "json"}));
  EXPECT_EQ(json.at(0).at("outcome"), "not converged");
  EXPECT_TRUE(json.at(0).at("error_rms").is_null());
  EXPECT_THAT(lines(program.output(stalled + Words{"--out", "a.h5"})), Contains(HasSubstr("not converged at 0 s")));
  EXPECT_EQ(h5py(program, "for run in files[0]['runs'].values(): print(run.attrs['outcome'], 'error' in run)", {"a.h5"}),
            "not converged False\nsuccess True\n");
}

TEST(ProgramFailure, IsTimedNoFurtherThanItCame) {
  const BenchIntegrators program;
  program.output(unstable + Words{"--repeat", "2", "--no-reference", "--out", "a.h5"});
  EXPECT_EQ(
      h5py(program, "for run in files[0]['runs'].values(): print(int(run['work/timed_steps'][()] - run['work/steps'][()]))",
           {"a.h5"}),
      "0\n0\n");
}

int steps_begun = 0;

/// Rests, until steps from the fourth on find no solution, however short they are.
void stall_in_the_fourth(solver::Step& step) {
  ++steps_begun;
  step.next.y = step.y0();
  step.result.outcome = step.t > 0.025 ? solver::Outcome::not_converged : solver::Outcome::success;
}

TEST(ProgramFailure, IsTimedWithTheStepThatFailed) {
  constexpr solver::Method stalling{.name = "stalling",
                                    .description = "for tests",
                                    .order = 1,
                                    .stages = solver::Method::Stages::none,
                                    .step = stall_in_the_fourth};
  const bench::Group group{{model::load_scene("chain"), "", &stalling, 0.01, {}}};
  const results::RunRecord run = bench::record(group.front());
  EXPECT_EQ(run.outcome, solver::Outcome::not_converged);
  EXPECT_THAT(run.steps, SizeIs(3));
  const int begun = std::exchange(steps_begun, 0);
  EXPECT_GT(begun, 3);
  bench::time_group(group, {bench::steps_to_time(run)}, 1, [] {});
  EXPECT_EQ(steps_begun, begun);
}

// --- The record ----------------------------------------------------------------------------------------------------------

TEST(ProgramRecord, IsTheFileThatOutNames) {
  const BenchIntegrators program;
  program.output(tiny + Words{"--method", "bdf2,sbdf2", "--step", "0.01,0.005", "--repeat", "4", "--out", "a.h5"});
  EXPECT_THAT(names(program), ElementsAre("a.h5"));
  EXPECT_EQ(
      h5py(program, "for run in files[0]['runs'].values(): print(run.attrs['method'], run['step'][()], len(run['times_ms']))",
           {"a.h5"}),
      "bdf2 0.01 4\nbdf2 0.005 4\nsbdf2 0.01 4\nsbdf2 0.005 4\n");
}

TEST(ProgramRecord, HasANameOfItsOwnByDefault) {
  const BenchIntegrators program;
  for (int k = 0; k < 3; ++k) program.output(one_run);
  const auto file = MatchesRegex("results/runs/....-..-..T..-..-..Z-run-[0-9]+\\.h5");
  EXPECT_THAT(names(program), ElementsAre("results/", "results/runs/", file, file, file));
}

// --- Repeating -----------------------------------------------------------------------------------------------------------

/// The rows without their times.
std::vector<Row> timeless(std::vector<Row> rows) {
  for (Row& row : rows)
    for (const char* time : {"wall_ms_min", "wall_ms_median", "wall_ms_max"}) EXPECT_EQ(row.erase(time), 1);
  return rows;
}

TEST(ProgramRepeated, GivesTheSameCountersAndErrors) {
  const Words command = tiny + Words{"--method", "bdf2,sbdf2/cholesky,midpoint,verlet", "--step", "0.01"};
  const std::vector<Row> first = timeless(csv(BenchIntegrators(), command));
  EXPECT_THAT(first, SizeIs(4));
  EXPECT_EQ(first, timeless(csv(BenchIntegrators(), command)));
}

TEST(ProgramRepeated, TakesTheReferenceFromTheCache) {
  const BenchIntegrators program;
  const auto references = [&] {
    std::map<std::string, std::filesystem::file_time_type> all;
    for (const auto& file : std::filesystem::directory_iterator(program.cache())) all[file.path()] = file.last_write_time();
    return all;
  };
  const std::vector<Row> first = timeless(csv(program, one_run));
  const auto before = references();
  EXPECT_THAT(before, SizeIs(1));
  EXPECT_EQ(timeless(csv(program, one_run)), first);
  EXPECT_EQ(references(), before) << "computed again";
  EXPECT_THAT(csv(program, one_run + Words{"--set", "material.damping=5"}), Each(Contains(Pair("outcome", "success"))));
  EXPECT_THAT(references(), SizeIs(2)) << "another scene needs another reference";
}

TEST(ProgramRun, StopsWhereTheTwoFamiliesDisagreeByMoreThanAllowed) {
  const BenchIntegrators program;
  const auto result = program.run(one_run + Words{"--agreement", "1e-15"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("hung-edge: cvode-bdf and arkode-esdirk disagree"), HasSubstr("--agreement")));
  EXPECT_THAT(program.files(), Not(testing::Contains(testing::Key(testing::EndsWith(".h5")))));
}

TEST(ProgramRun, OffersStatisticsWherePerturbationsGrow) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  const Words folding{"run",     "--scene", "hung-corners", "--set",  "grid.n=8", "--set", "material.damping=0",
                      "--until", "1.5",     "--method",     "verlet", "--step",   "0.01"};
  EXPECT_THAT(program.output(folding), AllOf(HasSubstr("growth "), HasSubstr("energy error"), HasSubstr("centre error")));
  EXPECT_THAT(program.output(one_run), Not(HasSubstr("energy error")));
}

}  // namespace
}  // namespace drape::verify::program_run_test
