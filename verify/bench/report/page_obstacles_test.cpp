// What the page draws of obstacles: surfaces once, vertices of each frame where they deform.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "bench/report/base64.hpp"
#include "bench/report/obstacles.hpp"
#include "model/garment.hpp"
#include "model/scene_file/scene_file.hpp"
#include "verify/support/mesh_files.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::page_obstacles_test {
namespace {

using Json = nlohmann::ordered_json;

std::vector<float> numbers(const Json& packed) {
  const std::vector<std::byte> bytes = bench::bytes_of_base64(packed.get<std::string>());
  std::vector<float> all(bytes.size() / sizeof(float));
  std::memcpy(all.data(), bytes.data(), bytes.size());
  return all;
}

TEST(PageObstacles, HaveTheVerticesOfEachFrameWhereTheyDeform) {
  const base::TemporaryFolder folder;
  const model::TriangleMesh thin = box_mesh({1, 1, 1}), wide = box_mesh({3, 1, 1});
  const std::string one = folder / "0.ply", other = folder / "1.ply";
  write_mesh(one, thin);
  write_mesh(other, wide);
  const model::Scene scene = model::parse_scene(
      fmt::format("name = 'x'\ngrid.n = 2\nobstacles = [{{ shape = 'sphere', radius = 1 }}, {{ shape = 'mesh', file = '{0}', "
                  "frames = [{{ time = 0, file = '{0}' }}, {{ time = 1, file = '{1}' }}] }}]\n",
                  one, other),
      "a.toml");
  results::RunRecord run;
  run.scene = "x";
  for (const model::KeyValue& row : model::key_values(scene))
    run.scene_keys.push_back({row.key, model::to_toml(row.value), row.unit});
  const solver::State y{solver::Vectors::Constant(4, 3, 5), solver::Vectors::Zero(4, 3)};
  run.trajectory = {.nu = 2, .nv = 2, .panels = {}, .times = {0, 0.5, 2}, .states = {y, y, y}, .stretch = {}, .constraint = {}};
  Json surfaces = Json::array();
  const Json page = bench::page_obstacles(run, surfaces);
  EXPECT_THAT(page.at("missing"), testing::IsEmpty());
  ASSERT_EQ(page.at("drawn").size(), 2U);
  ASSERT_EQ(surfaces.size(), 2U);
  const Json& sphere = surfaces[0];
  EXPECT_EQ(numbers(sphere.at("vertices")).size(), 3 * sphere.at("count").get<std::size_t>());
  const Json& mesh = surfaces[page.at("drawn")[1].at("surface").get<std::size_t>()];
  EXPECT_EQ(mesh.at("count"), 8);
  const std::vector<float> places = numbers(mesh.at("vertices"));
  ASSERT_EQ(places.size(), 3U * 3 * 8);
  const double half_width[] = {0.5, 1, 1.5};
  for (std::size_t k = 0; k < places.size(); ++k)
    EXPECT_FLOAT_EQ(std::abs(places[k]), static_cast<float>(k % 3 == 0 ? half_width[k / 24] : 0.5)) << k;
  const double gap = std::sqrt(3.5 * 3.5 + 4.5 * 4.5 + 4.5 * 4.5);
  EXPECT_NEAR(page.at("clearance")[2].get<double>(), gap, 1e-12) << "from where it is then";
}

/// Three particles and weights of each vertex; why not, if the file is gone.
TEST(PageTrim, HasTheMeshInThePlaceOfTheGrid) {
  const base::TemporaryFolder folder;
  const std::string file = folder / "part.obj";
  write_mesh(file, {.name = "", .vertices = {{0.25, 0, 0}, {1, 0, 0}, {1, 1, 0}}, .triangles = {{0, 1, 2}}});
  const auto recorded = [](const std::string& lines) {
    const model::Scene scene = model::parse_scene("name = 'x'\ngrid.n = 2\n" + lines, "a.toml");
    results::RunRecord run;
    run.scene = "x";
    for (const model::KeyValue& row : model::key_values(scene))
      if (const auto* table = std::get_if<model::Entries>(&row.value))
        run.scene_keys.push_back({row.key, model::to_toml(*table), row.unit});
      else
        run.scene_keys.push_back({row.key, model::to_toml(row.value), row.unit});
    const int particles = model::Garment(scene).particles();
    const solver::State y{solver::Vectors::Zero(particles, 3), solver::Vectors::Zero(particles, 3)};
    run.trajectory = {.nu = 2, .nv = 2, .panels = {}, .times = {0}, .states = {y}, .stretch = {}, .constraint = {}};
    return run;
  };
  EXPECT_TRUE(bench::page_trim(recorded("")).is_null());
  for (const bool panels : {false, true}) {
    const std::string line = fmt::format("trim.file = '{}'\n", file);
    const results::RunRecord run = recorded(
        (panels ? "[[panels]]\nname = 'a'\n[[panels]]\nname = 'b'\n" : "") + line +
        (panels ? "[[obstacles]]\nshape = 'sphere'\nradius = 1\n" : "obstacles = [{ shape = 'sphere', radius = 1 }]\n"));
    const Json page = bench::page_trim(run);
    ASSERT_FALSE(page.contains("missing")) << page.at("missing");
    const std::vector<float> weights = numbers(page.at("weights"));
    ASSERT_EQ(weights.size(), panels ? 3U * (4 + 3) : 3U * 3);
    EXPECT_EQ(std::accumulate(weights.begin(), weights.end(), 0.0), panels ? 7 : 3);
    const float first = weights[panels ? 12 : 0];
    EXPECT_FLOAT_EQ(first, 0.75);
    std::filesystem::rename(file, file + ".gone");
    EXPECT_THAT(bench::page_trim(run).at("missing").get<std::string>(), testing::HasSubstr("part.obj"));
    Json surfaces = Json::array();
    const Json obstacles = bench::page_obstacles(run, surfaces);
    EXPECT_THAT(obstacles.at("missing"), testing::IsEmpty());
    EXPECT_EQ(obstacles.at("drawn").size(), 1U);
    std::filesystem::rename(file + ".gone", file);
  }
}

/// A cell above a bar, and two frames later in it: two virtual particles on either divided side, one for each edge of the bar.
TEST(PageRefined, HasVirtualParticlesOfEachFrame) {
  const auto recorded = [](const std::string& lines) {
    const model::Scene scene = model::parse_scene(
        "name = 'x'\ngrid = { n = 2, size = 1 }\n"
        "obstacles = [{ shape = 'box', size = [0.5, 2, 1], position = [0.5, 0.5, -1] }]\n" +
            lines,
        "a.toml");
    results::RunRecord run;
    run.scene = "x";
    for (const model::KeyValue& row : model::key_values(scene))
      run.scene_keys.push_back({row.key, model::to_toml(row.value), row.unit});
    solver::State above = model::start(scene), in = above;
    in.x.col(2).setConstant(-0.75);
    run.trajectory = {.nu = 2, .nv = 2, .panels = {}, .times = {0, 1}, .states = {above, in}, .stretch = {}, .constraint = {}};
    return run;
  };
  EXPECT_TRUE(bench::page_refined(recorded("")).is_null());
  const Json page = bench::page_refined(recorded("contact.adaptive = true\n"));
  ASSERT_EQ(page.size(), 2U);
  EXPECT_EQ(numbers(page[0].at("vertices")).size(), 0U);
  EXPECT_EQ(numbers(page[0].at("triangles")).size(), 6U);
  const std::vector<float> places = numbers(page[1].at("vertices"));
  ASSERT_GE(places.size(), 3U * 6);
  EXPECT_EQ(numbers(page[1].at("nearest")).size(), places.size() / 3);
  for (std::size_t k = 2; k < places.size(); k += 3) EXPECT_FLOAT_EQ(places[k], -0.5F) << "on top of the bar";
  EXPECT_GT(numbers(page[1].at("triangles")).size(), 6U);
}

}  // namespace
}  // namespace drape::verify::page_obstacles_test
