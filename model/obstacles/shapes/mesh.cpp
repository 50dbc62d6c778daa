#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "model/obstacles/mesh_shape.hpp"
#include "model/obstacles/shapes/shape_kinds.hpp"
#include "solver/base/hash.hpp"
#include "solver/base/input_file.hpp"

namespace drape::model {
namespace {

struct Mesh : ShapeRule {
  std::string file;
  double scale = 1;

  std::unique_ptr<const Shape> make() const override { return mesh_shape(file, scale); }

  Polygons surface(double /*plane_side*/) const override {
    const TriangleMesh mesh = read_mesh(file);
    Polygons polygons;
    for (const Eigen::Vector3d& vertex : mesh.vertices) polygons.vertices.emplace_back(scale * vertex);
    for (const auto& [a, b, c] : mesh.triangles) polygons.faces.push_back({a, b, c});
    return polygons;
  }
};

/// XXH3 of the bytes of a file.
std::string checksum(const std::string& file) {
  try {
    return base::hash_text(base::content_of(file, most_mesh_bytes));
  } catch (const base::UnreadableFile& error) {
    throw std::invalid_argument(fmt::format("{}: {}: expected the mesh of an obstacle", file, error.what()));
  }
}

void read_mesh_file(const Value& value, ShapeRule& rule) {
  at<&Mesh::file>.in(rule) = value.input_file("the file of a mesh", most_mesh_bytes);
}

void read_checksum(const Value& value, ShapeRule& rule) {
  const std::string& file = at<&Mesh::file>.in(rule);
  if (value.text() != checksum(file)) value.fail(fmt::format("{}, that of {}", checksum(file), file));
}

constexpr Key<ShapeRule> mesh_keys[] = {
    {"file", "", "a closed mesh of triangles", read_mesh_file,
     [](const ShapeRule& rule) -> Data { return at<&Mesh::file>.in(rule); }, true},
    {"checksum", "", "of the file", read_checksum,  // behind the file, which it is about
     [](const ShapeRule& rule) -> Data { return checksum(at<&Mesh::file>.in(rule)); }},
    {"scale", "1", "metres for a unit of the file", at<&Mesh::scale>, check::positive},
};

}  // namespace

const ShapeKind shapes::mesh{.name = "mesh",
                             .description = "what the triangles of a file enclose",
                             .smooth = true,
                             .create = create<Mesh>,
                             .keys = keys_in<mesh_keys>};

}  // namespace drape::model
