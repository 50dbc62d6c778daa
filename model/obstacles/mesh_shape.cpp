#include "model/obstacles/mesh_shape.hpp"

#include <assimp/DefaultIOSystem.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <stdexcept>
#include <unsupported/Eigen/BVH>
#include <utility>
#include <vector>

#include "solver/base/input_file.hpp"

namespace drape::model {
namespace {

using Eigen::Affine3d;
using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using Hierarchy = Eigen::KdBVH<double, 3, int>;

/// What a mesh's file names, as its materials, is opened only if it ends.
class RegularFiles : public Assimp::DefaultIOSystem {
 public:
  bool Exists(const char* file) const override {  // NOLINT(readability-identifier-naming): for Assimp, which would open it
    try {
      base::require_input_file(file, most_mesh_bytes);
      return true;
    } catch (const base::UnreadableFile&) {
      return false;
    }
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {  // NOLINT(readability-identifier-naming)
    return Exists(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
  }
};

/// Joins the parts of a mesh that are read one after another: vertices in the same place are one vertex.
class Joined {
 public:
  explicit Joined(const std::string& file) { mesh_.name = file; }

  /// A part as a node places it; a node that mirrors turns it inside out.
  void add(const aiMesh& part, const Affine3d& placed) {
    std::vector<int> vertices;
    for (const aiVector3D& v : std::span(part.mVertices, part.mNumVertices))
      vertices.push_back(vertex(placed * Vector3d(v.x, v.y, v.z)));
    const bool mirrors = placed.linear().determinant() < 0;
    for (const aiFace& face : std::span(part.mFaces, part.mNumFaces)) {
      if (face.mNumIndices != 3) continue;  // a point or a line
      std::array<int, 3> t{vertices[face.mIndices[0]], vertices[face.mIndices[1]], vertices[face.mIndices[2]]};
      if (mirrors) std::swap(t[1], t[2]);
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh_.triangles.push_back(t);
    }
  }
  TriangleMesh done() { return std::move(mesh_); }

 private:
  int vertex(const Vector3d& v) {
    if (!v.allFinite()) throw std::invalid_argument(mesh_.name + ": expected finite coordinates");
    const auto [known, is_new] = vertices_.try_emplace({v.x(), v.y(), v.z()}, static_cast<int>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(v);
    return known->second;
  }

  TriangleMesh mesh_;
  std::map<std::array<double, 3>, int> vertices_;
};

/// Adds all parts of a node and of the nodes below. (Assimp's PreTransformVertices would do so, but leaves mirrored parts
/// inside out.)
void add(Joined& joined, const aiScene& scene, const aiNode& node, const Affine3d& above) {
  using Rows = Eigen::Matrix<ai_real, 4, 4, Eigen::RowMajor>;
  const Affine3d placed = above * Affine3d(Eigen::Map<const Rows>(&node.mTransformation.a1).cast<double>());
  for (const unsigned part : std::span(node.mMeshes, node.mNumMeshes)) joined.add(*scene.mMeshes[part], placed);
  for (const aiNode* below : std::span(node.mChildren, node.mNumChildren)) add(joined, scene, *below, placed);
}

}  // namespace

TriangleMesh read_mesh(const std::string& file) {
  Assimp::Importer importer;
  importer.SetIOHandler(new RegularFiles);  // which it owns
  const aiScene* scene = importer.ReadFile(file, aiProcess_Triangulate);
  if (scene == nullptr)
    throw std::invalid_argument(fmt::format("{}: cannot be read: expected a mesh: {}", file, importer.GetErrorString()));
  Joined joined(file);
  add(joined, *scene, *scene->mRootNode, Affine3d::Identity());
  TriangleMesh mesh = joined.done();
  if (mesh.triangles.empty()) throw std::invalid_argument(file + ": expected a mesh with triangles");
  return mesh;
}

namespace {

/// What the hierarchy is asked for: the nearest triangle so far.
struct Search {
  using Scalar = double;  // for Eigen
  const std::vector<Corners>& triangles;
  const Vector3d& p;
  double squared_distance = std::numeric_limits<double>::infinity();
  int triangle = 0;
  TrianglePoint nearest{};

  double minimumOnVolume(const AlignedBox3d& volume) const { return volume.squaredExteriorDistance(p); }  // NOLINT: for Eigen
  double minimumOnObject(int t) {                                                                         // NOLINT: for Eigen
    const TrianglePoint candidate = nearest_on_triangle(triangles[t], p);
    const double squared = (p - candidate.point).squaredNorm();
    if (squared < squared_distance) {
      squared_distance = squared;
      triangle = t;
      nearest = candidate;
    }
    return squared;
  }
};

class MeshShape : public Shape {
 public:
  explicit MeshShape(const TriangleMesh& mesh) : normals_(pseudo_normals(mesh)) {
    std::vector<AlignedBox3d> boxes;
    for (const std::array<int, 3>& triangle : mesh.triangles) {
      const auto& [a, b, c] = triangles_.emplace_back(corners(mesh, triangle));
      boxes.push_back(AlignedBox3d(a).extend(b).extend(c));
    }
    std::vector<int> order(boxes.size());
    std::iota(order.begin(), order.end(), 0);
    hierarchy_ = Hierarchy(order.begin(), order.end(), boxes.begin(), boxes.end());
    for (const Vector3d& v : mesh.vertices) extent_ = std::max(extent_, v.cwiseAbs().maxCoeff());
  }

  Nearest nearest(const Vector3d& p) const override {
    Search search{triangles_, p};
    Eigen::BVMinimize(hierarchy_, search);
    const auto& [point, part] = search.nearest;
    const Vector3d& n = normals_[search.triangle][part];
    const Vector3d away = p - point;
    if (part == face_part) return {n.dot(away), n};
    const double distance = std::copysign(away.norm(), n.dot(away));
    // On the surface p and the nearest point differ by round-off, which has no direction.
    if (std::abs(distance) <= 1e-10 * extent_) return {distance, n};
    return {distance, away / distance};
  }

 private:
  std::vector<Corners> triangles_;
  std::vector<std::array<Vector3d, parts_of_triangle>> normals_;
  Hierarchy hierarchy_;
  double extent_ = 0;  ///< largest coordinate
};

}  // namespace

std::unique_ptr<const Shape> mesh_shape(const std::string& file, double scale) {
  TriangleMesh mesh = read_mesh(file);
  for (Vector3d& v : mesh.vertices) v *= scale;
  turn_outward(mesh);
  return std::make_unique<MeshShape>(mesh);
}

}  // namespace drape::model
