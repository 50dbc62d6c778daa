// What is installed, as others use it: the templates of plugins, and a program that links the libraries.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "bench/peers/peers.hpp"
#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/file/run_file.hpp"
#include "solver/base/input_file.hpp"
#include "solver/base/largest.hpp"
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
    forces_ = build("bench/plugin/template-force") / "libmine.so";
  }

  fs::path prefix() const { return folder_ / "prefix"; }
  std::string plugin() const { return plugin_; }
  std::string forces() const { return forces_; }

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
  std::string plugin_, forces_;
};

/// What it says where it has to refuse: one line.
std::string refusal(const Installed& installed, const BenchIntegrators& ours, const Words& arguments) {
  const ProgramResult result = installed.program(ours, arguments);
  EXPECT_EQ(result.exit_code, 2) << result.out;
  EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
  return result.err;
}

/// A plugin as another build would have made it: its hash of the headers in a folder is another. Returns the right one.
std::string write_of_another_build(const Installed& installed, const BenchIntegrators& ours, const std::string& plugin,
                                   const std::string& folder) {
  const fs::path header = installed.prefix() / "include/drape" / folder / "header_hash.hpp";
  const std::string hash = split(split(bytes_of(header), '"')[1], '\n')[0];
  EXPECT_EQ(hash.size(), 32u);
  std::string bytes = bytes_of(plugin);
  const std::size_t place = bytes.find(hash);
  EXPECT_NE(place, std::string::npos);
  if (place != std::string::npos) bytes.replace(place, 4, "0123");
  ours.write("other.so", bytes);
  return hash;
}

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
  const std::string said = "bench_integrators: other.so: expected a plugin built as this program is: ";
  const Words list = {"--plugin", "other.so", "list", "methods"};
  const std::string solver = write_of_another_build(installed, ours, installed.plugin(), "solver");
  EXPECT_THAT(refusal(installed, ours, list), StartsWith(said + "headers '" + solver + "', not '0123"));
  const std::string model = write_of_another_build(installed, ours, installed.forces(), "model");
  EXPECT_NE(model, solver);
  EXPECT_THAT(refusal(installed, ours, list), StartsWith(said + "headers of forces '" + model + "', not '0123"));
}

void expect_refusal_of_what_is_not_a_plugin(const Installed& installed) {
  const BenchIntegrators ours;
  ours.write("text.so", "text");
  const auto said = [&](const Words& files) {
    Words words;
    for (const std::string& file : files) words = words + Words{"--plugin", file};
    return refusal(installed, ours, words + Words{"list", "methods"});
  };
  EXPECT_THAT(said({"none.so"}), HasSubstr("none.so: "));
  EXPECT_THAT(said({"text.so"}), HasSubstr("text.so: cannot be loaded as a plugin: "));
  EXPECT_THAT(said({"/usr/lib/x86_64-linux-gnu/libm.so.6"}),
              HasSubstr("expected a library that ends in DRAPE_PLUGIN(rows) or DRAPE_FORCES(rows)"));
  const std::string mine = installed.plugin(), forces = installed.forces();
  EXPECT_THAT(said({mine, mine}), HasSubstr("libmine.so: method 'my-midpoint': there is one of this name"));
  EXPECT_THAT(said({forces, forces}), HasSubstr("libmine.so: force 'my-springs': there is one of this name"));
}

// --- Forces ------------------------------------------------------------------------------------------------------------------

/// A small sheet, hung by its corners, whose springs are those of the plugin; else those of the model.
std::string hung_sheet(bool mine) {
  return std::string("base = 'hung-corners'\nname = 'sheet'\ngrid.n = 6\nmaterial.damping = 5\nend.time = 0.1\n") +
         (mine ? "material.tension = 0\n[forces.my-springs]\nstiffness = 1e4\n" : "material.tension = 1e4\n");
}

/// Two halves of a sheet, sewn.
std::string sewn_sheet(bool mine) {
  const std::string half = "grid.n = [4, 5]\ngrid.size = [0.3, 0.4]\n";
  return hung_sheet(mine) + "[[panels]]\nname = 'one'\n" + half + "[[panels]]\nname = 'other'\nstart.position = [0.3, 0, 0]\n" +
         half +
         "[[seams]]\none = { panel = 'one', side = 'right' }\nother = { panel = 'other', side = 'left' }\n"
         "[[pins]]\npanel = 'one'\nwhere = 'left edge'\n";
}

std::vector<results::RunRecord> runs_of(const Installed& installed, const BenchIntegrators& ours, const std::string& scene,
                                        const Words& words) {
  ours.write("scene.toml", scene);
  const Words run = {"--plugin", installed.forces(), "run", "--scene", "scene.toml", "--repeat", "1", "--out"};
  static int count = 0;
  const std::string out = fmt::format("out-{}.h5", ++count);
  const ProgramResult result = installed.program(ours, run + Words{out} + words);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.exit_code == 0 ? results::read_runs(ours.folder() / out) : std::vector<results::RunRecord>();
}

/// To round-off: the order of sums is another.
void expect_same_motions(const std::vector<results::RunRecord>& mine, const std::vector<results::RunRecord>& built_in) {
  constexpr double round_off = 1e-9;
  ASSERT_EQ(mine.size(), built_in.size());
  for (std::size_t k = 0; k < mine.size(); ++k) {
    SCOPED_TRACE(mine[k].method);
    EXPECT_EQ(mine[k].outcome, solver::Outcome::success) << mine[k].message;
    EXPECT_LE((mine[k].final_state.x - built_in[k].final_state.x).cwiseAbs().maxCoeff(), round_off);
    EXPECT_LE((mine[k].final_state.v - built_in[k].final_state.v).cwiseAbs().maxCoeff(), round_off);
    ASSERT_EQ(mine[k].steps.size(), built_in[k].steps.size());
    double energy = 0;
    for (std::size_t step = 0; step < mine[k].steps.size(); ++step)
      energy = base::larger(energy, std::abs(mine[k].steps[step].potential_energy - built_in[k].steps[step].potential_energy));
    EXPECT_LE(energy, round_off);
  }
}

/// By its force alone, its exact Jacobian and its convex one.
void expect_motions_of_the_built_in_force(const Installed& installed) {
  const BenchIntegrators ours;
  const Words methods = {"--method", "verlet,ros34pw2,exponential-euler,bdf2/newton/cholesky", "--step", "0.005"};
  const auto mine = runs_of(installed, ours, hung_sheet(true), methods);
  const auto built_in = runs_of(installed, ours, hung_sheet(false), methods);
  expect_same_motions(mine, built_in);
  for (const results::RunRecord& run : mine) {
    EXPECT_THAT(run.plan, HasSubstr("forces: damping, shear, gravity, my-springs;"));
    EXPECT_GT(run.motion_error->position, 0);
  }
  const Words alone = {"--method", "verlet", "--step", "0.005", "--until", "0.02", "--no-reference"};
  expect_same_motions(runs_of(installed, ours, sewn_sheet(true), alone), runs_of(installed, ours, sewn_sheet(false), alone));
}

void expect_keys_of_the_force(const Installed& installed) {
  const BenchIntegrators ours;
  const Words loaded = {"--plugin", installed.forces()}, check = {"forces", "--format", "csv", "--scene"};
  EXPECT_THAT(installed.program(ours, loaded + Words{"list", "forces"}).out, HasSubstr("\nair\nmy-springs\n"));
  EXPECT_THAT(installed.program(ours, loaded + Words{"run", "--help"}).out, HasSubstr("forces.my-springs.stiffness"));
  const Words set = {"hung-corners", "--set", "forces.my-springs.stiffness=5"};
  const ProgramResult checked = installed.program(ours, loaded + check + set);
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_THAT(checked.out, testing::ContainsRegex("\nmy-springs,[1-9][^,]*e-[0-9]*,[1-9][^,]*e-[0-9]*,0,met: agrees\n"));

  const auto said = [&](const Words& plugin, const std::string& section) {
    ours.write("scene.toml", "base = 'hung-corners'\n" + section);
    return refusal(installed, ours, plugin + check + Words{"scene.toml"});
  };
  EXPECT_THAT(said({}, "[forces.my-springs]\nstiffness = 5"),
              testing::AllOf(HasSubstr("scene.toml:2: unknown key 'forces.my-springs'"), HasSubstr("--plugin")));
  EXPECT_THAT(refusal(installed, ours, check + set), HasSubstr("unknown key 'forces.my-springs.stiffness'"));
  EXPECT_THAT(said(loaded, "[forces.my-springs]\nstifness = 5"),
              HasSubstr("scene.toml:3: unknown key 'forces.my-springs.stifness' (did you mean forces.my-springs.stiffness?)"));
  EXPECT_THAT(said(loaded, "[forces.my-springs]"), HasSubstr("scene.toml:2: unknown key 'forces.my-springs'"));
  EXPECT_THAT(said(loaded, "forces.my-springs = 5"), HasSubstr("scene.toml:2: unknown key 'forces.my-springs'"));
  EXPECT_THAT(said(loaded, "[forces.my-springs]\nstiffness = -5"),
              HasSubstr("scene.toml:3: forces.my-springs.stiffness = -5: expected a number of at least 0"));
  EXPECT_THAT(said(loaded, "[forces.my-springs]\nstiffness = '5'"), HasSubstr("expected a number"));
  EXPECT_THAT(refusal(installed, ours, loaded + Words{"run", "--method", "energy-momentum", "--step", "0.01", "--scene"} + set),
              HasSubstr("expected elastic forces with mean forces, not my-springs"));
  if (!bench::peers::missing(*bench::peers::peer("petsc-bdf2").simulator).empty()) return;
  EXPECT_THAT(refusal(installed, ours, loaded + Words{"peers", "--peer", "petsc-bdf2", "--step", "0.01", "--scene"} + set),
              HasSubstr("petsc-bdf2: expected a scene without forces.my-springs"));
}

/// References depend on the force's parameters and on what computes it.
void expect_references_of_their_own(const Installed& installed) {
  const BenchIntegrators ours;
  ours.write("other.so", bytes_of(installed.forces()) + "other");
  const auto references_after = [&](const std::string& plugin, const Words& sets) {
    Words words = {"--plugin", plugin, "run", "--method", "verlet", "--step", "0.01", "--repeat", "1"};
    for (const std::string& set : Words{"grid.n=3", "end.time=0.02"} + sets) words = words + Words{"--set", set};
    const ProgramResult result = installed.program(ours, words + Words{"--scene", "hung-corners"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return std::distance(fs::directory_iterator(ours.cache()), fs::directory_iterator());
  };
  const std::string mine = installed.forces();
  EXPECT_EQ(references_after(mine, {"forces.my-springs.stiffness=5"}), 1);
  EXPECT_EQ(references_after(mine, {"forces.my-springs.stiffness=5"}), 1);
  EXPECT_EQ(references_after(mine, {"forces.my-springs.stiffness=6"}), 2);
  EXPECT_EQ(references_after("other.so", {"forces.my-springs.stiffness=5"}), 3);
  EXPECT_EQ(references_after(mine, {}), 4);
  EXPECT_EQ(references_after("other.so", {}), 4) << "the force has no part in it";
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
  expect_motions_of_the_built_in_force(installed);
  expect_keys_of_the_force(installed);
  expect_references_of_their_own(installed);
  expect_the_same_by_libraries(installed);
  expect_manual_and_completion(installed);
}

TEST(PluginTemplate, IsShort) {
  for (const char* project : {"template", "template-force"}) {
    std::size_t count = 0;
    for (const char* file : {"CMakeLists.txt", "mine.cpp"})
      count += lines(bytes_of(fs::path(DRAPE_SOURCE_DIR) / "bench/plugin" / project / file)).size();
    EXPECT_LT(count, 60u) << project;
  }
}

}  // namespace
}  // namespace drape::verify::plugin_test
