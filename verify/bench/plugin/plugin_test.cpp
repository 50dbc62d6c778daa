// What is installed, as others use it: the template of a plugin, and a program that links the libraries.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/file/run_file.hpp"
#include "solver/base/input_file.hpp"
#include "solver/integrator.hpp"
#include "verify/support/bench_integrators.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::plugin_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

std::string bytes_of(const fs::path& file) { return base::content_of(file, std::uintmax_t{1} << 30); }

/// What is installed in a new folder, and projects of others that are built with it.
class Installed {
 public:
  Installed() {
    run({"--install", DRAPE_BINARY_DIR, "--prefix", prefix()});
    plugin_ = build("bench/plugin/template") / "libmine.so";
  }

  fs::path prefix() const { return folder_ / "prefix"; }
  std::string plugin() const { return plugin_; }

  /// Builds a project outside of the sources; returns its folder.
  fs::path build(const std::string& source) const {
    const fs::path target = folder_ / fs::path(source).filename();
    fs::copy(fs::path(DRAPE_SOURCE_DIR) / source, target);
    run({"-G", "Ninja", "-S", target, "-B", target / "build", "-D", "CMAKE_PREFIX_PATH=" + prefix().string()});
    run({"--build", target / "build"});
    return target / "build";
  }

  ProgramResult program(const BenchIntegrators& ours, const Words& arguments) const {
    Command command = ours.command(arguments);
    command.program = prefix() / "bin" / "bench_integrators";
    return run_program(command);
  }

 private:
  void run(const Words& arguments) const {
    const ProgramResult result = run_program({DRAPE_CMAKE, arguments, folder_ / ".", {}, {}});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  }

  base::TemporaryFolder folder_;
  std::string plugin_;
};

void expect_rows_of_the_built_in_method(const Installed& installed) {
  const BenchIntegrators ours;
  const std::string file = installed.plugin();
  EXPECT_THAT(installed.program(ours, {"--plugin", file, "list", "methods"}).out, HasSubstr("\nmy-midpoint\n"));
  const ProgramResult result =
      installed.program(ours, {"--plugin", file, "run", "--scene", "hung-corners", "--set", "grid.n=6", "--set",
                               "material.damping=5", "--until", "0.1", "--method", "midpoint,my-midpoint,my-midpoint/newton",
                               "--step", "0.01,0.005", "--repeat", "1", "--out", "out.h5"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // Their whole record, except names and times.
  const std::vector<results::RunRecord> runs = results::read_runs(ours.folder() / "out.h5");
  ASSERT_EQ(runs.size(), 6u);
  for (const std::size_t k : {0, 1}) {
    const results::RunRecord &built_in = runs[k], &mine = runs[k + 2];
    EXPECT_EQ(mine.method, "my-midpoint");
    EXPECT_EQ(mine.outcome, solver::Outcome::success);
    EXPECT_TRUE(mine.final_state.x == built_in.final_state.x && mine.final_state.v == built_in.final_state.v);
    EXPECT_EQ(mine.motion_error->position, built_in.motion_error->position);
    EXPECT_GT(mine.motion_error->position, 0);
    ASSERT_EQ(mine.work.size(), built_in.work.size());
    for (std::size_t i = 0; i < mine.work.size(); ++i)
      EXPECT_EQ(mine.work[i].count, built_in.work[i].count) << mine.work[i].name;
  }
  EXPECT_THAT(installed.program(ours, {"inspect", "out.h5"}).out, HasSubstr("libmine.so"));
}

void expect_order_and_amplification(const Installed& installed) {
  const BenchIntegrators ours;
  const std::string file = installed.plugin();
  const ProgramResult orders = installed.program(
      ours, {"--plugin", file, "study", "orders", "--quick", "--method", "midpoint,my-midpoint", "--format", "csv"});
  ASSERT_EQ(orders.exit_code, 0) << orders.err;
  EXPECT_THAT(orders.out, HasSubstr("soft,my-midpoint,"));
  EXPECT_THAT(orders.out, HasSubstr("2 as declared"));
  const ProgramResult modes = installed.program(ours, {"--plugin", file, "study", "modes", "--quick", "--format", "csv"});
  ASSERT_EQ(modes.exit_code, 0) << modes.err;
  EXPECT_THAT(modes.out, HasSubstr("my-midpoint"));
}

void expect_refusal_of_another_build(const Installed& installed) {
  const BenchIntegrators ours;
  std::string bytes = bytes_of(installed.plugin());
  const std::string hash = split(split(bytes_of(installed.prefix() / "include/drape/solver/header_hash.hpp"), '"')[1], '\n')[0];
  ASSERT_EQ(hash.size(), 32u);
  const std::size_t place = bytes.find(hash);
  ASSERT_NE(place, std::string::npos);
  bytes.replace(place, 4, "0123");
  ours.write("other.so", bytes);
  const ProgramResult result = installed.program(ours, {"--plugin", "other.so", "list", "methods"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, StartsWith("bench_integrators: other.so: expected a plugin built as this program is: headers '" +
                                     hash + "', not '0123"));
  EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
}

void expect_refusal_of_what_is_not_a_plugin(const Installed& installed) {
  const BenchIntegrators ours;
  ours.write("text.so", "text");
  const auto said = [&](const std::string& file) {
    const ProgramResult result = installed.program(ours, {"--plugin", file, "list", "methods"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
    return result.err;
  };
  EXPECT_THAT(said("none.so"), HasSubstr("none.so: "));
  EXPECT_THAT(said("text.so"), HasSubstr("text.so: cannot be loaded as a plugin: "));
  EXPECT_THAT(said("/usr/lib/x86_64-linux-gnu/libm.so.6"), HasSubstr("expected a library that ends in DRAPE_PLUGIN(rows)"));
  const std::string mine = installed.plugin();
  const ProgramResult twice = installed.program(ours, {"--plugin", mine, "--plugin", mine, "list", "methods"});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.err, HasSubstr("libmine.so: method 'my-midpoint': there is one of this name"));
}

void expect_the_same_by_libraries(const Installed& installed) {
  const ProgramResult result =
      run_program({installed.build("verify/bench/plugin/outside") / "outside", {}, installed.prefix(), {}, {}});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const model::Cloth cloth = model::compile(model::load_scene("hung-edge"));
  solver::Integrator integrator(cloth.ode, solver::method("bdf2"), {}, cloth.start);
  for (int k = 0; k < 10; ++k) integrator.step(0.01);
  EXPECT_EQ(result.out, fmt::format("{:.17g}\n", integrator.state().x.col(2).minCoeff()));
}

void expect_manual_and_completion(const Installed& installed) {
  EXPECT_THAT(bytes_of(installed.prefix() / "share/man/man1/bench_integrators.1"), StartsWith(".TH BENCH_INTEGRATORS 1"));
  EXPECT_THAT(bytes_of(installed.prefix() / "share/bash-completion/completions/bench_integrators"),
              HasSubstr("complete -F _drape bench_integrators"));
}

TEST(Installed, IsAllThatPluginsAndProgramsNeed) {  // one test, since installing and compiling take longer than the rest
  DRAPE_SLOW();
  const Installed installed;
  ASSERT_FALSE(HasFailure());
  expect_rows_of_the_built_in_method(installed);
  expect_order_and_amplification(installed);
  expect_refusal_of_another_build(installed);
  expect_refusal_of_what_is_not_a_plugin(installed);
  expect_the_same_by_libraries(installed);
  expect_manual_and_completion(installed);
}

TEST(PluginTemplate, IsShort) {
  std::size_t count = 0;
  for (const char* file : {"CMakeLists.txt", "mine.cpp"})
    count += lines(bytes_of(fs::path(DRAPE_SOURCE_DIR) / "bench/plugin/template" / file)).size();
  EXPECT_LT(count, 60u);
}

}  // namespace
}  // namespace drape::verify::plugin_test
