// The record file: what is read is what was written, whatever happens to the writer; and it explains itself.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <sstream>
#include <thread>

#include "results/file/hdf5.hpp"
#include "results/file/run_file.hpp"
#include "results/file/schema.hpp"
#include "verify/support/file_size_limit.hpp"
#include "verify/support/record_text.hpp"
#include "verify/support/run_program.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/tables.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::results_test {
namespace {

namespace fs = std::filesystem;
using namespace results;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// No field has its default value; parameters and work are in the order in which they are read.
RunRecord full_record() {
  RunRecord run;
  run.cell = "0123456789abcdef";
  run.scene = "Fähnchen im Wind 旗";
  run.scene_toml = "[material]\ndamping = 0.5 # \"d\"\n";
  run.scene_keys = {{"material.damping", "[0.5, 0.5]", "N s/m"}, {"pins", "{ where = \"Fähnchen\" }", ""}, {"pins", "{ }", ""}};
  run.overrides = "material.damping=0.5";
  run.plan = "2 of 7 terms";
  run.method = "bdf2/cholesky";
  run.stage_solver = "linear";
  run.linear_solver = "cholesky";
  run.step = 0.1;
  run.until = 1.0 / 3.0;
  run.parameters = {{"k_weft", 1e300, "N/m", "stretch stiffness k₁"}, {"wind", -infinity, "m/s", "speed of the wind"}};
  run.numerical_stiffness = 5e-324;
  run.stiffness_to_damping = infinity;
  run.outcome = solver::Outcome::not_finite;
  run.message = "NaN at particle 3, \"corner\"\nafter 2 steps";
  run.last_good_time = 0.2;
  run.steps = {{0.1, 0.1, 1, 20, 0.25, -3}, {0.2, 0.1, 2, 21, nan, infinity}};
  run.times_ms = {3.25, nan, 1e-9};
  run.work = {{"cg_iterations", "iterations of CG", 41},
              {"force/bending", "evaluations of bending", 0},
              {"force/tension", "evaluations of tension", std::int64_t{1} << 40}};
  run.final_state.x = Eigen::VectorXd::LinSpaced(6, 0.1, 0.7).reshaped<Eigen::RowMajor>(2, 3);
  run.final_state.v = solver::Vectors::Constant(2, 3, -0.0);
  run.final_state.v(1, 2) = nan;
  run.final_state.z = Eigen::Vector3d(1e-300, nan, -2);
  run.choice = results::ChoiceRecord{1e-3, "d T/(ρ L²) = 2.23: midpoint"};
  run.error = ErrorRecord{1e-5, 2e-5, "cvode-bdf + arkode-esdirk", 1e-11, 3e-10, 7, 1e-3, 1e-4, 1e-6, 1e-7};
  run.motion_error = results::MotionErrorRecord{1e-4, 0.5, 2e-4, 3e-3, 1e-9, 2e-2, nan, 1e-5};
  run.contact = results::ContactRecord{4e-3, 1e-9, 0.25, nan};
  run.trajectory = TrajectoryRecord{.nu = 2,
                                    .nv = 1,
                                    .panels = {{1, 1}, {1, 1}},
                                    .times = {0, 0.25, infinity},
                                    .states = {run.final_state, {run.final_state.v, run.final_state.x}, run.final_state},
                                    .stretch = {Eigen::Vector2d(1, 2), Eigen::Vector2d(nan, 3), Eigen::Vector2d(4, 1e-300)},
                                    .constraint = {{0, 1}, {2, 0}, {1, 2}}};
  return run;
}

RunRecord named(std::string scene) {
  RunRecord run;
  run.scene = std::move(scene);
  return run;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  return names;
}

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What FileError says; empty if nothing is thrown.
template <class Action>
std::string complaint(Action action) {
  try {
    action();
  } catch (const base::FileError& error) {
    return error.what();
  }
  return "";
}

TEST(RunFile, ReadsBackEveryField) {
  const base::TemporaryFolder folder;
  RunFile file(folder / "runs.h5", {});
  file.add(full_record());
  file.add(RunRecord());
  const auto runs = read_runs(file.path());
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(as_text(runs[0]), as_text(full_record()));
  EXPECT_EQ(as_text(runs[1]), as_text(RunRecord()));
  EXPECT_FALSE(runs[1].error.has_value());
}

TEST(RunFile, KeepsTheOrderOfRuns) {
  const base::TemporaryFolder folder;
  RunFile file(folder / "runs.h5", {});
  for (int i = 0; i < 12; ++i) file.add(named(std::to_string(i)));
  const auto runs = read_runs(file.path());
  ASSERT_EQ(runs.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(runs[i].scene, std::to_string(i));
}

TEST(RunFile, ReadsBackProvenanceInItsOrder) {
  const base::TemporaryFolder folder;
  RunFile file(folder / "runs.h5",
               {{"version", "0.1", "version of drape"}, {"cpu", "Größe™", "model"}, {"answer", "", "none"}});
  file.add(RunRecord());
  std::vector<std::string> facts;
  for (const auto& [name, value, description] : read_provenance(file.path()))
    facts.push_back(name + "|" + value + "|" + description);
  EXPECT_THAT(facts, ElementsAre("version|0.1|version of drape", "cpu|Größe™|model", "answer||none",
                                 testing::StartsWith("resumed||"), testing::StartsWith("finished||")));
}

// --- It explains itself --------------------------------------------------------------------------------------------------

using Paths = std::set<std::string>;

/// Kind ("group", "dataset", "attribute") and path of all that is in the file, as h5dump of the package hdf5-tools sees it.
std::vector<std::pair<std::string, std::string>> h5dump(const fs::path& file) {
  const auto close = [](FILE* pipe) { EXPECT_EQ(pclose(pipe), 0) << "h5dump failed: is the Debian package hdf5-tools there?"; };
  const std::unique_ptr<FILE, decltype(close)> pipe(popen(fmt::format("h5dump -n 1 '{}'", file.string()).c_str(), "r"), close);
  std::string text;
  for (int c; (c = std::fgetc(pipe.get())) != EOF;) text += static_cast<char>(c);
  std::istringstream lines(text);
  std::vector<std::pair<std::string, std::string>> objects;
  for (std::string line, kind, path; std::getline(lines, line);) {
    std::istringstream words(line);
    if (words >> kind >> path && path.starts_with('/')) objects.emplace_back(kind, path);
  }
  return objects;
}

/// What lacks an explanation: a dataset its unit or description, a group its description, a text the attribute that describes
/// it.
Paths unexplained(const std::vector<std::pair<std::string, std::string>>& objects) {
  Paths datasets, wanted, present;
  for (const auto& [kind, path] : objects) {
    const std::string prefix = path == "/" ? "/" : path + "/";
    const bool made_by_a_name = kind == "group" && path.find("/work/") != std::string::npos;  // as of "force/tension"
    if (kind != "attribute" && !made_by_a_name) wanted.insert(prefix + "description");
    if (kind == "dataset") datasets.insert(path), wanted.insert(prefix + "unit");
    if (kind != "attribute") continue;
    present.insert(path);
    const bool explains = path.ends_with("description") || path.ends_with("checksums") || path.ends_with("/schema_version");
    if (!explains && !datasets.contains(fs::path(path).parent_path())) wanted.insert(path + ".description");
  }
  Paths missing;
  std::ranges::set_difference(wanted, present, std::inserter(missing, missing.end()));
  return missing;
}

TEST(RunFile, ExplainsAllThatIsInIt) {
  const base::TemporaryFolder folder;
  RunFile file(folder / "runs.h5", provenance("results_test"));
  file.add(full_record());
  const auto objects = h5dump(file.path());
  EXPECT_GT(objects.size(), 100u);
  EXPECT_THAT(unexplained(objects), IsEmpty());
}

TEST(RunFile, MissingExplanationsAreFound) {
  EXPECT_THAT(unexplained({{"group", "/"}, {"dataset", "/t"}, {"attribute", "/t/unit"}, {"attribute", "/scene"}}),
              ElementsAre("/description", "/scene.description", "/t/description"));
  EXPECT_THAT(unexplained({{"dataset", "/t"}, {"attribute", "/t/description"}}), ElementsAre("/t/unit"));
}

TEST(RunFile, ReadmeNamesAllThatIsInIt) {
  const base::TemporaryFolder folder;
  RunFile file(folder / "runs.h5", provenance("results_test"));
  file.add(full_record());
  const std::string readme = contents(fs::path(DRAPE_SOURCE_DIR) / "results/README.md");
  for (const auto& [kind, path] : h5dump(file.path())) {
    if (kind == "group" || path.ends_with("description") || path.ends_with("/unit")) continue;
    std::string name = path.substr(path.starts_with("/runs/000/") ? 10 : 1);
    for (const char* of_any : {"checksums", "CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST"})
      if (path.ends_with(of_any)) name = of_any;
    for (const char* list : {"parameters/", "work/"})
      if (name.starts_with(list)) name = std::string(list) + "<name>";
    EXPECT_THAT(readme, HasSubstr("`" + name + "`"));
  }
}

// --- Dimensions have names -----------------------------------------------------------------------------------------------

/// The names of the dimensions of each dataset that has some, as h5py sees them, a line each.
std::string dimension_names(const fs::path& file) {
  const ProgramResult result = run_program({.program = "/usr/bin/python3",
                                            .arguments = {"-c", R"(
import h5py, sys
def show(path, item):
    if isinstance(item, h5py.Dataset) and any(len(dimension) for dimension in item.dims):
        print(path, *[dimension[0].name.split("/")[-1] if len(dimension) else "-" for dimension in item.dims])
with h5py.File(sys.argv[1]) as file:
    file.visititems(show)
)",
                                                          file.string()},
                                            .folder = file.parent_path(),
                                            .environment = {},
                                            .output = {}});
  EXPECT_EQ(result.err, "");
  return result.out;
}

/// A table with a verdict.
Table judged() {
  return {"judged",
          "",
          {column("method", "", Role::key, {"a", "b"}),
           column("verdict", "", Role::verdict, {Verdict{Standing::met, "1"}, Verdict{Standing::met, "2"}})}};
}

TEST(RunFile, NamesDimensionsForOthersAlsoOfWhatAnEarlierStartWrote) {
  const base::TemporaryFolder folder;
  {
    RunFile file(folder / "runs.h5", {});
    file.add(full_record());
    file.add(judged());
  }
  RunFile file(folder / "runs.h5", {}, Start::resumed);
  file.add(full_record());
  std::string expected;
  for (const char* run : {"runs/000/", "runs/001/"})
    for (const char* named :
         {"final_state/v particle axis", "final_state/x particle axis", "scene_keys/unit key", "scene_keys/value key",
          "steps/cg_iterations t", "steps/contacts t", "steps/h t", "steps/kinetic_energy t", "steps/potential_energy t",
          "steps/updates t", "trajectory/constraint t particle", "trajectory/stretch t particle",
          "trajectory/v t particle axis", "trajectory/x t particle axis"})
      expected += std::string(run) + named + "\n";
  for (const char* named : {"method row", "verdict row", "verdict.standing row"})
    expected += std::string("tables/judged/") + named + "\n";
  EXPECT_EQ(dimension_names(file.path()), expected);
  EXPECT_EQ(as_text(read_runs(file.path()).front()), as_text(full_record()));
}

TEST(RunFile, RefusesTablesWhoseColumnsWouldLoseCells) {
  const base::TemporaryFolder folder;
  RunFile file(folder / "runs.h5", {});
  const auto add = [&](const Column& one) { file.add(Table{"lossy", "", {one}}); };
  EXPECT_THROW(add(column("step", "", Role::key, {"a", 0.5})), std::logic_error);
  EXPECT_THROW(add(column("step", "", Role::key, {std::int64_t{3}})), std::logic_error);
  EXPECT_THROW(add(column("step", "s", Role::key, {0.5, "a"})), std::logic_error);
  EXPECT_THROW(add(column("step", "s", Role::verdict, {Verdict{Standing::met, "1"}})), std::logic_error);
  EXPECT_NO_THROW(file.add(Table{"whole", "", {column("step", "s", Role::key, {0.5, Datum()})}}));
}

// --- Nothing that was recorded is lost -----------------------------------------------------------------------------------

RunRecord numbered_record(int number) {
  RunRecord run = full_record();
  run.message = std::to_string(number);
  run.scene_toml = std::string(1'000'000, static_cast<char>('a' + number % 26));  // takes a while to write
  return run;
}

/// A process that adds runs, and writes a byte to `added` after each, until it is killed.
pid_t start_writer(const fs::path& path, int added) {
  const pid_t writer = fork();
  if (writer != 0) return writer;
  try {
    RunFile file(path, {});
    for (int i = 0;; ++i) {
      file.add(numbered_record(i));
      if (write(added, ".", 1) != 1) break;
    }
  } catch (...) {
  }
  _exit(1);
}

/// Kills a writer some time after it added `runs` runs; returns how many it had added by then.
int kill_writer(const fs::path& path, int runs, std::chrono::microseconds later) {
  int ends[2];
  if (pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const pid_t writer = start_writer(path, ends[1]);
  close(ends[1]);
  int added = 0;
  char dot;
  while (added < runs && read(ends[0], &dot, 1) == 1) ++added;
  std::this_thread::sleep_for(later);
  kill(writer, SIGKILL);
  waitpid(writer, nullptr, 0);
  while (read(ends[0], &dot, 1) == 1) ++added;
  close(ends[0]);
  return added;
}

TEST(RunFile, KilledWriterLeavesAllThatWasAdded) {
  DRAPE_SLOW();
  std::mt19937 random(1);
  for (int runs = 0; runs < 8; ++runs) {
    const base::TemporaryFolder folder;
    const std::chrono::microseconds later(random() % 20'000);
    const int added = kill_writer(folder / "runs.h5", runs, later);
    ASSERT_GE(added, runs);
    if (added == 0 && !fs::exists(folder / "runs.h5")) continue;
    const auto found = read_runs(folder / "runs.h5");
    EXPECT_THAT(found.size(), testing::AnyOf(added, added + 1)) << "killed " << later.count() << " µs after run " << runs;
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(as_text(found[i]), as_text(numbered_record(static_cast<int>(i))));
  }
}

TEST(RunFile, WritesNothingBeforeTheFirstRun) {
  const base::TemporaryFolder folder;
  const RunFile file(folder / "runs.h5", {});
  EXPECT_THAT(names_in(folder.path()), IsEmpty());
}

TEST(RunFile, RefusesAnExistingFile) {
  const base::TemporaryFolder folder;
  const fs::path path = folder / "runs.h5";
  std::ofstream(path) << "precious";
  EXPECT_THAT(complaint([&] { RunFile(path, {}); }), AllOf(HasSubstr(path.string()), HasSubstr("choose another --out")));
  EXPECT_EQ(contents(path), "precious");
}

TEST(RunFile, RefusesAFileThatAppearsBeforeTheFirstRun) {
  const base::TemporaryFolder folder;
  RunFile file(folder / "runs.h5", {});
  std::ofstream(file.path()) << "precious";
  EXPECT_THAT(complaint([&] { file.add(full_record()); }), HasSubstr("choose another --out"));
  EXPECT_EQ(contents(file.path()), "precious");
  EXPECT_THAT(names_in(folder.path()), ElementsAre("runs.h5"));
}

TEST(RunFile, RefusesAFolderItCannotWriteIn) {
  const base::TemporaryFolder folder;
  EXPECT_THAT(complaint([&] { RunFile(folder / "missing/runs.h5", {}); }), HasSubstr("missing/runs.h5: cannot create"));
  EXPECT_THAT(complaint([] { RunFile("/proc/runs.h5", {}); }), HasSubstr("/proc/runs.h5: cannot create"));  // not even root may
}

TEST(RunFile, FailedWriteLosesOnlyItsOwnRun) {
  const base::TemporaryFolder folder;
  RunFile file(folder / "runs.h5", {});
  file.add(named("first"));
  {
    const FileSizeLimit full_disk(1000);
    EXPECT_THAT(complaint([&] { file.add(named("lost")); }), HasSubstr("runs.h5: cannot be written"));
  }
  EXPECT_THAT(names_in(folder.path()), ElementsAre("runs.h5"));
  EXPECT_EQ(read_runs(file.path()).size(), 1u);
  file.add(named("second"));
  const auto runs = read_runs(file.path());
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].scene, "first");
  EXPECT_EQ(runs[1].scene, "second");
}

TEST(RunFile, RefusedRecordLeavesNoTrace) {
  const base::TemporaryFolder folder;
  RunFile file(folder / "runs.h5", {});
  RunRecord twice;
  twice.parameters = {{"g", 1, "m/s^2", "gravity"}, {"g", 2, "m/s^2", "gravity"}};
  EXPECT_THAT(complaint([&] { file.add(twice); }), AllOf(HasSubstr("runs.h5: g: "), HasSubstr("exists")));
  file.add(named("good"));
  const auto runs = read_runs(file.path());
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].scene, "good");
}

// --- Files that are not ours ---------------------------------------------------------------------------------------------

TEST(ReadRuns, NamesAFileThatIsNotThere) {
  EXPECT_THAT(complaint([] { read_runs("no/such.h5"); }), HasSubstr("no/such.h5: there is no such file"));
}

TEST(ReadRuns, RefusesAFileThatIsNotHdf5) {
  const fs::path text = fs::path(DRAPE_SOURCE_DIR) / "README.md";
  EXPECT_THAT(complaint([&] { read_runs(text); }), AllOf(HasSubstr(text.string()), HasSubstr("is not an HDF5 file")));
}

TEST(ReadRuns, RefusesATruncatedFile) {
  const base::TemporaryFolder folder;
  RunFile file(folder / "runs.h5", {});
  file.add(full_record());
  const auto size = fs::file_size(file.path());
  for (const auto shorter : {size - 1, size / 2, size / 100}) {
    fs::resize_file(file.path(), shorter);
    EXPECT_THAT(complaint([&] { read_runs(file.path()); }), AllOf(HasSubstr("runs.h5"), HasSubstr("truncated")));
    EXPECT_THAT(complaint([&] { read_provenance(file.path()); }), HasSubstr("truncated"));
  }
}

TEST(ReadRuns, RefusesTrajectoriesWhoseFramesAreNotAllThere) {
  const base::TemporaryFolder folder;
  RunRecord run = full_record();
  run.trajectory->times.push_back(1);
  RunFile(folder / "runs.h5", {}).add(run);
  EXPECT_THAT(complaint([&] { read_runs(folder / "runs.h5"); }),
              HasSubstr("runs.h5: trajectory/stretch: expected 2 numbers in each of 4 frames"));
}

TEST(ReadRuns, RefusesPanelsThatAreNotAllOfTheParticles) {
  const base::TemporaryFolder folder;
  RunRecord run = full_record();
  run.trajectory->panels = {{2, 2}};
  RunFile(folder / "runs.h5", {}).add(run);
  EXPECT_THAT(complaint([&] { read_runs(folder / "runs.h5"); }),
              HasSubstr("runs.h5: trajectory/panels: expected nu and nv of panels with 2 particles together"));
}

TEST(ReadRuns, RefusesForeignHdf5AndOtherVersions) {
  const base::TemporaryFolder folder;
  const auto publish_image = [](const fs::path& path, const hdf5::Handle& file) {
    base::publish(path, hdf5::image(file), base::Existing::replace);
    return complaint([&] { read_runs(path); });
  };
  const hdf5::Handle file = hdf5::create_in_memory();
  EXPECT_THAT(publish_image(folder / "external.h5", file), HasSubstr("external.h5: schema_version: can't locate attribute"));
  hdf5::write_integer(file, "schema_version", schema_version + 1);
  EXPECT_THAT(publish_image(folder / "newer.h5", file), HasSubstr("schema_version is 7, this program reads 4 to 6"));
}

}  // namespace
}  // namespace drape::verify::results_test
