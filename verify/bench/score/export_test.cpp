// bench_integrators export: a scene as a benchmark for other simulators.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/file/hdf5.hpp"
#include "verify/support/bench_integrators.hpp"

namespace drape::verify::export_test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Key;
using testing::StartsWith;
namespace hdf5 = results::hdf5;

const Words soft{"--scene", "hung-edge", "--set", "grid.n=[4, 3]", "--set", "material.tension=200", "--set", "end.time=0.1"};

double kinetic_energy(const Eigen::VectorXd& mass, const solver::Vectors& v) {
  return 0.5 * mass.dot(v.rowwise().squaredNorm());
}

/// A frame of a dataset of positions or velocities.
solver::Vectors frame(const std::vector<double>& all, std::size_t k, Eigen::Index particles) {
  return Eigen::Map<const solver::Vectors>(all.data() + 3 * k * static_cast<std::size_t>(particles), particles, 3);
}

void expect_close(const json& measured, double value) {
  EXPECT_NEAR(measured.at("value").get<double>(), value, 1e-12 * std::abs(value) + 1e-15);
  EXPECT_GE(measured.at("uncertainty").get<double>(), 0);
  EXPECT_LT(measured.at("uncertainty").get<double>(), 1e-6);
}

/// What the file says of every frame is what our model says of the reference's.
void expect_observables(const json& scene, const model::Cloth& cloth, const hdf5::Handle& reference) {
  const auto times = hdf5::read_numbers<double>(reference, "time"), x = hdf5::read_numbers<double>(reference, "positions"),
             v = hdf5::read_numbers<double>(reference, "velocities");
  EXPECT_THAT(times, ElementsAre(0, 0.04, 0.08));
  EXPECT_EQ(scene.at("frame_times").get<std::vector<double>>(), times);
  ASSERT_EQ(scene.at("expected").size(), times.size());
  const Eigen::VectorXd& mass = cloth.ode.mass;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const json& expected = scene.at("expected")[k];
    const solver::Vectors position = frame(x, k, mass.size()), velocity = frame(v, k, mass.size());
    const double kinetic = kinetic_energy(mass, velocity), potential = cloth.ode.potential_energy(times[k], position);
    EXPECT_EQ(expected.at("time"), times[k]);
    expect_close(expected.at("kinetic_energy"), kinetic);
    expect_close(expected.at("potential_energy"), potential);
    expect_close(expected.at("total_energy"), kinetic + potential);
    expect_close(expected.at("lowest_point"), position.col(2).minCoeff());
    const Eigen::RowVector3d centre = mass.transpose() * position / mass.sum();
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(expected.at("centre_of_mass").at("value")[c].get<double>(), centre[c], 1e-14);
    EXPECT_EQ(expected.at("position_uncertainty"), hdf5::read_numbers<double>(reference, "uncertainty")[k]);
  }
}

TEST(Export, HasTheMeshThatIsDrawn) {
  const BenchIntegrators program;
  program.output(Words{"export"} + soft + Words{"--set", "trim.outline=true", "--out", "a"});
  const auto files = program.files();
  EXPECT_THAT(files.at("a/README.txt"), HasSubstr("\ntrimmed.obj "));
  EXPECT_THAT(files.at("a/trimmed.obj"), HasSubstr("\nv "));
  EXPECT_NE(files.at("a/trimmed.obj"), files.at("a/start.obj"));
  EXPECT_THAT(files.at("a/scene.toml"), HasSubstr("trim.outline = false"));
}

TEST(Export, HoldsAllThatAnotherSimulatorNeeds) {
  const BenchIntegrators program;
  program.output(Words{"export"} + soft + Words{"--out", "a/b"});
  const auto files = program.files();
  for (const char* name : {"README.txt", "scene.json", "scene.toml", "start.obj", "reference.h5"})
    EXPECT_THAT(files, testing::Contains(Key(std::string("a/b/") + name)));
  EXPECT_EQ(files.size(), 7u);  // with the two folders

  const model::Cloth cloth = model::compile(model::parse_scene(files.at("a/b/scene.toml"), "scene.toml"));
  const json scene = json::parse(files.at("a/b/scene.json"));
  const hdf5::Handle reference = hdf5::open_for_reading(program.folder() / "a/b/reference.h5");
  expect_observables(scene, cloth, reference);
  EXPECT_EQ(scene.at("particles").at("mass").get<std::vector<double>>(),
            std::vector<double>(cloth.ode.mass.begin(), cloth.ode.mass.end()));
  EXPECT_EQ(scene.at("material").at("tension").at("value"), json({200.0, 200.0}));
  EXPECT_EQ(scene.at("material").at("tension").at("unit"), "N/m");
  EXPECT_EQ(scene.at("pins").size(), cloth.ode.pins.size());
  EXPECT_EQ(scene.at("equations").at("forces").size(), cloth.plan.terms.size());
  EXPECT_THAT(files.at("a/b/README.txt"), HasSubstr("bench_integrators score --scene scene.toml --frame-time 0.04"));

  std::string start = "# t = 0 s\n";
  for (const auto& row : cloth.start.x.rowwise()) start += fmt::format("v {} {} {}\n", row[0], row[1], row[2]);
  EXPECT_THAT(files.at("a/b/start.obj"), StartsWith(start));
}

const std::string moved = R"(
name = "moved"
[grid]
n = 2
[material]
tension = 10
[[pins]]
particles = [[0, 1]]
directions = "xz"
velocity = [1, 5, -2]
[[obstacles]]
shape = "sphere"
radius = 0.25
position = [0.5, 0.5, 3]
friction = 0.5
[[obstacles]]
shape = "mannequin"
position = [0, 3, -3]
walk = 1
[end]
time = 0.02
)";

TEST(Export, TellsWherePinsAndObstaclesAre) {
  const BenchIntegrators program;
  program.write("moved.toml", moved);
  program.output({"export", "--scene", "moved.toml", "--every", "0.01", "--out", "a"});
  const auto files = program.files();
  const json scene = json::parse(files.at("a/scene.json"));
  EXPECT_EQ(scene.at("pins")[0].at("particle"), 2);
  EXPECT_EQ(scene.at("pins")[0].at("positions")[1], json({0.01, nullptr, -0.02}));
  EXPECT_EQ(scene.at("obstacles")[0].at("shape"), "sphere");
  EXPECT_EQ(scene.at("obstacles")[0].at("radius"), 0.25);
  EXPECT_EQ(scene.at("obstacles")[0].at("key_frames")[0].at("position"), json({0.5, 0.5, 3.0}));
  EXPECT_EQ(scene.at("contact").at("distance").at("unit"), "m");
  EXPECT_THAT(files.at("a/obstacle-0.obj"), HasSubstr("\nf "));
  EXPECT_FALSE(files.contains("a/obstacle-0-0001.obj")) << "its motion is in scene.json";
  EXPECT_EQ(files.at("a/obstacle-1-0000.obj"), files.at("a/obstacle-1.obj"));
  EXPECT_THAT(files.at("a/obstacle-1-0002.obj"), testing::AllOf(HasSubstr("# t = 0.02 s\n"), HasSubstr("\nf ")));
  EXPECT_NE(files.at("a/obstacle-1-0002.obj").substr(13), files.at("a/obstacle-1-0000.obj").substr(10)) << "it walks";
}

TEST(Export, LeavesNothingWhereItCannotBeDone) {
  const BenchIntegrators program;
  const auto complaint = [&](const Words& more) {
    const ProgramResult result = program.run(Words{"export"} + soft + more);
    EXPECT_EQ(lines(result.err).size(), 1u);
    EXPECT_EQ(result.out, "");
    return std::to_string(result.exit_code) + ": " + result.err;
  };
  EXPECT_THAT(complaint({"--out", "a", "--every", "0.2"}),
              HasSubstr("2: bench_integrators: --every: expected at most the scene's end"));
  EXPECT_THAT(complaint({"--out", "a", "--agreement", "1e-15"}),
              HasSubstr("1: bench_integrators: hung-edge: cvode-bdf and arkode-esdirk disagree"));
  EXPECT_THAT(complaint({"--out", "a", "--set", "pins=[{where = 'all', direction = [1, 1, 0]}]"}),
              HasSubstr("2: bench_integrators: hung-edge: expected pins along axes ('directions'), not 'direction'"));
  EXPECT_THAT(program.files(), IsEmpty());
  program.write("a", "");
  EXPECT_THAT(complaint({"--out", "a"}), HasSubstr("2: bench_integrators: a: expected a new or empty folder"));
  EXPECT_EQ(program.files().size(), 1u);
}

}  // namespace
}  // namespace drape::verify::export_test
