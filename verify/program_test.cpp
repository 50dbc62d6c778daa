// bench_integrators beside its runs: names, help, progress, studies.

#include <gmock/gmock.h>

#include <csignal>
#include <set>

#include "verify/bench_integrators.hpp"

namespace drape::verify::program_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::MatchesRegex;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

const Words of_the_thesis{"imex-euler", "implicit-euler", "sbdf2", "bdf2", "midpoint", "imex-midpoint", "verlet"};
const Words others{"tr-bdf2", "esdirk3", "esdirk4", "bdf3", "bdf4", "bdf5"};
const Words methods = of_the_thesis + others;

// --- Names ---------------------------------------------------------------------------------------------------------------

TEST(ProgramList, HasTheNamesThatOtherProgramsRelyOn) {
  const BenchIntegrators program;
  EXPECT_EQ(program.output({"list", "methods"}), joined(methods, "\n") + "\n");
  EXPECT_THAT(lines(program.output({"list", "scenes"})),
              AllOf(IsSupersetOf({"hung-edge", "hung-corners"}), Each(MatchesRegex("[a-z_-]+"))));
  EXPECT_THAT(lines(program.output({"list", "studies"})), AllOf(Contains("hung-sheets"), Each(MatchesRegex("[a-z0-9.-]+"))));
}

TEST(ProgramList, DescribesTheNamesOfAllKinds) {
  const BenchIntegrators program;
  const Words all = lines(program.output({"list"}));
  for (const std::string kind : {"scenes", "methods", "studies"}) {
    EXPECT_THAT(all, Contains(kind + ":"));
    for (const std::string& name : lines(program.output({"list", kind})))
      EXPECT_THAT(all, Contains(MatchesRegex("  " + name + "  +[^ ].+")));
  }
}

TEST(ProgramList, HasOnlyWhatRuns) {
  const BenchIntegrators program;
  for (const std::string& scene : lines(program.output({"list", "scenes"}))) {
    const Words command{"run",      "--scene", scene,     "--method", joined(of_the_thesis, ","),
                        "--step",   "0.001",   "--until", "0.001",    "--no-reference",
                        "--format", "csv"};
    EXPECT_THAT(parse_csv(program.output(command)),
                AllOf(SizeIs(of_the_thesis.size()), Each(Contains(Row::value_type("outcome", "success")))));
  }
}

// --- Help ----------------------------------------------------------------------------------------------------------------

void expect_all_in(const std::string& text, const Words& parts) {
  for (const std::string& part : parts) EXPECT_THAT(text, HasSubstr(part));
}

TEST(ProgramHelp, OfTheProgramLeadsToItsSubcommands) {
  const BenchIntegrators program;
  expect_all_in(program.output({"--help"}), {"Without arguments", "\n  list ", "\n  run ", "\n  study ", "\n  inspect ",
                                             "\n  compare ", "bench_integrators run --help"});
}

TEST(ProgramHelp, OfRunHasEveryOptionAndAllThatThereIsToChooseFrom) {
  const BenchIntegrators program;
  const std::string help = program.output({"run", "--help"});
  expect_all_in(help, {"--scene NAME|FILE.toml", "--method A,B", "--step H1,H2", "--until T", "--set key=value", "--repeat R",
                       "--out FILE.h5", "--format table|csv|json", "--no-reference", "--trajectory every=SECONDS",
                       "--loop-tolerance", "--cg-tolerance", "--max-updates", "--verlet-fraction", "--control MIN MAX",
                       "--resume", "--time-limit SECONDS", "--memory-limit MB"});
  expect_all_in(help,
                lines(program.output({"list", "scenes"})) + methods + Words{"ic0", "mic0", "cholesky", "multigrid", "auto"});
  expect_all_in(help, {"grid.n", "material.tension", "material.damping", "material.shear", "material.bend"});
}

TEST(ProgramHelp, OfTheOthersSaysWhatTheyTake) {
  const BenchIntegrators program;
  expect_all_in(program.output({"study", "--help"}),
                {"study [OPTIONS] NAME", "--quick", "--repeat R", "--out FILE.h5", "--format table|csv|json", "hung-sheets"});
  expect_all_in(program.output({"list", "--help"}), {"list [OPTIONS] [KIND]", "scenes, methods or studies"});
}

// --- Progress ------------------------------------------------------------------------------------------------------------

const std::string erase_line = "\r\033[K";
constexpr int terminated = 128 + SIGTERM;

TEST(ProgramProgress, IsALineOnTheTerminalWithTheTimeLeft) {
  const BenchIntegrators program;
  const Words command{"run",    "--scene", "hung-edge", "--set", "grid.n=5", "--method", "bdf2",
                      "--step", "0.01",    "--until",   "0.05",  "--format", "csv"};
  const unsigned short columns = 50;
  const ProgramResult result = run_on_terminal(program.command(command), columns);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, AllOf(HasSubstr("0/5"), HasSubstr("5/5  0:00 left"), EndsWith(erase_line), Not(HasSubstr("\n"))));
  EXPECT_THAT(split(result.err, '\r'), Each(SizeIs(testing::Lt(columns + erase_line.size() - 1)))) << "wraps";
  EXPECT_THAT(parse_csv(result.out), SizeIs(1));
}

TEST(Program, WithoutArgumentsDoesTheMainJob) {
  const BenchIntegrators program;
  const ProgramResult result = run_on_terminal(program.command({}), 120, "damping=50");
  EXPECT_EQ(result.exit_code, terminated);
  EXPECT_THAT(result.err,
              AllOf(StartsWith(erase_line + "["), HasSubstr("hung-edge imex-euler/ic0 h = 0.01 material.damping=50")));
  for (const auto& [name, content] : program.files())
    EXPECT_THAT(name, testing::AnyOf(EndsWith("/"), EndsWith(".journal"))) << "half-written";
}

// --- Studies -------------------------------------------------------------------------------------------------------------

TEST(ProgramStudy, HungSheetsComparesAllMethodsOnFourSheets) {
  const BenchIntegrators program;
  const Words command{"study", "hung-sheets", "--quick", "--repeat", "1", "--out", "a.h5", "--format", "csv"};
  const std::vector<Row> rows = parse_csv(program.output(command));
  EXPECT_THAT(rows, SizeIs(76));
  std::set<std::string> runs, expected;
  for (const Row& row : rows) {
    runs.insert(row.at("scene") + " " + row.at("set") + " " + row.at("method"));
    EXPECT_THAT(row, IsSupersetOf<Row::value_type>({{"outcome", "success"}, {"step", "0.01"}, {"steps", "10"}}));
    EXPECT_THAT(row.at("error_rms"), Not(IsEmpty()));
  }
  for (const std::string sheet : {"hung-edge material.damping=50 ", "hung-edge material.damping=0.5 ",
                                  "hung-corners material.damping=50 ", "hung-corners material.damping=0.5 "}) {
    for (const std::string method : {"imex-euler/ic0", "implicit-euler/fixed-point/ic0", "sbdf2/ic0", "bdf2/fixed-point/ic0",
                                     "midpoint/fixed-point/ic0", "imex-midpoint/ic0"})
      expected.insert(sheet + method);
    for (const std::string& method : methods) expected.insert(sheet + method);
  }
  EXPECT_EQ(runs, expected);
  EXPECT_THAT(program.files(), SizeIs(1));
}

}  // namespace
}  // namespace drape::verify::program_test
