// Input that was made to do harm: every command answers in one line of plain text, exit code 2, at once, in little memory, and
// leaves nothing behind.

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

#include "verify/support/bench_integrators.hpp"
#include "verify/support/resource_limit.hpp"

namespace drape::verify::hostile_input_test {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;
namespace fs = std::filesystem;

std::string times(std::size_t count, const std::string& text) {
  std::string all;
  for (std::size_t k = 0; k < count; ++k) all += text;
  return all;
}

const std::string escape = "\033[2J\033]0;title\a", name_line = "name = 'x'\n", long_name(300, 'n');
constexpr std::size_t many = 100'000;

/// A folder with all that the commands are attacked by.
void fill(const BenchIntegrators& program) {
  const auto scene = [&](const std::string& file, const std::string& lines) { program.write(file, name_line + lines); };
  scene("header.toml", "[" + times(many, "a.") + "a]\n");
  scene("key.toml", times(many, "a.") + "a = 1\n");
  scene("quoted_key.toml", times(many, "\"a\" . 'b' . ") + "a = 1\n");
  scene("list.toml", "pins = " + std::string(many, '['));
  scene("table.toml", "a = " + times(many, "{a = "));
  scene("large.toml", "# " + std::string(5 << 20, 'x') + "\n");
  scene("particles.toml", "grid.n = [10000000, 1]\n");
  scene("pins.toml", "pins = [" + times(2000, "{where = 'all'}, ") + "]\n");
  scene("obstacles.toml", "obstacles = [" + times(2000, "{shape = 'plane'}, ") + "]\n");
  scene("long_value.toml", "material.density = '" + std::string(3 << 20, 'v') + "'\n");
  scene("long_key.toml", std::string(3 << 20, 'k') + " = 1\n");
  scene("long_list.toml", "grid.n = [" + times(many, "1, ") + "]\n");
  scene("twice.toml", times(2, "a." + std::string(many, 'k') + " = 1\n"));
  scene("escape.toml", "\"\\u001b[2J\\n\\u009b\\u202e\" = 1\n");
  scene("escape_in_value.toml", "material.density = \"\\u001b[2J\\r\\n\\u202e\"\n");
  scene("bytes.toml", "description = '\xff\xfe\x1b'\n");
  scene("mesh_pipe.toml", "obstacles = [{shape = 'mesh', file = 'pipe.ply'}]\n");
  scene("mesh_device.toml", "obstacles = [{shape = 'mesh', file = 'zero.h5'}]\n");
  scene("mesh_long.toml", "obstacles = [{shape = 'mesh', file = '" + long_name + "'}]\n");
  scene("mesh_of_nothing.toml", "obstacles = [{shape = 'mesh', file = 'key.toml'}]\n");
  program.write(escape + "\n.toml", "name = ");
  scene("mesh_of_a_pipe.toml", "obstacles = [{shape = 'mesh', file = 'of_a_pipe.obj'}]\n");
  program.write("of_a_pipe.obj", "mtllib pipe.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  program.write("long_name.toml", "name = '" + std::string(1000, 'n') + "'\n");
  for (const char* pipe : {"pipe.toml", "pipe.h5", "pipe.ply", "pipe.mtl"}) mkfifo((program.folder() / pipe).c_str(), 0666);
  for (const char* end : {".toml", ".h5", ".obj"}) {
    fs::create_symlink("/dev/zero", program.folder() / ("zero" + std::string(end)));
    fs::create_symlink("/dev/urandom", program.folder() / ("random" + std::string(end)));
  }
  fs::create_symlink("loop.h5", program.folder() / "loop.h5");
  fs::create_directory(program.folder() / "folder.h5");
  program.write("file", "where a folder is wanted");
}

struct Attack {
  std::string name;
  Words arguments;
  Words said;  ///< parts of the answer
  std::string environment = {};
};

void PrintTo(const Attack& attack, std::ostream* out) { *out << attack.name; }

Words run(const std::string& scene, const Words& more = {}) {
  return Words{"run", "--scene", scene, "--method", "bdf2", "--step", "0.01", "--until", "0.02", "--no-reference"} + more;
}

Words score(const Words& more) { return Words{"score", "--scene", "hung-edge"} + more; }

// clang-format off
const std::vector<Attack> attacks = {
    {"DeepHeader", run("header.toml"), {"header.toml:2: nested deeper than 16 levels"}},
    {"DeepKey", run("key.toml"), {"key.toml:2: nested deeper than 16 levels"}},
    {"DeepKeyInQuotes", run("quoted_key.toml"), {"nested deeper than 16 levels"}},
    {"DeepList", run("list.toml"), {"list.toml:2: nested deeper than 16 levels"}},
    {"DeepTable", run("table.toml"), {"table.toml:2: nested deeper than 16 levels"}},
    {"DeepOverride", run("hung-edge", {"--set", "pins=" + std::string(50'000, '[')}), {"--set pins: nested deeper than 16 levels"}},
    {"DeepOverrideOfAKey", run("hung-edge", {"--set", times(10'000, "a.") + "a=1"}), {"--set", "unknown key"}},

    {"PipeForAScene", run("pipe.toml"), {"pipe.toml: is a device or pipe", "at most 4 MB"}},
    {"ZerosForAScene", run("zero.toml"), {"zero.toml: is a device or pipe"}},
    {"NoiseForAScene", run("random.toml"), {"random.toml: is a device or pipe"}},
    {"LargeScene", run("large.toml"), {"large.toml: has 6 MB, more than 4 MB"}},
    {"LongNameForAScene", run(long_name + ".toml"), {"cannot be read (File name too long)"}},
    {"PipeForAMesh", run("mesh_pipe.toml"), {"mesh_pipe.toml:2: obstacles.file", "is a device or pipe"}},
    {"ZerosForAMesh", run("mesh_device.toml"), {"is a device or pipe"}},
    {"LongNameForAMesh", run("mesh_long.toml"), {"mesh_long.toml:2", "File name too long"}},
    {"PipeForTheMaterialOfAMesh", run("mesh_of_a_pipe.toml"), {"of_a_pipe.obj", "expected a closed mesh"}},
    {"TextForAMesh", run("mesh_of_nothing.toml"), {"expected a mesh"}},
    {"PipeForResults", {"inspect", "pipe.h5"}, {"pipe.h5: "}},
    {"ZerosForResults", {"report", "zero.h5", "--out", "r"}, {"zero.h5: "}},
    {"NoiseForResults", {"compare", "random.h5", "random.h5"}, {"random.h5: "}},
    {"LinkToItselfForResults", {"inspect", "loop.h5"}, {"loop.h5: "}},
    {"FolderForResults", {"inspect", "--validate", "folder.h5"}, {"folder.h5: "}},
    {"LongNameForResults", {"inspect", long_name}, {"nnn"}},
    {"PipeForAMotion", score({"pipe.h5"}), {"pipe.h5: is a device or pipe"}},
    {"ZerosForAMotion", score({"zero.obj", "--frame-time", "0.1"}), {"zero.obj: is a device or pipe"}},
    {"FolderForAMotion", score({"folder.h5"}), {"folder.h5: is a folder"}},
    {"LongNameForAMotion", score({long_name}), {"File name too long"}},
    {"LinkToItselfForAMotion", score({"loop.h5"}), {"loop.h5: cannot be read"}},

    {"ManyPins", run("pins.toml"), {"pins.toml:2: pins = ", "at most 1000 entries, not 2000"}},
    {"ManyObstacles", run("obstacles.toml"), {"obstacles.toml:2: obstacles = ", "at most 1000 entries, not 2000"}},
    {"ManyRuns", {"run", "--scene", "hung-edge", "--step", times(400, "0.01,") + "0.01", "--method", "bdf2,sbdf2,midpoint"}, {"expected at most 1000 runs, not 3 methods with 401 steps"}},
    {"LongSceneName", run("long_name.toml"), {"long_name.toml:1: name = 'nnn", "expected a name of at most 200 characters"}},
    {"ManyFrames", {"export", "--scene", "hung-edge", "--out", "new", "--every", "1e-300"}, {"--every: expected at most"}},
    {"ManyFramesOfATrajectory", run("hung-edge", {"--out", "a.h5", "--trajectory", "every=1e-300"}), {"--trajectory: expected at most"}},
    {"ManySteps", {"run", "--scene", "hung-edge", "--method", "bdf2", "--step", "1e-300", "--no-reference"}, {"--step: expected at most 1e+07 steps"}},

    {"EscapeInAFileName", run(escape + "\n.toml"), {R"(\u001b[2J\u001b]0;title\u0007\n.toml:1: )"}},
    {"EscapeInAKey", run("escape.toml"), {R"(unknown key '\u001b[2J\n\u009b\u202e')"}},
    {"EscapeInAValue", run("escape_in_value.toml"), {"material.density = ", "expected a number"}},
    {"EscapeInASceneName", run(escape), {R"(unknown scene '\u001b[2J\u001b]0;title\u0007')"}},
    {"EscapeInAMethod", {"run", "--scene", "hung-edge", "--step", "1", "--method", escape}, {R"(unknown method '\u001b[2J)"}},
    {"EscapeInAnOption", {"run", "--" + escape}, {R"(unknown argument '--\u001b[2J)"}},
    {"EscapeInACommand", {escape}, {R"(unknown argument '\u001b[2J)"}},
    {"EscapeInANumber", {"run", "--step", escape}, {R"(not '\u001b[2J)"}},
    {"EscapeInAnOverride", run("hung-edge", {"--set", escape + "=1"}), {R"(--set \u001b[2J)"}},
    {"EscapeInAFormat", run("hung-edge", {"--format", escape}), {"--format"}},
    {"EscapeInAStudy", {"study", escape}, {R"(unknown study '\u001b[2J)"}},
    {"EscapeInAKind", {"list", escape}, {R"(unknown kind of names '\u001b[2J)"}},
    {"EscapeInAResult", {"inspect", escape}, {R"(\u001b[2J\u001b]0;title\u0007: )"}},
    {"EscapeInAMotion", score({escape}), {R"(\u001b[2J\u001b]0;title\u0007: )"}},
    {"EscapeInAnOut", run("hung-edge", {"--out", "nowhere/" + escape}), {R"(nowhere/\u001b[2J)"}},
    {"BytesThatAreNoText", run("bytes.toml"), {"bytes.toml:2: "}},

    {"LongValue", run("long_value.toml"), {"long_value.toml:2: material.density = 'vvv", "characters): expected a number"}},
    {"LongKey", run("long_key.toml"), {"long_key.toml:2: unknown key 'kkk", "characters)': expected one of name, "}},
    {"LongList", run("long_list.toml"), {"long_list.toml:2: grid.n = [", "characters): expected a list of 2 numbers"}},
    {"LongKeyTwice", run("twice.toml"), {"twice.toml:3: "}},
    {"LongOverride", run("hung-edge", {"--set", std::string(many, 'k') + "=1"}), {"characters)': expected one of name, "}},
    {"LongMethod", {"run", "--scene", "hung-edge", "--step", "1", "--method", std::string(many, 'm')}, {"characters)': expected one of"}},
    {"LongOption", {"run", "--" + std::string(many, 'o')}, {"characters)': expected one of"}},
    {"LongNumber", {"run", "--step", std::string(many, '1') + "x"}, {"characters)"}},
    {"LongFormat", run("hung-edge", {"--format", std::string(many, 'f')}), {"--format"}},

    {"OutIsAnOption", run("hung-edge", {"--out", "--resume"}), {"--out", "expected a name", "'--resume'"}},
    {"OutIsADash", run("hung-edge", {"--out", "-"}), {"--out", "expected a name", "'-'"}},
    {"OutIsADashOfAReport", {"report", "a.h5", "--out", "-"}, {"--out", "expected a name", "'-'"}},
    {"OutIsADashOfAnExport", {"export", "--scene", "hung-edge", "--out", "-"}, {"--out", "expected a name", "'-'"}},
    {"OutIsAnOptionOfAStudy", {"study", "orders", "--quick", "--out", "--format"}, {"--out", "expected a name"}},
    {"FramesAreAnOption", run("hung-edge", {"--frames", "--every"}), {"--frames", "expected a name"}},
    {"MotionWithADash", score({"-motion.h5"}), {"unknown argument '-motion.h5'"}},
    {"MotionWithADashBehindTwo", score({"--", "-motion.h5"}), {"-motion.h5: there is no such file"}},
    {"ADashForAMotion", score({"-"}), {"-"}},
    {"ResultsWithADash", {"inspect", "-a.h5"}, {"'-a.h5'"}},

    {"FileForTheFolderOfAReport", {"report", "file", "--out", "file"}, {"file: "}},
    {"FileForTheFolderOfAnExport", {"export", "--scene", "hung-edge", "--out", "file/new"}, {"file"}},
    {"LongNameForOut", run("hung-edge", {"--out", long_name}), {"File name too long"}},
    {"LongNameForFrames", run("hung-edge", {"--out", "a.h5", "--frames", long_name}), {"File name too long"}},
    {"LongNameForAnExport", {"export", "--scene", "hung-edge", "--out", long_name}, {"File name too long"}},
    {"NoFolderForTemporaryFiles", score({"file.obj", "--frame-time", "0.1"}), {"TMPDIR", "/no/such/folder", "No such file or directory"}, "TMPDIR=/no/such/folder"},
    {"FileForTheFolderOfTemporaryFiles", score({"file.obj", "--frame-time", "0.1"}), {"TMPDIR", "/dev/null", "Not a directory"}, "TMPDIR=/dev/null"},

    {"MisspelledOption", {"run", "--scene", "hung-edge", "--methods", "bdf2", "--step", "0.01"}, {"'--methods' (did you mean --method?)"}},
    {"MisspelledMethod", {"run", "--scene", "hung-edge", "--method", "BDF2", "--step", "0.01"}, {"'BDF2' (did you mean bdf2?)"}},
    {"ExchangedLetters", {"run", "--scene", "hung-edge", "--method", "bfd2", "--step", "0.01"}, {"'bfd2' (did you mean bdf2?)"}},
    {"MisspelledStageSolver", {"run", "--scene", "hung-edge", "--method", "bdf2/newtn", "--step", "0.01"}, {"'newtn' (did you mean newton?)", "auto, ic0"}},
    {"MisspelledLinearSolver", {"run", "--scene", "hung-edge", "--method", "bdf2/newton/cholesk", "--step", "0.01"}, {"linear solver 'cholesk' (did you mean cholesky?)"}},
    {"MisspelledFormat", run("hung-edge", {"--format", "cvs"}), {"--format: ", "'cvs' (did you mean csv?)", "table, csv, json"}},
    {"MisspelledShell", {"completion", "bach"}, {"'bach' (did you mean bash?)"}},
    {"MisspelledKind", {"list", "scense"}, {"'scense' (did you mean scenes?)"}},
    {"MisspelledScene", run("hung-edgee"), {"'hung-edgee' (did you mean hung-edge?)"}},
    {"MisspelledKey", run("hung-edge", {"--set", "material.densty=1"}), {"'material.densty' (did you mean material.density?)"}},
    {"MisspelledFabric", run("hung-edge", {"--set", "material.fabric=denin"}), {"material.fabric = 'denin'", "(did you mean \"denim\"?)"}},
    {"MisspelledValue", run("hung-edge", {"--set", "contact.response=constrant"}), {"contact.response = 'constrant'", "(did you mean \"constraint\"?)"}},
    {"MisspelledCommand", {"raport"}, {"'raport' (did you mean report?)"}},
    {"MisspelledStudy", {"study", "workprecision"}, {"'workprecision' (did you mean work-precision?)"}},
};
// clang-format on

bool is_plain(const std::string& line) {
  return std::ranges::none_of(line, [](unsigned char c) { return std::iscntrl(c) != 0; });
}

class ProgramHostileInput : public testing::TestWithParam<Attack> {};
INSTANTIATE_TEST_SUITE_P(, ProgramHostileInput, testing::ValuesIn(attacks), [](const auto& test) { return test.param.name; });

TEST_P(ProgramHostileInput, IsAnsweredInOneLineAndLeavesNoTrace) {
  const BenchIntegrators program;
  fill(program);
  if (GetParam().name.find("TemporaryFiles") != std::string::npos) program.write("file.obj", "v 0 0 0\n");
  const auto before = program.files();
  Command command = program.command(GetParam().arguments);
  if (!GetParam().environment.empty()) command.environment.push_back(GetParam().environment);
  const ProgramResult result = run_program(command);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, IsEmpty());
  ASSERT_THAT(result.err, AllOf(StartsWith("bench_integrators: "), testing::EndsWith("\n")));
  EXPECT_TRUE(is_plain(result.err.substr(0, result.err.size() - 1))) << result.err;
  EXPECT_LT(result.err.size(), 2500u);
  for (const std::string& part : GetParam().said) EXPECT_THAT(result.err, HasSubstr(part));
  EXPECT_EQ(program.files(), before);
}

#ifndef DRAPE_SANITIZE  // whose shadow is more than any limit
TEST(ProgramHostileScene, OfMoreParticlesThanMemoryIsRefusedAtOnce) {
  const BenchIntegrators program;
  fill(program);
  const ResourceLimit memory(RLIMIT_DATA, 1 << 30);
  for (const Words& command : {run("particles.toml"), run("hung-edge", {"--set", "grid.n=[10000000, 1]"})}) {
    const ProgramResult result = program.run(command);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err,
                AllOf(AnyOf(HasSubstr("grid.n = [10000000, 1]: 1e+07 particles need at least"), HasSubstr("not enough memory")),
                      HasSubstr("GB are available")));
  }
}

TEST(ProgramHostileScene, BeyondMemoryIsSaidToBe) {
  const BenchIntegrators program;
  const ResourceLimit memory(RLIMIT_DATA, 120 << 20);
  const ProgramResult result = program.run(run("hung-edge", {"--set", "grid.n=300", "--out", "a.h5", "--format", "csv"}));
  EXPECT_EQ(result.exit_code, 0) << "a run that fails is a result";
  EXPECT_THAT(result.out, HasSubstr("out of memory,more than the machine has"));
}
#endif

TEST(ProgramWithoutStreams, RecordsWhatItWouldWithThem) {
  const BenchIntegrators program;
  Command command = program.command(
      run("hung-edge", {"--set", "grid.n=3", "--repeat", "1", "--out", "a.h5", "--every", "0.01", "--frames", "f"}));
  command.arguments.insert(command.arguments.begin(), {"-c", "exec \"$0\" \"$@\" <&- >&- 2>&-", command.program.string()});
  command.program = "/bin/sh";
  EXPECT_EQ(run_program(command).exit_code, 0);
  EXPECT_THAT(program.output({"inspect", "a.h5", "--validate"}), HasSubstr("is as results/README.md specifies"));
  for (const auto& [name, content] : program.files())
    if (name.ends_with(".obj")) {
      EXPECT_THAT(content, StartsWith("# t = ")) << name;
    }
}

// --- Texts that are recorded and printed again

TEST(ProgramRecordedText, NeitherActsOnTheTerminalNorOnSpreadsheets) {
  const BenchIntegrators program;
  program.write("hostile.toml", "name = \"=1+1\\u001b[31m\\n\\u202e\\u009b\"\ndescription = \"\\u001b[2J\"\ngrid.n = 3\n");
  for (const std::string format : {"table", "csv", "json"}) {
    const std::string file = format + ".h5";
    const std::string out = program.output(run("hostile.toml", {"--repeat", "1", "--out", file, "--format", format}));
    for (const std::string& shown :
         {out, program.output({"inspect", file}), program.output({"inspect", file, "--run", "0"}),
          program.output({"inspect", file, "--csv"}), program.output({"inspect", file, "--json"}),
          program.output({"report", file, "--out", "r"}), program.output({"inspect", file, "--validate"})})
      for (const std::string& line : lines(shown)) {
        EXPECT_TRUE(is_plain(line)) << line;
        EXPECT_THAT(line, AllOf(Not(HasSubstr("\u202e")), Not(HasSubstr("\u009b"))));
      }
    if (format == "csv") {
      EXPECT_THAT(out, HasSubstr(R"('=1+1\u001b[31m\n\u202e\u009b,)"));
    }
    if (format == "json") {
      EXPECT_THAT(out, HasSubstr(R"("=1+1\u001b[31m\n\u202e\u009b")"));
    }
  }
}

// --- What killed processes leave

TEST(KilledProgram, LeavesNothingThatTheNextOneDoesNotRemove) {
  const BenchIntegrators program;
  fs::create_directory(program.cache());
  for (const fs::path& folder : {program.folder(), program.cache()})
    std::ofstream(folder / ".drape-tmp-1-0") << "of process 1, which lives but does not hold its lock";
  fs::create_directory(program.folder() / ".drape-tmp-77-1");
  program.output({"run", "--scene", "hung-edge", "--set", "grid.n=3", "--method", "bdf2", "--step", "0.01", "--until", "0.02",
                  "--repeat", "1", "--out", "a.h5"});
  EXPECT_THAT(program.files(), testing::ElementsAre(testing::Key("a.h5")));
  EXPECT_FALSE(fs::exists(program.cache() / ".drape-tmp-1-0"));
}

}  // namespace
}  // namespace drape::verify::hostile_input_test
