#include "verify/support/mesh_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

namespace drape::verify {
namespace {

using Eigen::Vector3d;
using model::TriangleMesh;

std::string numbers(const Vector3d& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string obj(const TriangleMesh& mesh) {
  std::string text;
  for (const Vector3d& v : mesh.vertices) text += "v " + numbers(v) + "\n";
  for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  return text;
}

std::string ply(const TriangleMesh& mesh) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face {}\n"
      "property list uchar int vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size());
  for (const Vector3d& v : mesh.vertices) text += numbers(v) + "\n";
  for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
  return text;
}

std::string stl(const TriangleMesh& mesh) {
  std::string text = "solid mesh\n";
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int v : triangle) text += "vertex " + numbers(mesh.vertices[v]) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid mesh\n";
}

template <class Number>
void append(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

const Vector3d shift(1, -2, 0.5);

/// Where nodes scale by 2, shift and perhaps mirror in x, this is what they make of the result: v.
void append_vertices(std::string& bytes, const TriangleMesh& mesh, double mirror) {
  for (const Vector3d& v : mesh.vertices)
    for (const double x : Vector3d((v - shift).cwiseProduct(Vector3d(mirror, 1, 1)) / 2)) append(bytes, static_cast<float>(x));
}

/// The vertices, the vertices mirrored, the triangles; those of the second half go round the other way.
std::string gltf_numbers(const TriangleMesh& mesh) {
  std::string bytes;
  append_vertices(bytes, mesh, 1);
  append_vertices(bytes, mesh, -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<int, 3> triangle = mesh.triangles[t];
    if (t >= mesh.triangles.size() / 2) std::swap(triangle[1], triangle[2]);
    for (const int v : triangle) append(bytes, static_cast<std::uint32_t>(v));
  }
  return bytes;
}

/// `uri`: empty or a property with a comma.
std::string gltf(const TriangleMesh& mesh, const std::string& uri) {
  const std::size_t v = mesh.vertices.size(), half = mesh.triangles.size() / 2, t = mesh.triangles.size();
  std::string text = fmt::format(R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
"nodes": [{{"children": [1, 2], "translation": [{}, {}, {}], "scale": [2, 2, 2]}}, {{"mesh": 0}},
          {{"mesh": 1, "scale": [-1, 1, 1]}}],
"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 2}}]}},
           {{"primitives": [{{"attributes": {{"POSITION": 1}}, "indices": 3}}]}}],
)",
                                 shift.x(), shift.y(), shift.z());
  text += fmt::format(R"("buffers": [{{{}"byteLength": {}}}],
"bufferViews": [{{"buffer": 0, "byteOffset": 0, "byteLength": {}}}, {{"buffer": 0, "byteOffset": {}, "byteLength": {}}}],
)",
                      uri, 24 * v + 12 * t, 24 * v, 24 * v, 12 * t);
  text += fmt::format(R"("accessors": [
{{"bufferView": 0, "byteOffset": 0, "componentType": 5126, "count": {0}, "type": "VEC3"}},
{{"bufferView": 0, "byteOffset": {1}, "componentType": 5126, "count": {0}, "type": "VEC3"}},
{{"bufferView": 1, "byteOffset": 0, "componentType": 5125, "count": {2}, "type": "SCALAR"}},
{{"bufferView": 1, "byteOffset": {3}, "componentType": 5125, "count": {4}, "type": "SCALAR"}}]}}
)",
                      v, 12 * v, 3 * half, 12 * half, 3 * (t - half));
  return text;
}

std::string glb(const TriangleMesh& mesh) {
  std::string text = gltf(mesh, "");
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string numbers = gltf_numbers(mesh);
  std::string bytes = "glTF";
  const auto append_size = [&](std::size_t size) { append(bytes, static_cast<std::uint32_t>(size)); };
  append_size(2);
  append_size(12 + 8 + text.size() + 8 + numbers.size());
  append_size(text.size());
  bytes += "JSON" + text;
  append_size(numbers.size());
  return bytes + std::string("BIN\0", 4) + numbers;
}

void write(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary);
  out.exceptions(std::ios::badbit | std::ios::failbit);
  out << bytes;
}

/// Splits every triangle in four at the middles of its edges.
TriangleMesh quartered(TriangleMesh mesh) {
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [known, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
    if (is_new) mesh.vertices.emplace_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
    return known->second;
  };
  for (const auto& [a, b, c] : std::exchange(mesh.triangles, {})) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    mesh.triangles.insert(mesh.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return mesh;
}

}  // namespace

void write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh) {
  const std::string format = file.extension();
  if (format == ".obj") {
    write(file, obj(mesh));
  } else if (format == ".ply") {
    write(file, ply(mesh));
  } else if (format == ".stl") {
    write(file, stl(mesh));
  } else if (format == ".gltf") {
    write(file, gltf(mesh, fmt::format("\"uri\": \"{}.bin\", ", file.stem().string())));
    write(std::filesystem::path(file).replace_extension(".bin"), gltf_numbers(mesh));
  } else if (format == ".glb") {
    write(file, glb(mesh));
  } else {
    throw std::invalid_argument(file.string() + ": expected .obj, .ply, .stl, .gltf or .glb");
  }
}

std::vector<Vector3d> random_points(int count, double extent, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-extent, extent);
  std::vector<Vector3d> points(static_cast<std::size_t>(count));
  for (Vector3d& p : points) p = {coordinate(random), coordinate(random), coordinate(random)};
  return points;
}

TriangleMesh box_mesh(const Vector3d& size) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.emplace_back(Vector3d(corner & 1, corner >> 1 & 1, corner >> 2 & 1).array() * size.array() -
                               size.array() / 2);
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh spiky_mesh(double radius) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  mesh = quartered(quartered(mesh));
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    mesh.vertices[v] = (mesh.vertices[v].normalized() * (v % 2 == 0 ? 1 : radius) * 1024).array().round() / 1024;
  return mesh;
}

}  // namespace drape::verify
