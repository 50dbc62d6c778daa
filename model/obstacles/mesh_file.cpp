#include "model/obstacles/mesh_file.hpp"

#include <assimp/DefaultIOSystem.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "solver/base/input_file.hpp"

namespace drape::model {
namespace {

using Eigen::Affine3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

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

Vector3d to_vector(const aiVector3D& v) { return {v.x, v.y, v.z}; }

Quaterniond to_rotation(const aiQuaternion& q) { return Quaterniond(q.w, q.x, q.y, q.z).normalized(); }

Affine3d to_affine(const aiMatrix4x4& matrix) {
  using Rows = Eigen::Matrix<ai_real, 4, 4, Eigen::RowMajor>;
  return Affine3d(Eigen::Map<const Rows>(&matrix.a1).cast<double>());
}

using Placed = std::map<const aiNode*, Affine3d>;

/// Where a node and those below are in the scene; `local(node)`: in the one above.
template <class Local>
void place_nodes(const aiNode& node, const Affine3d& above, const Local& local, Placed& placed) {
  const Affine3d here = placed[&node] = above * local(node);
  for (const aiNode* below : std::span(node.mChildren, node.mNumChildren)) place_nodes(*below, here, local, placed);
}

/// A mesh of a file and the node that has it.
struct MeshPart {
  const aiNode& node;
  const aiMesh& mesh;
};

void add_parts(const aiScene& scene, const aiNode& node, std::vector<MeshPart>& parts) {
  for (const unsigned mesh : std::span(node.mMeshes, node.mNumMeshes)) parts.push_back({node, *scene.mMeshes[mesh]});
  for (const aiNode* below : std::span(node.mChildren, node.mNumChildren)) add_parts(scene, *below, parts);
}

using Faces = std::vector<std::vector<unsigned>>;

/// Those of all parts, whose vertices are counted through.
Faces faces_of(const std::vector<MeshPart>& parts) {
  Faces faces;
  unsigned first = 0;
  for (const auto& [node, mesh] : parts) {
    for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) {
      faces.emplace_back(face.mIndices, face.mIndices + face.mNumIndices);
      for (unsigned& corner : faces.back()) corner += first;
    }
    first += mesh.mNumVertices;
  }
  return faces;
}

/// Linear blend skinning: sets the vertices of a part to where its bones take them; vertices without bones stay. Throws
/// std::invalid_argument with `name` if a bone has no node.
void skin(const MeshPart& part, const Placed& placed, const std::string& name, std::span<Vector3d> vertices) {
  std::vector<Vector3d> sums(vertices.size(), Vector3d::Zero());
  std::vector<double> weights(vertices.size(), 0);
  for (const aiBone* bone : std::span(part.mesh.mBones, part.mesh.mNumBones)) {
    const auto node = std::ranges::find(placed, bone->mName, [](const auto& entry) { return entry.first->mName; });
    if (node == placed.end())
      throw std::invalid_argument(fmt::format("{}: expected a node of the bone '{}'", name, bone->mName.C_Str()));
    const Affine3d from_mesh = node->second * to_affine(bone->mOffsetMatrix);
    for (const auto& [vertex, weight] : std::span(bone->mWeights, bone->mNumWeights)) {
      sums[vertex] += weight * (from_mesh * to_vector(part.mesh.mVertices[vertex]));
      weights[vertex] += weight;
    }
  }
  for (std::size_t v = 0; v < vertices.size(); ++v)
    if (weights[v] > 0) vertices[v] = sums[v] / weights[v];
}

/// A file that assimp has read.
class MeshFile {
 public:
  explicit MeshFile(const std::string& file) {
    importer_.SetIOHandler(new RegularFiles);  // which it owns
    scene_ = importer_.ReadFile(file, 0);
    if (scene_ != nullptr) {
      faces_ = faces_of(parts());
      scene_ = importer_.ApplyPostProcessing(aiProcess_Triangulate);
    }
    if (scene_ == nullptr)
      throw std::invalid_argument(fmt::format("{}: cannot be read: expected a mesh: {}", file, importer_.GetErrorString()));
  }

  const aiScene& scene() const { return *scene_; }
  const Faces& faces() const { return faces_; }  ///< before they were cut into triangles

  std::vector<MeshPart> parts() const {
    std::vector<MeshPart> all;
    add_parts(*scene_, *scene_->mRootNode, all);
    return all;
  }

  template <class Local>
  Placed placed(const Local& local) const {
    Placed nodes;
    place_nodes(*scene_->mRootNode, Affine3d::Identity(), local, nodes);
    return nodes;
  }

  Placed at_rest() const {
    return placed([](const aiNode& node) { return to_affine(node.mTransformation); });
  }

  /// All vertices, in the order of the file, at rest or moved by bones. Throws std::invalid_argument with `name` unless they
  /// are finite.
  std::vector<Vector3d> vertices(const Placed& placed, bool skinned, const std::string& name) const {
    std::vector<Vector3d> all;
    for (const MeshPart& part : parts()) {
      const std::size_t first = all.size();
      for (const aiVector3D& v : std::span(part.mesh.mVertices, part.mesh.mNumVertices))
        all.emplace_back(placed.at(&part.node) * to_vector(v));
      if (skinned) skin(part, placed, name, std::span(all).subspan(first));
    }
    if (!std::ranges::all_of(all, [](const Vector3d& v) { return v.allFinite(); }))
      throw std::invalid_argument(name + ": expected finite coordinates");
    return all;
  }

 private:
  Assimp::Importer importer_;
  const aiScene* scene_ = nullptr;
  Faces faces_;
};

/// The mesh of a file: vertices in the same place are one vertex.
struct JoinedMesh {
  TriangleMesh mesh;
  std::vector<int> joined;  ///< which vertex those of the file are
};

JoinedMesh joined(const MeshFile& file, const std::string& name) {
  JoinedMesh all{{name, {}, {}}, {}};
  std::map<std::array<double, 3>, int> known;
  const Placed placed = file.at_rest();
  for (const Vector3d& v : file.vertices(placed, false, name)) {
    const auto [at, is_new] = known.try_emplace({v.x(), v.y(), v.z()}, static_cast<int>(all.mesh.vertices.size()));
    if (is_new) all.mesh.vertices.push_back(v);
    all.joined.push_back(at->second);
  }
  std::size_t first = 0;
  for (const auto& [node, mesh] : file.parts()) {
    const bool mirrors = placed.at(&node).linear().determinant() < 0;  // and turns the part inside out
    for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) {
      if (face.mNumIndices != 3) continue;  // a point or a line
      const auto corner = [&](int k) { return all.joined[first + face.mIndices[k]]; };
      std::array<int, 3> t{corner(0), corner(1), corner(2)};
      if (mirrors) std::swap(t[1], t[2]);
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) all.mesh.triangles.push_back(t);
    }
    first += mesh.mNumVertices;
  }
  if (all.mesh.triangles.empty()) throw std::invalid_argument(name + ": expected a mesh with triangles");
  return all;
}

/// The vertices of the mesh out of those of the file, at another time. Throws std::invalid_argument with `name` where vertices
/// that are one at rest part.
std::vector<Vector3d> vertices_of(const JoinedMesh& mesh, const std::vector<Vector3d>& of_file, const std::string& name) {
  constexpr double together = 1e-5;  // over the largest coordinate: they are in single precision
  std::vector<Vector3d> all(mesh.mesh.vertices.size());
  std::vector<bool> known(all.size(), false);
  double extent = 0;
  for (const Vector3d& v : of_file) extent = std::max(extent, v.cwiseAbs().maxCoeff());
  for (std::size_t k = 0; k < of_file.size(); ++k) {
    const int v = mesh.joined[k];
    if (!known[v]) all[v] = of_file[k];
    known[v] = true;
    if (const double apart = (of_file[k] - all[v]).norm(); apart > together * extent)
      throw std::invalid_argument(
          fmt::format("{}: expected vertices to stay together that are in one place in {}, not to be {:g} apart", name,
                      mesh.mesh.name, apart));
  }
  return all;
}

/// Throws std::invalid_argument with `name` unless vertices at key times fit into memory.
void require_room(double times, std::size_t vertices, const std::string& name) {
  constexpr double most = 5e7;  // positions, 1.2 GB
  if (!(times * static_cast<double>(vertices) <= most))
    throw std::invalid_argument(fmt::format("{}: expected at most {:g} positions, not those of {} vertices at {:g} times", name,
                                            most, vertices, times));
}

// --- Animations --------------------------------------------------------------------------------------------------------------

double ticks_per_second(const aiAnimation& animation) {
  constexpr double usual = 25;  // what assimp says of files that do not say it
  return animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : usual;
}

/// The animation with a name, or an index in digits.
const aiAnimation& find_animation(const MeshFile& file, const std::string& name, const std::string& wanted) {
  const std::span<aiAnimation* const> all(file.scene().mAnimations, file.scene().mNumAnimations);
  std::vector<std::string> names;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (wanted == all[k]->mName.C_Str()) return *all[k];
    names.push_back(fmt::format("\"{}\"", all[k]->mName.length > 0 ? all[k]->mName.C_Str() : fmt::to_string(k)));
  }
  for (std::size_t k = 0; k < all.size(); ++k)
    if (wanted == fmt::to_string(k)) return *all[k];
  throw std::invalid_argument(all.empty() ? fmt::format("{}: expected a file with animations, there are none", name)
                                          : fmt::format("{}: expected one of {}", name, fmt::join(names, ", ")));
}

/// The value of a channel, between its keys mixed; without keys `otherwise`.
template <class Key, class Value, class Mix>
Value value_at(std::span<const Key> keys, double ticks, const Value& otherwise, Value (*value)(const decltype(Key::mValue)&),
               const Mix& mix) {
  if (keys.empty()) return otherwise;
  const auto next = std::ranges::upper_bound(keys, ticks, {}, &Key::mTime);
  if (next == keys.begin()) return value(keys.front().mValue);
  if (next == keys.end()) return value(keys.back().mValue);
  const Key& last = *(next - 1);
  return mix(value(last.mValue), value(next->mValue), (ticks - last.mTime) / (next->mTime - last.mTime));
}

Affine3d animated(const aiNode& node, const aiNodeAnim& channel, double ticks) {
  aiVector3D scaling, position;
  aiQuaternion rotation;
  node.mTransformation.Decompose(scaling, rotation, position);
  const auto between = [](const Vector3d& a, const Vector3d& b, double part) -> Vector3d { return a + part * (b - a); };
  const auto vector_at = [&](const aiVectorKey* keys, unsigned count, const aiVector3D& otherwise) {
    return value_at(std::span(keys, count), ticks, to_vector(otherwise), to_vector, between);
  };
  const Quaterniond turn =
      value_at(std::span<const aiQuatKey>(channel.mRotationKeys, channel.mNumRotationKeys), ticks, to_rotation(rotation),
               to_rotation, [](const Quaterniond& a, const Quaterniond& b, double part) { return a.slerp(part, b); });
  return Eigen::Translation3d(vector_at(channel.mPositionKeys, channel.mNumPositionKeys, position)) * turn *
         Eigen::Scaling(vector_at(channel.mScalingKeys, channel.mNumScalingKeys, scaling));
}

/// Where the nodes of a file are at a time of an animation [ticks].
Placed placed_at(const MeshFile& file, const aiAnimation& animation, double ticks) {
  const std::span<aiNodeAnim* const> channels(animation.mChannels, animation.mNumChannels);
  return file.placed([&](const aiNode& node) {
    const auto channel = std::ranges::find(channels, node.mName, [](const aiNodeAnim* one) { return one->mNodeName; });
    return channel == channels.end() ? to_affine(node.mTransformation) : animated(node, **channel, ticks);
  });
}

/// From its start to the end of an animation [s].
std::vector<double> sample_times(const aiAnimation& animation, const AnimationRule& rule, std::size_t vertices,
                                 const std::string& name) {
  const double duration = animation.mDuration / ticks_per_second(animation);
  if (rule.start > 0 && !(rule.start < duration))
    throw std::invalid_argument(
        fmt::format("{}: expected obstacles.start before its end at {:g} s, not {:g} s", name, duration, rule.start));
  const double pieces = std::ceil((duration - rule.start) * rule.rate - 1e-9);
  require_room(pieces + 1, vertices, name);
  std::vector<double> times;
  for (int k = 0; k < pieces; ++k) times.push_back(rule.start + k / rule.rate);
  times.push_back(duration);
  return times;
}

}  // namespace

TriangleMesh read_mesh(const std::string& file) { return joined(MeshFile(file), file).mesh; }

KeyedMesh read_frames(const std::string& file, std::span<const FrameFile> frames) {
  const MeshFile first(file);
  const JoinedMesh mesh = joined(first, file);
  require_room(static_cast<double>(frames.size()), mesh.mesh.vertices.size(), file + ": obstacles.frames");
  KeyedMesh keyed{mesh.mesh, {}};
  for (const auto& [t, name] : frames) {
    const MeshFile frame(name);
    const std::string called = name + ": obstacles.frames";
    const std::vector<Vector3d> vertices = frame.vertices(frame.at_rest(), false, called);
    if (vertices.size() != mesh.joined.size())
      throw std::invalid_argument(
          fmt::format("{}: expected {} vertices as in {}, not {}", called, mesh.joined.size(), file, vertices.size()));
    if (frame.faces() != first.faces())
      throw std::invalid_argument(fmt::format("{}: expected the faces of {}, in their order", called, file));
    keyed.keys.push_back({t, called, vertices_of(mesh, vertices, called)});
  }
  return keyed;
}

KeyedMesh read_animation(const std::string& file, const AnimationRule& animation) {
  const MeshFile read(file);
  const std::string called = fmt::format("{}: obstacles.animation = '{}'", file, animation.name);
  const aiAnimation& found = find_animation(read, called, animation.name);
  if (found.mNumMeshChannels + found.mNumMorphMeshChannels > 0)
    throw std::invalid_argument(called + ": expected an animation of nodes and bones, not of morph targets");
  const JoinedMesh mesh = joined(read, file);
  KeyedMesh keyed{mesh.mesh, {}};
  for (const double t : sample_times(found, animation, mesh.mesh.vertices.size(), called)) {
    const std::string name = fmt::format("{} at {:g} s", called, t);
    const Placed placed = placed_at(read, found, t * ticks_per_second(found));
    keyed.keys.push_back({t - animation.start, name, vertices_of(mesh, read.vertices(placed, true, name), name)});
  }
  keyed.mesh.vertices = keyed.keys.front().vertices;
  return keyed;
}

}  // namespace drape::model
