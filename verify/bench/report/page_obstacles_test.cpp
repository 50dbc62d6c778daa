// What the page draws of obstacles: surfaces once, vertices of each frame where they deform.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/report/base64.hpp"
#include "bench/report/obstacles.hpp"
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

}  // namespace
}  // namespace drape::verify::page_obstacles_test
