// Scenes with obstacles from mesh files: which file it is, and whether it is still the same.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "model/scene_file/scene_file.hpp"
#include "verify/support/mesh_files.hpp"
#include "verify/support/obstacles.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::mesh_scene_test {
namespace {

using model::Scene;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

/// A folder with a mesh, "meshes/box.ply", and a scene that names it relative to itself.
class MeshScene : public testing::Test {
 protected:
  MeshScene() {
    std::filesystem::create_directory(folder_ / "meshes");
    write_mesh(mesh_, box_mesh({2, 4, 6}));
    write_scene("scale = 0.25");
  }
  void write_scene(const std::string& line) const {
    std::ofstream(scene_) << "name = 'x'\n[[obstacles]]\nshape = 'mesh'\nfile = 'meshes/box.ply'\n" << line << "\n";
  }
  std::string refusal() const {
    try {
      model::load_scene(scene_);
    } catch (const model::SceneError& error) {
      return error.what();
    }
    return "";
  }

  base::TemporaryFolder folder_;
  std::string scene_ = folder_ / "scene.toml", mesh_ = folder_ / "meshes/box.ply";
};

TEST_F(MeshScene, NamesItsFileRelativeToItself) {
  const Scene scene = model::load_scene(scene_);
  EXPECT_EQ(value_of(scene.obstacles.at(0), "file"), "\"" + mesh_ + "\"");
  EXPECT_EQ(value_of(scene.obstacles.at(0), "scale"), "0.25");
  EXPECT_NEAR(model::Obstacle(scene.obstacles[0]).nearest({1, 0, 0}).distance, 0.75, 1e-15);
}

TEST_F(MeshScene, OfAnOverrideNamesItsFileRelativeToTheWorkingFolder) {
  const std::string relative = std::filesystem::relative(mesh_);
  const Scene scene =
      model::parse_scene("name = 'x'", "elsewhere/a.toml",
                         std::vector<model::Override>{{"obstacles", "[{shape='mesh', file='" + relative + "'}]"}});
  EXPECT_EQ(value_of(scene.obstacles.at(0), "file"), "\"" + mesh_ + "\"");
}

TEST_F(MeshScene, IsTheSameAfterWritingAndReadingElsewhere) {
  const std::string text = to_toml(model::load_scene(scene_));
  const Scene again = model::parse_scene(text, "elsewhere/a.toml");
  EXPECT_EQ(again.obstacles.at(0).kind->name, "mesh");
  EXPECT_EQ(value_of(again.obstacles[0], "file"), "\"" + mesh_ + "\"");
  EXPECT_EQ(value_of(again.obstacles[0], "scale"), "0.25");
  EXPECT_EQ(to_toml(again), text);
}

TEST_F(MeshScene, IsRefusedWhenItsMeshHasChanged) {
  const std::string text = to_toml(model::load_scene(scene_));
  EXPECT_THAT(text, HasSubstr("checksum = "));
  write_mesh(mesh_, box_mesh({2, 4, 8}));
  try {
    model::parse_scene(text, "a.toml");
    ADD_FAILURE() << "a mesh that has changed was not noticed";
  } catch (const model::SceneError& error) {
    EXPECT_THAT(error.what(),
                AllOf(StartsWith("a.toml:"), HasSubstr("obstacles.checksum = '"), EndsWith(", that of " + mesh_)));
  }
}

TEST_F(MeshScene, IsRefusedWhenItsMeshIsMissing) {
  const Scene scene = model::load_scene(scene_);
  std::filesystem::remove(mesh_);
  EXPECT_EQ(refusal(), scene_ + ":4: obstacles.file = 'meshes/box.ply': expected the file of a mesh, " + mesh_ +
                           ": there is no such file");
  EXPECT_THROW(to_toml(scene), std::invalid_argument);
}

TEST_F(MeshScene, IsRefusedWithoutAScaleOrWithAFolderForAMesh) {
  write_scene("scale = 0");
  EXPECT_EQ(refusal(), scene_ + ":5: obstacles.scale = 0: expected a number above 0");
  std::filesystem::remove(mesh_);
  std::filesystem::create_directory(mesh_);
  EXPECT_THAT(refusal(), HasSubstr("expected the file of a mesh"));
}

}  // namespace
}  // namespace drape::verify::mesh_scene_test
