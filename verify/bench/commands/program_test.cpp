// bench_integrators beside its runs: names, help, progress, studies.

#include <gmock/gmock.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "results/file/run_file.hpp"
#include "solver/methods.hpp"
#include "verify/support/bench_integrators.hpp"
#include "verify/support/slow.hpp"

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

/// All that the table has: those, and whatever was added.
Words all_methods() {
  Words names;
  for (const solver::Method& method : solver::methods()) names.emplace_back(method.name);
  return names;
}
const Words methods = all_methods();

const char* const denim = R"({"density": 0.324, "stretching": [[205.352005, 10.234077, 1013.88629, 53.387184], [1, 2, 3, 4],
    [1, 2, 3, 4], [1, 2, 3, 4], [1, 2, 3, 4], [1, 2, 3, 4]],
    "bending": [[6e-5, 1, 1, 1, 1], [7e-5, 1, 1, 1, 1], [9e-5, 1, 1, 1, 1]]})";

TEST(ProgramFabric, MakesKeysOfAMaterialOfArcsim) {
  const BenchIntegrators program;
  program.write("denim.json", denim);
  const std::string keys = program.output({"fabric", "denim.json"});
  EXPECT_THAT(keys, HasSubstr("[material]\ndensity = 0.324  # kg/m²\ntension = [410.70401, 2027.77258]  # N/m\n"));
  EXPECT_THAT(keys, HasSubstr("bend = [6e-05, 9e-05]  # N m\n"));
}

/// A scene keeps what the file says, not the file.
TEST(ProgramFabric, OfArcsimIsTakenByScenes) {
  const BenchIntegrators program;
  program.write("denim.json", denim);
  program.write("bad.json", "{}");
  const Words run{"run",    "--scene", "hung-corners", "--set", "grid.n=4",       "--until", "0.02",     "--method", "bdf2",
                  "--step", "0.01",    "--repeat",     "1",     "--no-reference", "--out",   "denim.h5", "--set"};
  program.output(run + Words{"material.fabric=denim.json"});
  const std::string scene = results::read_runs(program.folder() / "denim.h5").at(0).scene_toml;
  EXPECT_THAT(scene, HasSubstr("\nmaterial.fabric = \"\"\nmaterial.density = 0.324\n"));
  EXPECT_THAT(scene, HasSubstr("\nmaterial.tension = [410.70401, 2027.77258]\n"));
  for (const auto& [file, why] :
       {std::pair("bad.json", "bad.json: expected the key \"density\""), {"none.json", "none.json"}}) {
    const ProgramResult result = program.run(run + Words{std::string("material.fabric=") + file});
    EXPECT_EQ(result.exit_code, 2) << file;
    EXPECT_THAT(result.err, HasSubstr(why));
    EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
  }
}

TEST(ProgramRun, TakesAMeshFromItsFileToAPage) {
  const BenchIntegrators program;
  program.write("mm.obj", "v 0 0 0\nv 300 0 0\nv 300 300 0\nv 0 300 0\nf 1 2 3 4\n");
  program.write("cloth.obj", "v 0 0 0.3\nv 0.3 0 0.3\nv 0.3 0.3 0.3\nv 0 0.3 0.3\nf 1 2 3 4\n");
  const Words run{"run", "--method", "bdf2", "--step",   "0.02", "--until",
                  "0.1", "--repeat", "1",    "--report", "page", "--scene"};
  const ProgramResult result = program.run(run + Words{"cloth.obj"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("note: cloth.obj: The cloth cloth, 121 particles, hung by two corners; "));
  EXPECT_THAT(result.out, HasSubstr("\nreport: page/index.html\n"));
  const auto files = program.files();
  EXPECT_THAT(files.at("page/index.html"), HasSubstr("\"trajectory\""));
  for (const auto& [file, why] : {std::pair("mm.obj", "these may be millimetres"), {"none.ply", "none.ply: "}}) {
    const ProgramResult wrong = program.run(run + Words{file});
    EXPECT_EQ(wrong.exit_code, 2) << file;
    EXPECT_THAT(wrong.err, HasSubstr(why));
    EXPECT_EQ(lines(wrong.err).size(), 1u) << wrong.err;
  }
  EXPECT_EQ(program.files(), files) << "nothing else is written";
}

TEST(ProgramFabric, RefusesInOneLineWhatIsNoMaterial) {
  const BenchIntegrators program;
  const auto refused = [&](const std::string& json, const std::string& why) {
    program.write("x.json", json);
    const ProgramResult result = program.run({"fabric", "x.json"});
    EXPECT_EQ(result.exit_code, 2) << json;
    EXPECT_THAT(result.err, AllOf(HasSubstr("x.json: " + why), EndsWith("\n")));
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    EXPECT_EQ(result.out, "");
  };
  refused("{", "expected a JSON object with density, stretching and bending");
  refused("[1]", "expected a JSON object");
  refused("{}", "expected the key \"density\"");
  refused(R"({"density": "1"})", "density: expected finite numbers");
  refused(R"({"density": -1})", "density: expected a number above 0");
  refused(R"({"density": 1, "stretching": [[1, 2, 3, 4]]})", "stretching: expected 6 rows of 4 numbers");
}

/// A skirt of two panels: what is printed runs, sewing included.
TEST(ProgramPattern, MakesASceneThatRuns) {
  const BenchIntegrators program;
  const std::string edges = R"([{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}])";
  const auto panel = [&](const std::string& translation) {
    return R"({"vertices": [[-60, 0], [60, 0], [30, 50], [-30, 50]], "edges": )" + edges +
           R"(, "rotation": [0, 0, 0], "translation": )" + translation + "}";
  };
  const auto seam = [](int one, int other) {
    return "[{\"panel\": \"front\", \"edge\": " + std::to_string(one) +
           "}, {\"panel\": \"back\", \"edge\": " + std::to_string(other) + "}]";
  };
  program.write("skirt.json", R"({"pattern": {"panels": {"front": )" + panel("[0, 50, 25]") + R"(, "back": )" +
                                  panel("[0, 50, -25]") + R"(}, "stitches": [)" + seam(1, 1) + ", " + seam(3, 3) + "]}}");
  program.write("skirt.toml", program.output({"pattern", "skirt.json", "--spacing", "0.1"}));
  const auto rows = parse_csv(program.output({"run", "--scene", "skirt.toml", "--method", "imex-euler", "--step", "0.01",
                                              "--until", "0.52", "--no-reference", "--format", "csv"}));
  EXPECT_THAT(rows, AllOf(SizeIs(1), Each(Contains(Row::value_type("outcome", "success")))));
}

/// The scenes that were made from patterns are sewn and let go, and no particle is inside of the body.
TEST(ProgramPattern, KeptScenesRunALittle) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  for (const char* scene : {"circle_skirt", "t_shirt"}) {
    const auto rows = parse_csv(program.output({"run", "--scene", scene, "--method", "imex-euler", "--step", "0.01", "--until",
                                                "0.6", "--no-reference", "--repeat", "1", "--format", "csv"}));
    ASSERT_THAT(rows, SizeIs(1));
    EXPECT_EQ(rows[0].at("outcome"), "success") << scene;
    EXPECT_GT(std::stod(rows[0].at("clearance")), 0.01) << scene;
  }
}

/// Curves in mm, and a garment mesh.
TEST(ProgramPattern, TakesAllKindsOfPatterns) {
  const BenchIntegrators program;
  program.write("square.toml",
                "[[panels]]\nname = \"a\"\noutline = [{ line = [[0, 0], [400, 0]] }, { line = [[400, 0], [400, 400]] }, "
                "{ line = [[400, 400], [0, 400]] }, { line = [[0, 400], [0, 0]] }]\n");
  program.write("square.obj",
                "v 0 0 0\nv 0.4 0 0\nv 0.4 0 0.4\nv 0 0 0.4\nvt 0 0\nvt 0.4 0\nvt 0.4 0.4\nvt 0 0.4\nf 1/1 2/2 3/3 4/4\n");
  for (const char* file : {"square.toml", "square.obj"})
    EXPECT_THAT(program.output({"pattern", file, "--spacing", "0.1"}),
                AllOf(HasSubstr("name = \"square\""), HasSubstr("grid.n = [5, 5]"), Not(HasSubstr("# Seams"))))
        << file;
}

// --- Names ---------------------------------------------------------------------------------------------------------------

TEST(ProgramList, HasTheNamesThatOtherProgramsRelyOn) {
  const BenchIntegrators program;
  EXPECT_THAT(methods, IsSupersetOf(of_the_thesis + others));
  EXPECT_EQ(program.output({"list", "methods"}), joined(methods, "\n") + "\n");
  EXPECT_THAT(lines(program.output({"list", "scenes"})),
              AllOf(IsSupersetOf({"hung-edge", "hung-corners"}), Each(MatchesRegex("[a-z0-9_-]+"))));
  EXPECT_THAT(lines(program.output({"list", "studies"})), AllOf(Contains("hung-sheets"), Each(MatchesRegex("[a-z0-9.-]+"))));
}

TEST(ProgramList, DescribesTheNamesOfAllKinds) {
  const BenchIntegrators program;
  const Words all = lines(program.output({"list"}));
  for (const std::string kind : {"scenes", "methods", "studies", "forces", "fabrics"}) {
    EXPECT_THAT(all, Contains(kind + ":"));
    for (const std::string& name : lines(program.output({"list", kind})))
      EXPECT_THAT(all, Contains(MatchesRegex("  " + name + "  +[^ ].+")));
  }
}

TEST(ProgramList, HasOnlyWhatRuns) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  for (const std::string& scene : lines(program.output({"list", "scenes"}))) {
    const Words command{"run",      "--scene", scene,     "--method", joined(of_the_thesis, ","),
                        "--step",   "0.001",   "--until", "0.001",    "--no-reference",
                        "--format", "csv"};
    EXPECT_THAT(parse_csv(program.output(command)),
                AllOf(SizeIs(of_the_thesis.size()), Each(Contains(Row::value_type("outcome", "success")))));
  }
}

TEST(ProgramForces, AgreeWithDifferences) {
  const BenchIntegrators program;
  const auto rows = parse_csv(program.output({"forces", "--scene", "pulled", "--set", "grid.n=5", "--format", "csv"}));
  EXPECT_THAT(rows, AllOf(SizeIs(6), Each(Contains(Row::value_type("verdict", "met: agrees")))));
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
  expect_all_in(help, {"--scene NAME|FILE", "--method A,B", "--step H1,H2", "--until T", "--set key=value", "--repeat R",
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
  expect_all_in(program.output({"list", "--help"}),
                {"list [OPTIONS] [KIND]", "scenes, methods, studies, forces, fabrics, peers"});
}

/// All that reads like help, wherever it is printed.
std::map<std::string, std::string> helps(const BenchIntegrators& program) {
  std::map<std::string, std::string> texts{{"list", program.output({"list"})}, {"", program.output({"--help"})}};
  for (const std::string command :
       {"list", "run", "study", "inspect", "compare", "check", "report", "export", "fabric", "score", "completion", "man"})
    texts[command + " --help"] = program.output({command, "--help"});
  return texts;
}

std::size_t columns(const std::string& line) {
  return static_cast<std::size_t>(std::ranges::count_if(line, [](char c) { return (c & 0xC0) != 0x80; }));
}

TEST(ProgramHelp, FitsATerminalOf80Columns) {
  for (const auto& [command, text] : helps(BenchIntegrators()))
    for (const std::string& line : lines(text)) EXPECT_LE(columns(line), 80u) << command << ": " << line;
}

TEST(ProgramVersion, IsTheProjectsWithItsCommitAndWhatItIsBuiltWith) {
  const Words said = lines(BenchIntegrators().output({"--version"}));
  EXPECT_THAT(said, Contains(MatchesRegex("drape [0-9.]+ \\(([0-9a-f]+(-dirty)?|unknown)\\)")));
  for (const std::string fact : {"compiler", "build_type", "compile_flags", "sundials", "program_hash"})
    EXPECT_THAT(said, Contains(MatchesRegex(fact + " +[^ ].*")));
  EXPECT_THAT(said, Each(AllOf(Not(StartsWith("cpu")), Not(StartsWith("started")), Not(StartsWith("sweep")))));
}

std::string with_name(std::string text, const std::string& name) {
  const std::string usual = "bench_integrators";
  for (auto at = text.find(usual); at != std::string::npos; at = text.find(usual, at)) text.replace(at, usual.size(), name);
  return text;
}

std::string source_file(const std::string& path) {
  std::ifstream file(std::filesystem::path(DRAPE_SOURCE_DIR) / path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(BenchRun, HasTheHelpOfTheProgramBeforeItIsBuilt) {
  const BenchIntegrators program;
  EXPECT_EQ(source_file("bench/commands/help.txt"), with_name(program.output({"--help"}), "bench/run"))
      << "bench/run --help >bench/commands/help.txt";
  EXPECT_EQ(source_file("bench/commands/list.txt"), program.output({"list"})) << "bench/run list >bench/commands/list.txt";
}

TEST(BenchRun, AnswersBeforeAnythingIsInstalledOrBuilt) {
  const BenchIntegrators program;
  const std::filesystem::path tree = program.folder() / "tree";
  for (const std::string file :
       {".ci/prepare.sh", "bench/run", "bench/commands/help.txt", "bench/commands/list.txt", "CMakeLists.txt"}) {
    std::filesystem::create_directories((tree / file).parent_path());
    std::filesystem::copy_file(std::filesystem::path(DRAPE_SOURCE_DIR) / file, tree / file);
  }
  const auto said = [&](const Words& arguments) {
    Command command = program.command(Words{(tree / "bench/run").string()} + arguments);
    command.program = "/bin/bash";
    const ProgramResult result = run_program(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  };
  EXPECT_EQ(said({"--help"}), source_file("bench/commands/help.txt"));
  EXPECT_EQ(said({"list"}), source_file("bench/commands/list.txt"));
  for (const std::string kind : {"scenes", "methods", "studies"})
    EXPECT_EQ(said({"list", kind}), program.output({"list", kind}));
  EXPECT_THAT(said({"--version"}), StartsWith("drape "));
  EXPECT_FALSE(std::filesystem::exists(tree / "build"));
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

const Words tiny_run{"run",  "--scene", "hung-edge", "--set",   "grid.n=5", "--method",
                     "bdf2", "--step",  "0.01",      "--until", "0.02"};

TEST(ProgramProgress, IsSilentWhereItIsToBeQuiet) {
  const BenchIntegrators program;
  EXPECT_EQ(run_on_terminal(program.command(tiny_run + Words{"--quiet"}), 80).err, "");
  EXPECT_THAT(program.output(tiny_run + Words{"-q"}), HasSubstr("hung-edge"));
  program.write("still.toml", "grid.n = 4\nend.time = 0.1\n");
  EXPECT_EQ(program.run({"-q", "run", "--scene", "still.toml", "--method", "bdf2", "--step", "0.05", "--no-reference"}).err,
            "");
  EXPECT_THAT(program.run(tiny_run + Words{"-q", "-v"}).err, AllOf(HasSubstr("--verbose"), HasSubstr("--quiet")));
}

TEST(ProgramProgress, SaysWhatIsDoneWhereItIsToBeVerbose) {
  const BenchIntegrators program;
  EXPECT_THAT(lines(program.run(tiny_run + Words{"--verbose"}).err),
              testing::ElementsAre(
                  MatchesRegex(" +0.0 s  hung-edge bdf2 h = 0.01 grid.n=5"), MatchesRegex(" +[0-9.]+ s  timing hung-edge"),
                  MatchesRegex(" +[0-9.]+ s  reference of hung-edge"),
                  MatchesRegex("note: [0-9]+ patterns of matrices were ordered, [1-9][0-9]* times the order was known")));
}

// --- Tables on a terminal
// ------------------------------------------------------------------------------------------------------

/// What the program prints on a terminal of 80 columns.
std::string shown_on_terminal(const BenchIntegrators& program, const Words& arguments, const Words& environment = {}) {
  Command command = program.command(
      {"-qec", "stty cols 80; exec " + program.command({}).program.string() + " " + joined(arguments, " "), "/dev/null"});
  command.program = "/usr/bin/script";
  command.environment = command.environment + environment;
  std::string shown = run_program(command).out;
  std::erase(shown, '\r');
  return shown;
}

TEST(ProgramTables, FitTheTerminalAndHaveItsColours) {
  const BenchIntegrators program;
  program.output(tiny_run + Words{"--out", "a.h5"});
  const auto shown = [&](const Words& more, const std::string& variable) {
    return shown_on_terminal(program, Words{"inspect", "a.h5", "--table", "runs"} + more, {"TERM=xterm", variable});
  };
  const std::string fitting = shown({}, "NO_COLOR=1");
  for (const std::string& line : lines(fitting)) EXPECT_LE(columns(line), 80u) << line;
  EXPECT_THAT(fitting, AllOf(HasSubstr("hung-edge"), HasSubstr("not shown: "), HasSubstr("--wide"), Not(HasSubstr("\033"))));
  EXPECT_EQ(shown({"--wide"}, "NO_COLOR=1"), program.output({"inspect", "a.h5", "--table", "runs"}));
  EXPECT_THAT(shown({}, "NO_COLOR="), HasSubstr("\033[1m"));
}

TEST(Program, WithoutArgumentsDoesTheMainJob) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  const ProgramResult result = run_on_terminal(program.command({}), 120, "damping=50");
  EXPECT_EQ(result.exit_code, terminated);
  EXPECT_THAT(result.err, AllOf(StartsWith("note: this is the main job"), HasSubstr(erase_line + "["),
                                HasSubstr("hung-edge imex-euler/ic0 h = 0.01 material.damping=50")));
  for (const auto& [name, content] : program.files())
    EXPECT_THAT(name, testing::AnyOf(HasSubstr("-motions-"), EndsWith("/"), EndsWith(".journal"))) << "half-written";
}

// --- A scene in which nothing moves ----------------------------------------------------------------------------------------

TEST(ProgramRun, SaysWhereNothingMoves) {
  const BenchIntegrators program;
  program.write("still.toml", "grid.n = 4\nend.time = 0.1\n");
  const Words command{"run", "--scene", "still.toml", "--method", "bdf2", "--step", "0.05", "--no-reference"};
  const ProgramResult result = program.run(command + Words{"--out", "still.h5"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(lines(result.err), testing::ElementsAre(AllOf(HasSubstr("still"), HasSubstr("nothing moves"))));
  EXPECT_THAT(program.output({"inspect", "still.h5", "--run", "0"}), HasSubstr("nothing moves"));
  const ProgramResult falling = program.run(command + Words{"--set", "forces.gravity=[0, 0, -9.81]"});
  EXPECT_EQ(falling.err, "");
}

// --- Studies -------------------------------------------------------------------------------------------------------------

TEST(ProgramStudy, HungSheetsComparesAllMethodsOnFourSheets) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  const Words command{"study", "hung-sheets", "--quick", "--repeat", "1", "--out", "a.h5", "--format", "csv"};
  const std::vector<Row> rows = parse_csv(program.output(command));
  EXPECT_THAT(rows, SizeIs(4 * (6 + methods.size())));
  std::set<std::string> runs, expected;
  for (const Row& row : rows) {
    runs.insert(row.at("scene") + " " + row.at("set") + " " + row.at("method"));
    EXPECT_EQ(row.at("step"), "0.01");
    const solver::Method& method = solver::method(row.at("method").substr(0, row.at("method").find('/')));
    if (method.explicit_springs() && !method.sub_steps && row.at("outcome") == "unstable") continue;
    EXPECT_THAT(row, IsSupersetOf<Row::value_type>({{"outcome", "success"}, {"steps", "10"}}));
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

TEST(ProgramStudy, TakesTheMethodsThatAreNamed) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  const Words sheets{"study", "hung-sheets", "--quick", "--repeat", "1", "--format", "csv", "--method", "bdf2,sbdf2"};
  const std::vector<Row> rows = parse_csv(program.output(sheets));
  EXPECT_THAT(rows, SizeIs(4 * 4));
  for (const Row& row : rows) EXPECT_THAT(row.at("method"), testing::AnyOf(StartsWith("bdf2"), StartsWith("sbdf2")));

  const Words modes{"study", "modes", "--quick", "--out", "modes.h5", "--method", "esdirk3"};
  program.output(modes);
  for (const Row& row : parse_csv(program.output({"inspect", "modes.h5", "--table", "artificial", "--csv"})))
    EXPECT_EQ(row.at("method"), "esdirk3");
  EXPECT_THAT(program.output({"inspect", "modes.h5"}), HasSubstr("--method esdirk3"));
  EXPECT_EQ(program.run(modes + Words{"--resume"}).exit_code, 0);
  EXPECT_THAT(program.run({"study", "modes", "--quick", "--out", "modes.h5", "--resume", "--method", "esdirk4"}).err,
              HasSubstr("something else"));
  EXPECT_THAT(program.run({"study", "modes", "--quick", "--method", "esdirk9"}).err, HasSubstr("unknown method 'esdirk9'"));
  EXPECT_THAT(program.run({"study", "table-3.1", "--quick", "--method", "bdf2"}).err, HasSubstr("has methods of its own"));
}

TEST(ProgramInspect, FindsTablesByTheBeginningOfTheirNames) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  program.output({"study", "modes", "--quick", "--out", "modes.h5", "--method", "bdf2"});
  const std::string whole = program.output({"inspect", "modes.h5", "--table", "amplification"});
  EXPECT_EQ(program.output({"inspect", "modes.h5", "--table", "amp"}), whole);
  EXPECT_THAT(program.run({"inspect", "modes.h5", "--table", "a"}).err,
              AllOf(HasSubstr("amplification, artificial, stability"), HasSubstr("not 'a'")));
  EXPECT_THAT(program.run({"inspect", "modes.h5", "--table", "runs"}).err, HasSubstr("not 'runs'"));
  EXPECT_THAT(program.run({"inspect", "modes.h5", "--table", "amplifcation"}).err, HasSubstr("(did you mean amplification?)"));
  program.output({"run", "--scene", "hung-edge", "--set", "grid.n=4", "--method", "all", "--step", "0.01", "--until", "0.02",
                  "--no-reference", "--out", "runs.h5"});
  EXPECT_THAT(parse_csv(program.output({"inspect", "runs.h5", "--table", "runs", "--csv"})), SizeIs(methods.size()));
}

TEST(ProgramCheck, IsOneScreenWithTheOrderAsDeclared) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  const Words said = lines(program.output({"check", "sbdf2", "--out", "check.h5"}));
  EXPECT_LE(said.size(), 24u);
  for (const std::string& line : said) EXPECT_LE(columns(line), 80u) << line;
  for (const std::string part : {"2 as declared", "stability ", "energy ", "cost ", "bdf2", "verlet"})
    EXPECT_THAT(joined(said, "\n"), HasSubstr(part));
  EXPECT_THAT(lines(program.output({"inspect", "check.h5", "--csv"})), Contains(StartsWith("check-order")));
  EXPECT_EQ(program.run({"check", "bdf2/newto"}).exit_code, 2);
}

// --- Completion and manual page
// ------------------------------------------------------------------------------------------------

/// What bash proposes for a command line, by the script that the program prints.
class Completed {
 public:
  explicit Completed(const BenchIntegrators& program) : program_(program) {
    program.write("completion.bash", program.output({"completion", "bash"}));
  }

  Words operator()(const std::string& command_line) const {
    // Bash makes words of their own of =.
    const std::string script = R"(source completion.bash
      compopt() { :; }
      mapfile -t COMP_WORDS < <(sed 's/=/ = /g; s/ /\n/g' <<<"$1" | sed '/^$/d'; [[ $1 != *[\ =] ]] || echo)
      [[ $1 != *= ]] || unset 'COMP_WORDS[-1]'
      COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _drape; printf '%s\n' "${COMPREPLY[@]}")";
    Command command = program_.command({"-c", script, "bash", command_line});
    command.program = "/bin/bash";
    const ProgramResult result = run_program(command);
    EXPECT_EQ(result.err, "") << command_line;
    Words proposed = lines(result.out);
    std::erase(proposed, "");
    return proposed;
  }

 private:
  const BenchIntegrators& program_;
};

TEST(ProgramCompletion, ProposesCommandsOptionsAndNames) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  const Completed completed(program);
  program.write("scene_of_mine.toml", "");
  EXPECT_THAT(completed("bench/run "), IsSupersetOf({"run", "study", "completion", "man"}));
  EXPECT_THAT(completed("bench/run st"), testing::ElementsAre("study"));
  EXPECT_THAT(completed("bench/run --ver"), testing::ElementsAre("--version", "--verbose"));
  EXPECT_THAT(completed("bench/run run --sc"), testing::ElementsAre("--scene"));
  EXPECT_THAT(completed("bench/run run --scene hung-e"), testing::ElementsAre("hung-edge"));
  EXPECT_THAT(completed("bench/run run --scene=hung-e"), testing::ElementsAre("hung-edge"));
  EXPECT_THAT(completed("bench/run run --scene scene_of"), testing::ElementsAre("scene_of_mine.toml"));
  EXPECT_THAT(completed("bench/run run --scene "), IsSupersetOf(lines(program.output({"list", "scenes"}))));
  EXPECT_THAT(completed("bench/run run --method "), IsSupersetOf(methods));
  EXPECT_THAT(completed("bench/run run --method bdf2,midp"), testing::ElementsAre("bdf2,midpoint"));
  EXPECT_THAT(completed("bench/run run --method bdf2,sbdf2/ic"), testing::ElementsAre("bdf2,sbdf2/ic0"));
  EXPECT_THAT(completed("bench/run run --set material.den"), testing::ElementsAre("material.density="));
  EXPECT_THAT(completed("bench/run run --set material.fabric=den"), testing::ElementsAre("denim"));
  EXPECT_THAT(completed("bench/run run --format "), testing::ElementsAre("table", "csv", "json"));
  EXPECT_THAT(completed("bench/run run --step "), IsEmpty());
  EXPECT_THAT(completed("bench/run study hung"), testing::ElementsAre("hung-sheets"));
  EXPECT_THAT(completed("bench/run list "), testing::ElementsAre("scenes", "methods", "studies", "forces", "fabrics", "peers"));
  EXPECT_THAT(completed("bench/run inspect scene_"), testing::ElementsAre("scene_of_mine.toml"));
  EXPECT_THAT(completed("bench/run inspect a.h5 --"), AllOf(Contains("--table"), Not(Contains("--scene"))));
}

TEST(ProgramMan, HasAllThatHelpHas) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  std::string page = program.output({"man"});
  EXPECT_THAT(page, StartsWith(".TH BENCH_INTEGRATORS 1 "));
  for (auto at = page.find("\\-"); at != std::string::npos; at = page.find("\\-", at)) page.erase(at, 1);
  for (const std::string command : {"run", "study", "inspect", "compare", "check", "report", "export", "fabric", "score"}) {
    EXPECT_THAT(page, HasSubstr("\n.SS " + command + "\n"));
    const std::string help = program.output({command, "--help"});
    for (const std::string& line : lines(help))
      if (line.starts_with("  -") || line.starts_with("  --")) {
        const std::string spelling = line.substr(2, line.find(' ', 2) - 2);
        EXPECT_THAT(page, HasSubstr("\n.B \\&" + spelling));
      }
  }
  for (const std::string kind : {"scenes", "methods", "studies"})
    for (const std::string& name : lines(program.output({"list", kind})))
      EXPECT_THAT(page, HasSubstr(".TP\n.B \\&" + name + "\n"));
}

// --- Dry runs ----------------------------------------------------------------------------------------------------------------

TEST(ProgramDryRun, SaysHowMuchItIsAndProbesHowLongItTakes) {
  const BenchIntegrators program;
  const Words runs{"run",         "--scene", "hung-edge", "--set",    "grid.n=5", "--method",
                   "bdf2,verlet", "--step",  "0.01,0.02", "--frames", "frames"};
  const Words said = lines(program.output(runs + Words{"--dry-run"}));
  EXPECT_THAT(said,
              testing::ElementsAre("run: 4 runs, each also timed 3 times, 1 reference",
                                   MatchesRegex("time: [0-9.e-]+ s for the runs, from probes of at most 0.5 s each"),
                                   MatchesRegex(" +[0-9.e-]+ s for the references, from probes of at most 2 s each; .*")));
  EXPECT_THAT(program.files(), IsEmpty());
}

TEST(ProgramDryRun, TellsTheTimeOfARecordOfTheSame) {
  const BenchIntegrators program;
  const Words study{"study", "modes", "--quick", "--method", "bdf2"};
  const Words unknown = lines(program.output(study + Words{"-n"}));
  EXPECT_THAT(unknown, testing::ElementsAre(MatchesRegex("modes: [0-9]+ jobs? of [0-9]+ parts? together"),
                                            StartsWith("time: not known")));
  std::filesystem::create_directories(program.folder() / "results/runs");
  program.output(study + Words{"--out", "results/runs/of-modes.h5"});
  const Words known = lines(program.output(study + Words{"-n"}));
  EXPECT_EQ(known.at(0), unknown.at(0));
  EXPECT_THAT(known.at(1), MatchesRegex("time: [0-9]+ s, as results/runs/of-modes.h5 took, recorded on 20..-..-.. of .*"));
  EXPECT_THAT(program.output({"study", "modes", "--quick", "--method", "sbdf2", "-n"}), HasSubstr("not known"));
}

TEST(ProgramDryRun, StandsBehindItsCommand) {
  EXPECT_THAT(BenchIntegrators().run({"--dry-run", "study", "orders", "--quick"}).err,
              HasSubstr("--dry-run: expected after run or study"));
}

}  // namespace
}  // namespace drape::verify::program_test
