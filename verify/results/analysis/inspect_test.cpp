// bench_integrators inspect and compare: what they show of files, and how they end.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "results/file/run_file.hpp"
#include "verify/support/bench_integrators.hpp"

namespace drape::verify::inspect_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::SizeIs;

const Words two_runs{"run",      "--scene",    "hung-edge", "--set", "grid.n=5", "--until", "0.05", "--no-reference",
                     "--method", "bdf2,sbdf2", "--step",    "0.01",  "--repeat", "2",       "--out"};

/// A file with two runs and a table.
class Inspect : public testing::Test {
 protected:
  Inspect() {
    program_.output(two_runs + Words{"a.h5"});
    const std::filesystem::path file = program_.folder() / "table.h5";
    results::RunFile(file, {{"version", "0.1", "of drape"}})
        .add(results::Table{"areas",
                            "areas of things",
                            {{"thing", "thing", "", "", results::Role::key, {"a, b", "c"}, {}},
                             {"area", "area", "m²", "", results::Role::quantity, {2.5, 1.0 / 3}, {}}}});
  }
  std::string inspect(const Words& arguments) const { return program_.output(Words{"inspect"} + arguments); }
  nlohmann::json json(const Words& arguments) const { return nlohmann::json::parse(inspect(arguments + Words{"--json"})); }
  std::string complaint(const Words& arguments) const {
    const ProgramResult result = program_.run(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "");
    return result.err;
  }
  BenchIntegrators program_;
};

TEST_F(Inspect, ShowsWhereAFileComesFromItsRunsAndTables) {
  EXPECT_THAT(inspect({"a.h5"}),
              AllOf(HasSubstr("command_line "), HasSubstr("\nhung-edge  bdf2 "), HasSubstr("\nhung-edge  sbdf2 ")));
  EXPECT_THAT(inspect({"table.h5"}), AllOf(HasSubstr("version"), HasSubstr("areas     2  areas of things")));
  EXPECT_EQ(json({"a.h5"})["runs"], nlohmann::json::parse(inspect({"a.h5", "--json"}))["runs"]);
  EXPECT_THAT(json({"a.h5"})["runs"], SizeIs(2));
  EXPECT_EQ(json({"table.h5"})["tables"][0]["rows"], 2);
}

TEST_F(Inspect, ShowsATableByItsName) {
  EXPECT_EQ(inspect({"table.h5", "--table", "areas", "--csv"}), "thing,area\n\"a, b\",2.5\nc,0.3333333333333333\n");
  EXPECT_EQ(json({"table.h5", "--table", "areas"})[1]["thing"], "c");
}

TEST_F(Inspect, ShowsARunInFull) {
  const nlohmann::json all = json({"a.h5", "--run", "1"});
  const results::RunRecord run = results::read_runs(program_.folder() / "a.h5")[1];
  const auto value = [&](const std::string& table, const std::string& name) -> nlohmann::json {
    for (const auto& row : all[table])
      if (row["name"] == name) return row["value"];
    return {};
  };
  EXPECT_EQ(value("run", "method"), "sbdf2");
  EXPECT_EQ(value("run", "step"), 0.01);
  EXPECT_THAT(all["work"], SizeIs(run.work.size()));
  for (const results::WorkCount& work : run.work) EXPECT_EQ(value("work", work.name), work.count);
  for (const results::Parameter& parameter : run.parameters) EXPECT_EQ(value("parameters", parameter.name), parameter.value);
  EXPECT_THAT(all["scene"], Contains(nlohmann::json{{"key", "grid.n"}, {"value", "[5, 5]"}, {"unit", ""}}));
  EXPECT_EQ(all["series"][0]["series"], "t");
  EXPECT_EQ(all["series"][0]["length"], 5);
  EXPECT_EQ(all["series"][0]["least"], run.steps[0].t);
  EXPECT_EQ(all["series"][0]["last"], run.steps[4].t);
  EXPECT_THAT(inspect({"a.h5", "--run", "001"}), HasSubstr("\nmethod "));
}

TEST_F(Inspect, SaysWhatThereIsInstead) {
  EXPECT_THAT(complaint({"inspect", "a.h5", "--run", "2"}), HasSubstr("--run: expected a run of a.h5 from 000 to 001, not 2"));
  EXPECT_THAT(complaint({"inspect", "table.h5", "--run", "0"}), HasSubstr("table.h5 has no runs"));
  EXPECT_THAT(complaint({"inspect", "table.h5", "--table", "volumes"}), HasSubstr("(areas), not 'volumes'"));
  EXPECT_THAT(complaint({"inspect", "nothing.h5"}), HasSubstr("nothing.h5: there is no such file"));
  EXPECT_THAT(complaint({"compare", "a.h5", "nothing.h5"}), HasSubstr("nothing.h5: there is no such file"));
  program_.write("text.h5", "no HDF5");
  EXPECT_THAT(complaint({"inspect", "text.h5"}), HasSubstr("text.h5: is not an HDF5 file"));
}

TEST_F(Inspect, SaysWhetherAFileIsAsSpecified) {
  program_.output(two_runs + Words{"moving.h5", "--trajectory", "every=0.02"});
  for (const char* file : {"a.h5", "moving.h5"})
    EXPECT_THAT(inspect({file, "--validate"}), HasSubstr("is as results/README.md specifies")) << file;
  const ProgramResult incomplete = program_.run({"inspect", "table.h5", "--validate"});
  EXPECT_EQ(incomplete.exit_code, 1);
  EXPECT_THAT(incomplete.out, HasSubstr("git_commit: is missing"));
}

TEST_F(Inspect, CompareEndsAsItsVerdictsWant) {
  const auto compare = [&](const Words& arguments) { return program_.run(Words{"compare"} + arguments); };
  program_.output(two_runs + Words{"b.h5"});
  const ProgramResult same = compare({"a.h5", "b.h5", "--no-times"});
  EXPECT_EQ(same.exit_code, 0) << same.out;
  EXPECT_THAT(same.out,
              AllOf(HasSubstr("accuracy: same"), HasSubstr("work: same"), HasSubstr("time: same (not compared, as asked)")));
  const ProgramResult too_few = compare({"a.h5", "b.h5"});
  EXPECT_EQ(too_few.exit_code, 2);
  EXPECT_THAT(too_few.out, HasSubstr("time: not comparable"));
  program_.output(two_runs + Words{"c.h5", "--stage-accuracy", "0.01"});
  const ProgramResult different = compare({"a.h5", "c.h5", "--no-times"});
  EXPECT_EQ(different.exit_code, 2);
  EXPECT_THAT(different.out,
              AllOf(HasSubstr("accuracy: not comparable"), HasSubstr("parameter stage_accuracy (0.1 and 0.01)")));
}

TEST_F(Inspect, CompareFindsARegressionInAFile) {
  std::vector<results::RunRecord> runs = results::read_runs(program_.folder() / "a.h5");
  ++runs[0].work[0].count;
  results::RunFile file(program_.folder() / "more.h5", {});
  for (const results::RunRecord& run : runs) file.add(run);
  const ProgramResult more = program_.run({"compare", "a.h5", "more.h5", "--no-times"});
  EXPECT_EQ(more.exit_code, 1);
  EXPECT_THAT(more.out, AllOf(HasSubstr("work: REGRESSION"), HasSubstr(runs[0].work[0].name)));
}

}  // namespace
}  // namespace drape::verify::inspect_test
