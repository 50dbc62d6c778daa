// Flat meshes as cloths: their own patterns, hung by two corners; and meshes of PLY.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "model/scene_file/scene_file.hpp"
#include "verify/support/pattern_files.hpp"

namespace drape::verify::cloth_mesh_test {
namespace {

using Eigen::Vector3d;
using model::Scene;
using testing::HasSubstr;

/// A rectangle of 0.6 m x 0.4 m in cells of 0.1 m, of two triangles each.
struct Mesh {
  std::vector<Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;

  template <class Place>
  explicit Mesh(Place place) {
    constexpr int nu = 6, nv = 4;
    for (int b = 0; b <= nv; ++b)
      for (int a = 0; a <= nu; ++a) vertices.push_back(place(0.1 * a, 0.1 * b));
    for (int b = 0; b < nv; ++b)
      for (int a = 0; a < nu; ++a) {
        const int k = a + (nu + 1) * b;
        triangles.push_back({k, k + 1, k + nu + 2});
        triangles.push_back({k, k + nu + 2, k + nu + 1});
      }
  }

  std::string obj() const {
    std::string text;
    for (const Vector3d& v : vertices) text += fmt::format("v {:.6g} {:.6g} {:.6g}\n", v.x(), v.y(), v.z());
    for (const auto& [a, b, c] : triangles) text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
    return text;
  }

  std::string header(const char* format) const {
    return fmt::format(
        "ply\nformat {} 1.0\ncomment by hand\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        format, vertices.size(), triangles.size());
  }

  std::string ply() const {
    std::string text = header("ascii");
    for (const Vector3d& v : vertices) text += fmt::format("{:.6g} {:.6g} {:.6g}\n", v.x(), v.y(), v.z());
    for (const auto& [a, b, c] : triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
    return text;
  }

  std::string binary_ply() const {
    std::string text = header("binary_little_endian");
    const auto add = [&](auto number) { text.append(reinterpret_cast<const char*>(&number), sizeof number); };
    for (const Vector3d& v : vertices)
      for (const double c : v) add(static_cast<float>(c));
    for (const auto& triangle : triangles) {
      add(static_cast<unsigned char>(3));
      for (const int corner : triangle) add(corner);
    }
    return text;
  }
};

const Mesh lying([](double u, double v) -> Vector3d { return {u, v, 1}; });
const Mesh upright([](double u, double v) -> Vector3d { return {u, 0.5, v}; });

Scene scene_of(const std::string& name, const std::string& text, double spacing = 0.1) {
  const model::SewnPattern sewn = model::sew(pattern_of(name, text), spacing);
  return model::parse_scene(model::to_toml(sewn), name);
}

/// Where the particles that are pinned begin.
std::vector<Vector3d> pinned(const Scene& scene) {
  std::vector<Vector3d> places;
  const solver::Vectors x = model::start(scene).x;
  for (const solver::Pin& pin : model::pins(scene)) places.emplace_back(x.row(pin.particle));
  return places;
}

void expect_sheet(const Scene& scene, const Vector3d& one, const Vector3d& other, const std::string& what) {
  EXPECT_EQ(scene.sheet.grid.particles(), 7 * 5) << what;
  EXPECT_TRUE(scene.panels.empty() && scene.obstacles.empty());
  const std::vector<Vector3d> held = pinned(scene);
  ASSERT_EQ(held.size(), 2u) << what;
  constexpr double single = 1e-6;
  const auto is_at = [&](const Vector3d& place) {
    return std::ranges::any_of(held, [&](const Vector3d& any) { return (any - place).norm() < single; });
  };
  EXPECT_TRUE(is_at(one) && is_at(other)) << what << ": " << held[0].transpose() << ", " << held[1].transpose();
}

TEST(ClothMesh, OfOneFlatPieceHangsByItsUpperOrRearCorners) {
  for (const auto& [name, lies, stands] : {std::tuple("cloth.obj", lying.obj(), upright.obj()),
                                           {"cloth.ply", lying.ply(), upright.ply()},
                                           {"cloth.ply", lying.binary_ply(), upright.binary_ply()}}) {
    expect_sheet(scene_of(name, lies), {0, 0.4, 1}, {0.6, 0.4, 1}, name);
    expect_sheet(scene_of(name, stands), {0, 0.5, 0.4}, {0.6, 0.5, 0.4}, name);
  }
}

/// Where it lies, turned as it likes, and from whichever side its triangles are seen.
TEST(ClothMesh, BeginsWhereItsVerticesAre) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vector3d(2, 1, -1).normalized()).toRotationMatrix();
  Mesh mesh([&](double u, double v) -> Vector3d { return turn * Vector3d(u, v, 0) + Vector3d(1, 2, 3); });
  for (int side = 0; side < 2; ++side) {
    const Scene scene = scene_of("turned.ply", mesh.ply());
    const solver::Vectors x = model::start(scene).x;
    for (const Vector3d& vertex : mesh.vertices)
      EXPECT_LT((x.rowwise() - vertex.transpose()).rowwise().norm().minCoeff(), 2e-5);
    for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  }
}

/// The corners of every triangle, as STL has them.
TEST(ClothMesh, OfSeparateTrianglesIsJoined) {
  std::string text;
  int count = 0;
  for (const auto& triangle : lying.triangles) {
    for (const int corner : triangle) {
      const Vector3d& v = lying.vertices[static_cast<std::size_t>(corner)];
      text += fmt::format("v {:.6g} {:.6g} {:.6g}\n", v.x(), v.y(), v.z());
    }
    text += fmt::format("f {} {} {}\n", count + 1, count + 2, count + 3);
    count += 3;
  }
  expect_sheet(scene_of("soup.obj", text), {0, 0.4, 1}, {0.6, 0.4, 1}, "soup");
}

/// Two panels that are one edge in space; vertices are written once for each place on the pattern.
TEST(ClothMesh, OfPlyMayHaveTextureCoordinates) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty double x\nproperty double y\nproperty double z\nproperty double s\n"
      "property double t\nelement face 2\nproperty list uchar uint vertex_index\nend_header\n"
      "0 0 0 0 0\n1 0 0 1 0\n1 0 1 1 1\n0 0 1 0 1\n"
      "1 0 0 3 0\n2 0 0 4 0\n2 0 1 4 1\n1 0 1 3 1\n4 0 1 2 3\n4 4 5 6 7\n";
  const model::SewingPattern pattern = pattern_of("two.ply", text);
  EXPECT_EQ(pattern.panels.size(), 2u);
  EXPECT_EQ(pattern.stitches.size(), 1u);
}

TEST(ClothMesh, WhatIsWrongIsSaidInOneLine) {
  const auto scaled = [](double factor) {
    return Mesh([=](double u, double v) -> Vector3d { return {factor * u, factor * v, 0}; });
  };
  const auto obj = [](const std::string& text) { return pattern_error("cloth.obj", text); };
  const auto ply = [](const std::string& text) { return pattern_error("cloth.ply", text); };
  EXPECT_EQ(obj(lying.obj()), "no error");
  EXPECT_THAT(obj(scaled(1000).obj()), HasSubstr("cloth.obj: expected vertices in metres, not a cloth 600 m long: these may be "
                                                 "millimetres, to be divided by 1000"));
  EXPECT_THAT(ply(scaled(100).ply()), HasSubstr("cloth.ply: expected vertices in metres, not a cloth 60 m long: these may be "
                                                "centimetres, to be divided by 100"));
  const Mesh draped([](double u, double v) -> Vector3d { return {u, v, u * v}; });
  EXPECT_THAT(obj(draped.obj()),
              HasSubstr("cloth.obj: expected texture coordinates, which are those of the pattern, or a flat mesh, "
                        "not one that is up to 0.0"));
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0 0\nv 0.5 0.5 0\n";
  EXPECT_EQ(obj(corners + "f 1 2 3 4\n"), "no error") << "polygons are divided";
  EXPECT_THAT(obj(corners + "f 1 2 3 4\nf 1 5 2\n"), HasSubstr("cloth.obj:8: expected a triangle that has an area"));
  EXPECT_THAT(obj(corners + "f 1 2 3\nf 1 2 4\nf 1 2 6\n"), HasSubstr("cloth.obj:9: expected edges of at most two triangles"));
  EXPECT_THAT(obj(corners + "f 1 2 7\n"), HasSubstr("cloth.obj:7: '7': expected one of the 6 vertices before it"));
  EXPECT_THAT(ply("solid\n"), HasSubstr("cloth.ply:1: expected a PLY, which begins with \"ply\""));
  EXPECT_THAT(ply("ply\nformat binary_big_endian 1.0\n"),
              HasSubstr("cloth.ply:2: 'binary_big_endian': expected the format ascii or binary_little_endian"));
  EXPECT_THAT(ply("ply\nformat ascii 1.0\nelement vertex many\n"),
              HasSubstr("cloth.ply:3: expected an element and its number"));
  EXPECT_THAT(ply("ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n"),
              HasSubstr("cloth.ply:4: 'half': expected a type"));
  EXPECT_THAT(ply("ply\nproperty float x\n"), HasSubstr("cloth.ply:2: expected an element before its properties"));
  EXPECT_THAT(ply("ply\nformat ascii 1.0\n"), HasSubstr("cloth.ply:3: expected more lines, as the header says"));
  const std::string text = lying.ply(), binary = lying.binary_ply();
  EXPECT_THAT(ply(text.substr(0, text.size() - 8)), HasSubstr("cloth.ply:93: "));
  EXPECT_THAT(ply(text.substr(0, text.find("3 0 1 8")) + "3 0 1 35\n" + text.substr(text.find("3 0 8 7"))),
              HasSubstr("cloth.ply:46: 35: expected one of the vertices 0 to 34, which come first"));
  EXPECT_THAT(ply(text.substr(0, text.find("0 0 1")) + "0 0 nan\n" + text.substr(text.find("0.1 0 1"))),
              HasSubstr("cloth.ply:11: expected"));
  EXPECT_THAT(ply(binary.substr(0, binary.size() - 5)),
              HasSubstr("cloth.ply: face 47: expected more bytes, as the header says"));
  EXPECT_THAT(ply(text.substr(0, text.find("3 0 1 8"))), HasSubstr("cloth.ply:46: expected more lines"));
}

}  // namespace
}  // namespace drape::verify::cloth_mesh_test
