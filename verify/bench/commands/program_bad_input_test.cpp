// Whatever is wrong with the input of bench_integrators: one line that names it and says what would be right, exit code 2, and
// nothing printed or written.

#include <gmock/gmock.h>

#include <algorithm>
#include <ostream>

#include "verify/support/bench_integrators.hpp"

namespace drape::verify::program_bad_input_test {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

/// A good command except for one option; without any, a good command.
Words run_with(const std::string& option = "", const Words& values = {}) {
  Words words{"run"};
  for (const Words& good : {Words{"--scene", "hung-edge"}, {"--method", "bdf2"}, {"--step", "0.01"}, {"--until", "0.05"}})
    if (good.front() != option) words = words + good;
  return option.empty() ? words : words + Words{option} + values;
}

Words run_without(const std::string& option) {
  Words words = run_with(option);
  words.pop_back();
  return words;
}

/// A good command that leaves the method to the program, except for one option.
Words auto_with(const std::string& option = "", const std::string& value = "") {
  Words words{"run"};
  for (const Words& good : {Words{"--scene", "hung-edge"}, {"--method", "auto"}, {"--accuracy", "1e-3"}})
    words = words + Words{good.front(), good.front() == option ? value : good.back()};
  return words;
}

struct BadInput {
  std::string name;
  Words arguments;
  Words said;  ///< parts of the message
};

std::ostream& operator<<(std::ostream& out, const BadInput& input) { return out << input.name; }

const std::vector<BadInput> bad_inputs = {
    // The command line.
    {"Subcommand", {"walk"}, {"'walk'", "list, run, study"}},
    {"Option", run_with() + Words{"--speed", "3"}, {"'--speed'", "--scene, --method, --step"}},
    {"OptionOfTheProgram", {"--speed"}, {"'--speed'", "list, run, study"}},
    {"OptionOfAnotherSubcommand", run_with() + Words{"--quick"}, {"'--quick'", "--scene"}},
    {"StrayArgument", run_with() + Words{"bdf2"}, {"'bdf2'", "--method"}},
    {"StrayArgumentOfList", {"list", "scenes", "methods"}, {"'methods'", "KIND"}},
    {"NoScene", run_without("--scene"), {"--scene is required"}},
    {"NoMethod", run_without("--method"), {"--method is required"}},
    {"NoStep", run_without("--step"), {"--step is required"}},
    {"NoStudy", {"study"}, {"NAME is required", "study --help"}},
    {"NoValue", run_with("--step"), {"--step", "H1,H2"}},
    {"TwoUntils", run_with() + Words{"--until", "1"}, {"--until", "At Most 1"}},

    {"FabricOfNoFile", {"fabric", "nowhere.json"}, {"nowhere.json"}},

    // Names.
    {"Kind", {"list", "colours"}, {"'colours'", "scenes, methods, studies"}},
    {"Scene", run_with("--scene", {"flag"}), {"'flag'", "hung-corners, hung-edge", ".toml"}},
    {"MeshForAScene", run_with("--scene", {"open.obj"}), {"open.obj: ", "expected four corners", "not 3"}},
    {"Method", run_with("--method", {"rk9"}), {"'rk9'", "imex-euler, implicit-euler, sbdf2, bdf2"}},
    {"OneOfTheMethods", run_with("--method", {"bdf2,rk9"}), {"'rk9'", "imex-euler, implicit-euler, sbdf2, bdf2"}},
    {"LinearSolver", run_with("--method", {"bdf2/lu"}), {"'lu'", "auto, ic0, mic0, cholesky, multigrid"}},
    {"LinearSolverOfVerlet", run_with("--method", {"verlet/cholesky"}), {"verlet/cholesky", "expected verlet"}},
    {"NoSweeps", run_with("--method", {"xpbd/20x0"}), {"xpbd/20x0", "xpbd/SUB_STEPSxSWEEPS", "from 1 to 100000"}},
    {"SweepsOnly", run_with("--method", {"xpbd/20"}), {"xpbd/20", "xpbd/SUB_STEPSxSWEEPS"}},
    {"SubStepsOfSweeps", run_with("--method", {"kang/2x3"}), {"kang/2x3", "kang/SWEEPS"}},
    {"SweepsOfVerlet", run_with("--method", {"verlet/3"}), {"verlet/3", "expected verlet"}},
    {"Study", {"study", "table-9"}, {"'table-9'", "hung-sheets"}},
    {"Format", run_with("--format", {"xml"}), {"--format", "xml", "table, csv, json"}},

    // Numbers.
    {"StepZero", run_with("--step", {"0"}), {"--step", "above 0", "'0'"}},
    {"StepNegative", run_with("--step", {"-0.01"}), {"--step", "above 0", "'-0.01'"}},
    {"StepNaN", run_with("--step", {"nan"}), {"--step", "finite", "'nan'"}},
    {"StepInfinite", run_with("--step", {"inf"}), {"--step", "finite", "'inf'"}},
    {"StepTooLarge", run_with("--step", {"1e400"}), {"--step", "finite", "'1e400'"}},
    {"StepText", run_with("--step", {"small"}), {"--step", "number", "'small'"}},
    {"StepWithUnit", run_with("--step", {"0.01s"}), {"--step", "number", "'0.01s'"}},
    {"StepEmpty", run_with("--step", {""}), {"--step", "number", "''"}},
    {"OneOfTheSteps", run_with("--step", {"0.01,0"}), {"--step", "above 0", "'0'"}},
    {"TooManySteps", run_with("--step", {"1e-12"}), {"--step", "at most 1e+07 steps", "at least 5e-09", "1e-12"}},
    {"UntilZero", run_with("--until", {"0"}), {"--until", "above 0", "'0'"}},
    {"UntilNegative", run_with("--until", {"-1"}), {"--until", "above 0", "'-1'"}},
    {"UntilNaN", run_with("--until", {"nan"}), {"--until", "finite", "'nan'"}},
    {"UntilInfinite", run_with("--until", {"inf"}), {"--until", "finite", "'inf'"}},
    {"UntilText", run_with("--until", {"later"}), {"--until", "number", "'later'"}},
    {"UntilTooLate", run_with("--until", {"1e300"}), {"--step", "at most 1e+07 steps", "1e+300 s"}},
    {"RepeatZero", run_with("--repeat", {"0"}), {"--repeat", "from 1 to 1000", "'0'"}},
    {"RepeatNegative", run_with("--repeat", {"-1"}), {"--repeat", "from 1 to 1000", "'-1'"}},
    {"RepeatTooOften", run_with("--repeat", {"1001"}), {"--repeat", "from 1 to 1000", "'1001'"}},
    {"RepeatHalf", run_with("--repeat", {"1.5"}), {"--repeat", "whole number", "'1.5'"}},
    {"RepeatOfStudy", {"study", "hung-sheets", "--quick", "--repeat", "0"}, {"--repeat", "from 1 to 1000", "'0'"}},
    {"ControlDescending", run_with("--control", {"5", "2"}), {"--control", "MIN <= MAX", "5 2"}},
    {"ControlNever", run_with("--control", {"0", "0"}), {"--control", "MAX at least 1", "0 0"}},
    {"ControlNegative", run_with("--control", {"-1", "2"}), {"--control", "whole number from 0", "'-1'"}},
    {"ControlHalf", run_with("--control", {"1", "2.5"}), {"--control", "whole number", "'2.5'"}},
    {"ControlAlone", run_with("--control", {"5"}), {"--control", "2 required"}},
    {"Passes", run_with("--passes", {"0"}), {"--passes", "from 1 to", "'0'"}},
    {"PassesOfAcceleratedStages", run_with("--passes", {"2"}), {"--passes", "fixed-point, projective", "not auto"}},
    {"LoopToleranceZero", run_with("--loop-tolerance", {"0"}), {"--loop-tolerance", "from 1e-15 to 1", "'0'"}},
    {"LoopToleranceLarge", run_with("--loop-tolerance", {"1.1"}), {"--loop-tolerance", "from 1e-15 to 1", "'1.1'"}},
    {"LoopToleranceNaN", run_with("--loop-tolerance", {"nan"}), {"--loop-tolerance", "from 1e-15 to 1", "'nan'"}},
    {"CgToleranceTiny", run_with("--cg-tolerance", {"1e-16"}), {"--cg-tolerance", "from 1e-15 to 1", "'1e-16'"}},
    {"CgToleranceLarge", run_with("--cg-tolerance", {"2"}), {"--cg-tolerance", "from 1e-15 to 1", "'2'"}},
    {"CgToleranceNaN", run_with("--cg-tolerance", {"nan"}), {"--cg-tolerance", "from 1e-15 to 1", "'nan'"}},
    {"MaxUpdatesZero", run_with("--max-updates", {"0"}), {"--max-updates", "from 1 to 1000000", "'0'"}},
    {"MaxUpdatesTooMany", run_with("--max-updates", {"1e9"}), {"--max-updates", "from 1 to 1000000", "'1e9'"}},
    {"ThreadsZero", run_with("--threads", {"0"}), {"--threads", "from 1 to 64", "'0'"}},
    {"ThreadsNegative", run_with("--threads", {"-1"}), {"--threads", "from 1 to 64", "'-1'"}},
    {"ThreadsTooMany", run_with("--threads", {"65"}), {"--threads", "from 1 to 64", "'65'"}},
    {"ThreadsHalf", run_with("--threads", {"1.5"}), {"--threads", "whole number", "'1.5'"}},
    {"ThreadsText", run_with("--threads", {"all"}), {"--threads", "whole number", "'all'"}},
    {"ThreadsOfStudy", {"study", "hung-sheets", "--threads", "2"}, {"'--threads'", "--quick"}},
    {"VerletFractionZero", run_with("--verlet-fraction", {"0"}), {"--verlet-fraction", "from 0.001 to 1", "'0'"}},
    {"VerletFractionLarge", run_with("--verlet-fraction", {"1.01"}), {"--verlet-fraction", "from 0.001 to 1", "'1.01'"}},
    {"VerletFractionNaN", run_with("--verlet-fraction", {"nan"}), {"--verlet-fraction", "from 0.001 to 1", "'nan'"}},

    // The choice of a method.
    {"AutoAlone", run_with("--method", {"auto"}), {"--method auto", "expected --accuracy"}},
    {"AutoWithStep", run_with("--method", {"auto"}) + Words{"--accuracy", "1e-3"}, {"--accuracy", "--step"}},
    {"AutoAmongOthers", auto_with("--method", "auto,bdf2"), {"--method", "auto alone"}},
    {"AccuracyWithoutAuto", auto_with("--method", "bdf2"), {"--accuracy", "expected --method auto"}},
    {"AccuracyTooFine", auto_with("--accuracy", "1e-8"), {"--accuracy", "from 1e-07 to 0.1", "'1e-8'"}},
    {"AccuracyTooCoarse", auto_with("--accuracy", "0.2"), {"--accuracy", "from 1e-07 to 0.1", "'0.2'"}},
    {"AccuracyNaN", auto_with("--accuracy", "nan"), {"--accuracy", "from 1e-07 to 0.1", "'nan'"}},
    {"AutoWithTolerance", auto_with() + Words{"--tolerance", "1e-3"}, {"--accuracy", "--tolerance"}},
    {"AutoWithStageAccuracy", auto_with() + Words{"--stage-accuracy", "0.5"}, {"--accuracy", "--stage-accuracy"}},
    {"AutoInContact", auto_with("--scene", "tablecloth"), {"--method auto", "without obstacles"}},

    // Keys of scenes.
    {"UnknownKey",
     run_with("--set", {"material.densty=1"}),
     {"--set", "'material.densty'", "material.density, material.tension"}},
    {"UnknownSection", run_with("--set", {"cloth.n=4"}), {"--set", "'cloth.n'", "grid.n, grid.size"}},
    {"NoKey", run_with("--set", {"=4"}), {"--set", "key=value"}},
    {"NoEqualsSign", run_with("--set", {"grid.n"}), {"--set grid.n", "key=value"}},
    {"OneOfTheSets", run_with("--set", {"grid.n=4"}) + Words{"--set", "grid.n=4.5"}, {"grid.n = 4.5", "whole number"}},
    {"DensityNegative", run_with("--set", {"material.density=-1"}), {"--set", "material.density = -1", "above 0"}},
    {"DensityZero", run_with("--set", {"material.density=0"}), {"--set", "material.density = 0", "above 0"}},
    {"TensionNaN", run_with("--set", {"material.tension=nan"}), {"--set", "material.tension = nan", "finite"}},
    {"TensionInfinite", run_with("--set", {"material.tension=inf"}), {"--set", "material.tension = inf", "finite"}},
    {"DampingNegative", run_with("--set", {"material.damping=-1"}), {"--set", "material.damping = -1", "at least 0"}},
    {"ShearNegative", run_with("--set", {"material.shear=-1"}), {"--set", "material.shear = -1", "at least 0"}},
    {"BendText", run_with("--set", {"material.bend=soft"}), {"--set", "material.bend = 'soft'", "number"}},
    {"ForceWithoutEnergy",
     {"run", "--scene", "pulled", "--method", "energy-momentum", "--step", "0.01"},
     {"energy-momentum", "expected elastic forces with mean forces", "plate"}},
    {"OneParticle", run_with("--set", {"grid.n=1"}), {"--set", "grid.n = 1", "at least 2 particles"}},
    {"NoParticles", run_with("--set", {"grid.n=0"}), {"--set", "grid.n = 0", "from 1"}},
    {"BodyInTheCloth",
     run_with("--set", {"obstacles=[{ shape = 'sphere', radius = 0.1, position = [0.5, 0.5, 0] }]"}),
     {"hung-edge: expected ", "not to pass through obstacles[0] (sphere)", " m deep at t = 0 s"}},
    {"OpenBodyAmongClosedOnes",
     run_with("--scene", {"open_body.toml"}),
     {"open_body.toml: obstacles[1] (mesh): ", "open.obj: expected a closed mesh, 3 edges of its 1 triangles are open"}},
    {"FlatBody",
     run_with("--scene", {"flat_body.toml"}),
     {"flat_body.toml: obstacles[0] (mesh): ", "flat.obj: expected a mesh that encloses a volume"}},
    {"VirtualParticlesOfAChain",
     run_with("--set", {"grid.n=[5, 1]", "--set", "pins=[]", "--set", "contact.adaptive=true"}),
     {"hung-edge", "contact.adaptive: expected a sheet, without panels"}},
    {"VirtualParticlesWithCurves",
     run_with("--set", {"material.weft_curve=[[0, 0], [1, 2]]", "--set", "contact.adaptive=true"}),
     {"contact.adaptive: expected tension by the moduli alone"}},
    {"BodiesThatOverlap",
     run_with("--scene", {"overlapping.toml"}),
     {"overlapping.toml: contact.adaptive: expected bodies that do not touch, ", "of obstacles[0] (mannequin) and body "}},
    {"BodiesThatTouch",
     run_with("--scene", {"touching.toml"}),
     {"touching.toml: contact.adaptive: expected bodies that do not touch, body 0 of obstacles[1] (box) and body 0 of "
      "obstacles[2] (box) do"}},
    {"RaysAtAPlane",
     run_with("--set", {"obstacles=[{ shape = 'plane', position = [0, 0, -5] }]", "--set", "contact.detection=ray"}),
     {"hung-edge: contact.detection: expected \"half-spaces\" with obstacles[0] (plane): ", "expected a closed mesh"}},
    {"FewVerticesOfASphere",
     run_with("--set", {"obstacles=[{ shape = 'sphere', radius = 0.1, vertices = 19, position = [0, 0, -5] }]"}),
     {"obstacles.vertices = 19", "0 or a whole number from 20 to 100000"}},
    {"EndNegative", run_with("--set", {"end.time=-1"}), {"--set", "end.time = -1", "above 0"}},

    // Files.
    {"NoSuchFile", run_with("--scene", {"missing.toml"}), {"missing.toml", "expected a scene file"}},
    {"FolderForAFile", run_with("--scene", {"folder.toml"}), {"folder.toml", "expected a scene file"}},
    {"BrokenFile", run_with("--scene", {"broken.toml"}), {"broken.toml:2", "expected"}},
    {"UnknownKeyInFile", run_with("--scene", {"unknown_key.toml"}), {"unknown_key.toml:3", "'grid.m'", "grid.n, grid.size"}},
    {"NegativeInFile", run_with("--scene", {"negative.toml"}), {"negative.toml:2", "material.density = -1", "above 0"}},
    {"NaNInFile", run_with("--scene", {"nan.toml"}), {"nan.toml:2", "material.density = nan", "finite"}},
    {"OneParticleInFile", run_with("--scene", {"one.toml"}), {"one.toml:2", "grid.n", "at least 2 particles"}},
    {"OutExists", run_with("--out", {"exists.h5"}), {"exists.h5 exists", "choose another --out"}},
    {"SceneOfStudy", {"study", "orders", "--quick", "--scene", "pulled"}, {"--scene", "orders", "work-precision"}},
    {"UnknownSceneOfStudy", {"study", "work-precision", "--scene", "no-such"}, {"no-such", "hung-edge"}},
    {"SetOfStudyWithoutScene", {"study", "work-precision", "--set", "grid.n=5"}, {"--set", "--scene"}},
    {"OutExistsForStudy", {"study", "hung-sheets", "--quick", "--out", "exists.h5"}, {"exists.h5 exists", "another --out"}},
    {"ResumeAFileThatIsNone", run_with("--out", {"exists.h5"}) + Words{"--resume"}, {"exists.h5: ", "not an HDF5 file"}},
    {"ResumeWithoutOut", run_with() + Words{"--resume"}, {"--resume requires --out"}},
    {"ResumeWithFrames",
     run_with("--out", {"a.h5"}) + Words{"--resume", "--frames", "new"},
     {"--frames", "cannot be combined with --resume"}},
    {"TimeLimitZero", run_with("--time-limit", {"0"}), {"--time-limit", "above 0", "'0'"}},
    {"MemoryLimitNegative", run_with("--memory-limit", {"-1"}), {"--memory-limit", "above 0", "'-1'"}},
    {"LimitOfTables", {"study", "modes", "--quick", "--time-limit", "1"}, {"--time-limit", "hung-sheets", "not modes"}},
    {"OutInNoFolder", run_with("--out", {"nowhere/a.h5"}), {"nowhere/a.h5", "folder nowhere", "No such file or directory"}},
    {"OutIsFolder", run_with("--out", {"folder.toml"}), {"folder.toml exists", "choose another --out"}},
    {"OutEmpty", run_with("--out", {""}), {"--out", "expected a name"}},
    {"FramesAmongOthers",
     run_with("--frames", {"."}) + Words{"--out", "a.h5"},
     {".: expected a new or empty folder for the frames"}},
    {"FramesInAFile", run_with("--frames", {"results/a"}) + Words{"--out", "a.h5"}, {"results/a", "cannot be created"}},
    {"FramesEmpty", run_with("--frames", {""}) + Words{"--out", "a.h5"}, {"--frames", "expected a name"}},
    {"FramesAndOutExists", run_with("--frames", {"new"}) + Words{"--out", "exists.h5"}, {"choose another --out"}},
    {"EveryZero", run_with("--every", {"0"}) + Words{"--frames", "new"}, {"--every", "above 0", "'0'"}},
    {"EveryAlone", run_with("--every", {"0.1"}), {"--every", "--frames"}},
    {"NoFolderForResults", run_with(), {"results/runs", "choose a file by --out"}},
};

/// A folder with files that are wrong in many ways, and with none to put results in.
void fill(const BenchIntegrators& program) {
  program.write("broken.toml", "name = \"broken\"\n[grid\nn = 5\n");
  program.write("unknown_key.toml", "name = \"unknown\"\n\ngrid.m = 5\n");
  program.write("negative.toml", "name = \"negative\"\nmaterial.density = -1\n");
  program.write("nan.toml", "name = \"nan\"\nmaterial.density = nan\n");
  program.write("one.toml", "name = \"one\"\ngrid.n = [1, 1]\n");
  program.write("nameless.toml", "grid.n = 5\n");
  const std::string adaptive = "grid.n = 3\ncontact.adaptive = true\nobstacles = [";
  program.write("open_body.toml", "name = \"a\"\n" + adaptive +
                                      "{ shape = 'plane', position = [0, 0, -9] },"
                                      "{ shape = 'mesh', file = 'open.obj', position = [0, 0, -5] }]\n");
  program.write("flat_body.toml",
                "name = \"a\"\n" + adaptive + "{ shape = 'mesh', file = 'flat.obj', position = [0, 0, -5] }]\n");
  program.write("overlapping.toml", "name = \"a\"\n" + adaptive + "{ shape = 'mannequin', position = [0, 0, -5] }]\n");
  program.write("touching.toml", "name = \"a\"\n" + adaptive +
                                     "{ shape = 'plane', position = [0, 0, -9] },"
                                     "{ shape = 'box', size = [1, 1, 1], position = [0, 0, -5] },"
                                     "{ shape = 'box', size = [1, 1, 1], position = [0.5, 1, -4.5] }]\n");
  program.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  program.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n");
  program.write("exists.h5", "a user's results");
  program.write("results", "a file, where by default a folder is made");
  std::filesystem::create_directory(program.folder() / "folder.toml");
}

class BadInputTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputTest, IsExplainedInOneLineAndLeavesNoTrace) {
  const BenchIntegrators program;
  fill(program);
  const auto before = program.files();
  const ProgramResult result = program.run(GetParam().arguments);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, AllOf(StartsWith("bench_integrators: "), EndsWith("\n"), Not(HasSubstr("\033"))));
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
  for (const std::string& part : GetParam().said) EXPECT_THAT(result.err, HasSubstr(part));
  EXPECT_EQ(program.files(), before);
}

INSTANTIATE_TEST_SUITE_P(All, BadInputTest, testing::ValuesIn(bad_inputs), [](const auto& input) { return input.param.name; });

TEST(GoodInput, FromWhichTheBadOnesDifferIsAccepted) {
  const BenchIntegrators program;
  fill(program);
  for (const Words& more : {Words{}, {"--control", "2", "5"}, {"--set", "material.density=2"}, {"--repeat", "1"}}) {
    const ProgramResult result = program.run(run_with("--out", {more.empty() ? "a.h5" : more.front().substr(2) + ".h5"}) +
                                             more + Words{"--no-reference"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.err, IsEmpty());
  }
}

}  // namespace
}  // namespace drape::verify::program_bad_input_test
