// bench_integrators score: what it says of motions whose errors are known.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "results/file/hdf5.hpp"
#include "results/file/motion_file.hpp"
#include "results/file/run_file.hpp"
#include "verify/support/bench_integrators.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::score_test {
namespace {

using nlohmann::json;
using results::Motion;
using solver::Vectors;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

const Words sheet{
    "--scene", "hung-edge",   "--set", "grid.n=[4, 3]", "--set", "material.tension=200", "--set", "material.damping=0.5",
    "--set",   "end.time=0.2"};
const Words beside{"--method", "imex-euler", "--repeat", "1"};  // ours cost the most

void write(const BenchIntegrators& program, const std::string& name, const Motion& motion) {
  const std::vector<double> none(motion.times.size());
  const auto bytes = results::to_bytes(results::ReferenceMotion{"", "", motion, none});
  base::publish(program.folder() / name, bytes, base::Existing::replace);
}

/// The motion in a file of the program.
Motion read(const BenchIntegrators& program, const std::string& name) {
  const auto file = results::hdf5::open_for_reading(program.folder() / name);
  const auto numbers = [&](const char* dataset) { return results::hdf5::read_numbers<double>(file, dataset); };
  const auto frames = [&](const std::vector<double>& all, std::size_t count) {
    std::vector<Vectors> list;
    const std::size_t size = all.size() / count;
    for (std::size_t k = 0; k < count; ++k)
      list.emplace_back(Eigen::Map<const Vectors>(all.data() + k * size, static_cast<Eigen::Index>(size / 3), 3));
    return list;
  };
  Motion motion{numbers("time"), {}, {}};
  motion.positions = frames(numbers("positions"), motion.times.size());
  motion.velocities = frames(numbers("velocities"), motion.times.size());
  return motion;
}

/// All tables.
json score(const BenchIntegrators& program, const Words& scene, const Words& files) {
  return json::parse(program.output(Words{"score"} + scene + beside + Words{"--format", "json"} + files));
}

json summary(const BenchIntegrators& program, const Words& scene, const Words& files) {
  return score(program, scene, files).at("score-summary")[0];
}

double number(const json& row, const char* column) { return row.at(column).get<double>(); }

/// A motion that is late by `delay`: it rests at its start before.
Motion delayed(const Motion& motion, std::size_t frames) {
  Motion late{motion.times, {}, {}};
  for (std::size_t k = 0; k < motion.times.size(); ++k) late.positions.push_back(motion.positions[k < frames ? 0 : k - frames]);
  return late;
}

TEST(Score, OfTheReferenceIsNothingAndOfADelayedOneItsDelay) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  program.output(Words{"export"} + sheet + Words{"--every", "0.01", "--out", "a"});
  const json with_velocities = score(program, sheet, {"a/reference.h5"}), &same = with_velocities.at("score-summary")[0];
  EXPECT_LE(number(same, "error"), number(same, "reference_error"));
  EXPECT_LE(std::abs(number(same, "lag")), number(same, "lag_uncertainty"));
  EXPECT_LT(number(same, "lag_uncertainty"), 1e-4);
  EXPECT_LE(std::abs(number(same, "damping")), number(same, "damping_uncertainty") + 1e-12);
  EXPECT_LT(number(same, "damping_uncertainty"), 1e-6);
  EXPECT_FALSE(same.contains("penetration"));
  EXPECT_EQ(same.at("velocities"), "the file");

  Motion motion = read(program, "a/reference.h5");
  write(program, "late.h5", delayed(motion, 3));
  const json late = summary(program, sheet, {"late.h5"});
  EXPECT_NEAR(number(late, "lag"), 0.03, 1e-5);
  EXPECT_GT(number(late, "mean_error"), 0.01);
  EXPECT_LT(number(late, "left"), 1e-5);
  EXPECT_NEAR(number(late, "damping"), 0, 1e-3);
  EXPECT_EQ(late.at("velocities"), "differences of the frames");

  write(program, "too-late.h5", delayed(motion, 10));
  EXPECT_DOUBLE_EQ(number(summary(program, sheet, {"too-late.h5"}), "lag"), 0.05);  // a quarter of it, no more is sought

  Motion damped = motion;
  for (std::size_t k = 0; k < motion.times.size(); ++k) damped.velocities[k] *= std::sqrt(1 - 0.5 * motion.times[k]);
  write(program, "damped.h5", damped);
  EXPECT_NEAR(number(summary(program, sheet, {"damped.h5"}), "damping"), 0.5, 1e-6);

  motion.velocities.clear();
  write(program, "positions.h5", motion);
  const json all = score(program, sheet, {"positions.h5"}), &positions = all.at("score-summary")[0];
  for (const std::size_t k : {0u, 5u, 20u}) {
    const double kinetic = number(with_velocities.at("score")[k], "kinetic");
    EXPECT_NEAR(number(all.at("score")[k], "kinetic"), kinetic, 2e-3 * kinetic + 1e-6) << k;
  }
  EXPECT_LE(std::abs(number(positions, "damping")), number(positions, "damping_uncertainty") + 1e-12);
}

/// A run with its motion, from a file.
results::RunRecord run(const BenchIntegrators& program, const Words& more) {
  program.output(Words{"run"} + sheet + Words{"--repeat", "1", "--out", "run.h5"} + more);
  return results::read_runs(program.folder() / "run.h5").at(0);
}

Motion motion_of(const results::RunRecord& run) {
  Motion motion{run.trajectory->times, {}, {}};
  for (const solver::State& y : run.trajectory->states) motion.positions.push_back(y.x), motion.velocities.push_back(y.v);
  return motion;
}

std::string obj(const Vectors& x) {
  std::string text;
  for (const auto& row : x.rowwise()) text += fmt::format("v {} {} {}\n", row[0], row[1], row[2]);
  return text + "f 1 2 3\n";
}

std::string ply(const Vectors& x) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "element face 1\nproperty list uint8 int32 vertex_indices\nend_header\n",
      x.rows());
  for (const auto& row : x.rowwise()) text += fmt::format("{} {} {}\n", row[0], row[1], row[2]);
  return text + "3 0 1 2\n";
}

std::string vtk(const Vectors& x) {
  std::string text =
      fmt::format("# vtk DataFile Version 3.0\nframe\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double\n", x.rows());
  for (const auto& row : x.rowwise()) text += fmt::format("{} {} {}\n", row[0], row[1], row[2]);
  return text + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n";
}

/// Other vertices first, then the particles in any order.
Vectors shuffled(const Vectors& x) {
  std::vector<int> order(static_cast<std::size_t>(x.rows()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::shuffle(order, std::mt19937(1));
  Vectors all(x.rows() + 2, 3);
  all << x.row(0) + Eigen::RowVector3d(0, 0, 1), x.row(1), x(order, Eigen::all);
  return all;
}

TEST(Score, OfARunIsWhatTheRunRecordsHoweverItIsWritten) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  const results::RunRecord euler = run(program, {"--method", "implicit-euler", "--step", "0.02", "--trajectory", "every=0.02"});
  const Motion motion = motion_of(euler);
  write(program, "euler.h5", motion);
  const json all = score(program, sheet, {"euler.h5", "--cost", "10", "--out", "s.h5"}), &row = all.at("score-summary")[0];
  EXPECT_NEAR(number(row, "end_error"), euler.error->rms, 2 * euler.error->reference_error);
  EXPECT_EQ(all.at("score").size(), 11u);
  EXPECT_NEAR(number(all.at("score")[10], "rms"), euler.error->rms, 2 * euler.error->reference_error);
  EXPECT_NEAR(number(all.at("score")[10], "kinetic"), euler.steps.back().kinetic_energy, 1e-12);
  EXPECT_NEAR(number(all.at("score")[10], "potential"), euler.steps.back().potential_energy, 1e-12);
  EXPECT_GT(number(row, "damping"), 0.1);

  const Words again = Words{"score"} + sheet + beside + Words{"--format", "json", "euler.h5", "--cost", "10", "--out", "s.h5"};
  EXPECT_EQ(json::parse(program.output(again + Words{"--resume"})), all);

  std::map<std::string, Words> meshes;
  const auto add = [&](const std::string& kind, std::size_t k, const std::string& text) {
    const std::string name = fmt::format("{}{}.{}", kind, k, kind.substr(0, 3));
    program.write(name, text);
    meshes[kind].insert(meshes[kind].begin(), name);  // the last one first: names are sorted
  };
  for (std::size_t k = 0; k < motion.times.size(); ++k) {
    const Vectors& x = motion.positions[k];
    add("obj", k, obj(x)), add("ply", k, ply(x)), add("vtk", k, vtk(x)), add("obj-shuffled", k, obj(shuffled(x)));
  }
  Motion positions = motion;
  positions.velocities.clear();
  write(program, "positions.h5", positions);
  json expected = summary(program, sheet, {"positions.h5"});
  expected.erase("file");
  for (const auto& [kind, files] : meshes) {
    json seen = summary(program, sheet, files + Words{"--frame-time", "0.02"});
    seen.erase("file");
    ASSERT_EQ(seen.size(), expected.size());
    for (const auto& [name, value] : expected.items())
      if (value.is_number())
        EXPECT_NEAR(seen.at(name).get<double>(), value.get<double>(), 1e-6 * std::abs(value.get<double>()) + 1e-12)
            << kind << name;
      else
        EXPECT_EQ(seen.at(name), value) << kind << name;
  }
}

TEST(Score, ComparesErrorAndCostWithOurs) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  const results::RunRecord bdf2 = run(program, {"--method", "bdf2", "--step", "0.01", "--trajectory", "every=0.02"});
  write(program, "bdf2.h5", motion_of(bdf2));
  const json all = json::parse(
      program.output(Words{"score"} + sheet +
                     Words{"--method", "implicit-euler,bdf2", "--repeat", "1", "--format", "json", "--cost", "10", "bdf2.h5"}));
  const double error = number(all.at("score-summary")[0], "error");
  std::map<std::string, double> least;  // of all that was tried, as no cost is that high
  for (const json& trial : all.at("score-trials"))
    if (trial.at("outcome") == "success") {
      const auto at = least.try_emplace(trial.at("method"), 1).first;
      at->second = std::min(at->second, number(trial, "error"));
    }
  ASSERT_EQ(all.at("score-ours").size(), 2u);
  int best = 0, best_at_cost = 0;
  for (const json& row : all.at("score-ours")) {
    EXPECT_LE(number(row, "error"), error * (1 + 1e-9));  // the same step is among them, and finer ones
    EXPECT_EQ(number(row, "cost_error"), least.at(row.at("method")));
    best += row.at("best") == "best", best_at_cost += row.at("cost_best") == "best";
  }
  EXPECT_EQ(best, 1);
  EXPECT_EQ(best_at_cost, 1);
}

TEST(Score, SeesHowDeepASheetIsInAnObstacle) {
  const BenchIntegrators program;
  program.write("floor.toml", R"(
name = "floor"
[grid]
n = 3
[material]
tension = 10
[forces]
gravity = [0, 0, -10]
[[obstacles]]
shape = "plane"
position = [0, 0, -0.1]
[end]
time = 0.02
)");
  const Words floor{"--scene", "floor.toml"};
  program.output(Words{"export"} + floor + Words{"--every", "0.01", "--out", "a"});
  Motion motion = read(program, "a/reference.h5");
  motion.positions[1].col(2).setConstant(-0.103);
  motion.positions[2].col(2).setConstant(-0.102);
  write(program, "deep.h5", motion);
  const json deep = summary(program, floor, {"deep.h5"});
  EXPECT_NEAR(number(deep, "penetration"), 3e-3, 1e-12);
  EXPECT_EQ(number(deep, "penetration_time"), 0.01);
  EXPECT_EQ(number(deep, "reference_penetration"), 0);
}

TEST(Score, SaysInOneLineWhatIsWrongWithAFile) {
  const BenchIntegrators program;
  const auto complaint = [&](const Words& words) {
    const ProgramResult result = program.run(Words{"score"} + sheet + words);
    EXPECT_EQ(result.exit_code, 2) << joined(words, " ");
    EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
    EXPECT_THAT(result.out, IsEmpty());
    return result.err;
  };
  Vectors x(12, 3);
  for (int i = 0; i < 12; ++i) x.row(i) << (i % 4) * 0.8 / 3, (i / 4) * 0.8 / 2, 0;
  const auto with = [&](const std::vector<double>& times, const auto& change) {
    Motion motion{times, std::vector<Vectors>(times.size(), x), {}};
    change(motion);
    write(program, "a.h5", motion);
    return complaint({"a.h5"});
  };
  const auto nothing = [](const Motion&) {};
  EXPECT_THAT(with({0, 0.1, 0.1}, nothing), HasSubstr("a.h5: frame 2 at 0.1 s: expected times that increase"));
  EXPECT_THAT(with({0, 0.1, 0.3}, nothing), HasSubstr("a.h5: frame 2 at 0.3 s: expected times up to the scene's end, 0.2 s"));
  EXPECT_THAT(with({0.1, 0.2}, nothing), HasSubstr("a.h5: expected a first frame at 0 s"));
  EXPECT_THAT(with({0, NAN}, nothing), HasSubstr("a.h5: time of frame 1: expected a number"));
  EXPECT_THAT(with({0}, nothing), HasSubstr("a.h5: expected at least two frames"));
  EXPECT_THAT(with({0, 0.1}, [](Motion& m) { m.positions[1](3, 1) = INFINITY; }),
              HasSubstr("a.h5: frame 1: expected finite positions"));
  EXPECT_THAT(with({0, 0.1}, [](Motion& m) { m.positions[0](5, 2) += 0.01; }),
              HasSubstr("a.h5: the first frame is not the scene's start: no vertex within 0.0027 m of particle (1, 1)"));
  program.write("text.h5", "no HDF5");
  EXPECT_THAT(complaint({"text.h5"}), HasSubstr("text.h5: cannot be read"));
  EXPECT_THAT(complaint({"none.h5"}), HasSubstr("none.h5: there is no such file"));
  program.write("0.obj", obj(x)), program.write("1.obj", obj(x.topRows(11))), program.write("2.ply", "no mesh");
  EXPECT_THAT(complaint({"0.obj", "1.obj"}), HasSubstr("mesh files need --frame-time"));
  EXPECT_THAT(complaint({"0.obj", "1.obj", "--frame-time", "0.1"}),
              HasSubstr("1.obj: expected 12 vertices as in 0.obj, not 11"));
  EXPECT_THAT(complaint({"0.obj", "2.ply", "--frame-time", "0.1"}), HasSubstr("2.ply: cannot be read as a mesh"));
  EXPECT_THAT(complaint({"a.h5", "--frame-time", "0.1"}), HasSubstr("--frame-time: an HDF5 file has its own times"));
  EXPECT_THAT(complaint({"a.h5", "--set", "pins=[{where = 'all', direction = [1, 1, 0]}]"}),
              HasSubstr("hung-edge: expected pins along axes ('directions'), not 'direction'"));
}

}  // namespace
}  // namespace drape::verify::score_test
