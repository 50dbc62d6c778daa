#include "model/obstacles/moving_mesh.hpp"

#include <algorithm>
#include <utility>

namespace drape::model {
namespace {

using Eigen::Vector3d;

/// Distance of the vertex that goes farthest.
double farthest_way(const std::vector<Vector3d>& from, const std::vector<Vector3d>& to) {
  double way = 0;
  for (std::size_t v = 0; v < from.size(); ++v) way = std::max(way, (to[v] - from[v]).norm());
  return way;
}

}  // namespace

MovingMesh::MovingMesh(TriangleMesh mesh, std::vector<KeyVertices> keys)
    : first_(std::move(mesh)), keys_(std::move(keys)), normals_(first_) {
  require_volume(first_);
  if (keys_.empty()) keys_.push_back({0, first_.name, first_.vertices});
  for (const KeyVertices& key : keys_) {
    require_volume({key.name, key.vertices, first_.triangles});
    for (const Vector3d& v : key.vertices) extent_ = std::max(extent_, v.cwiseAbs().maxCoeff());
    ways_.push_back(ways_.empty() ? 0 : ways_.back() + farthest_way(keys_[ways_.size() - 1].vertices, key.vertices));
  }
  first_.vertices = keys_.front().vertices;
}

double MovingMesh::within(double t) const { return std::clamp(t, keys_.front().t, keys_.back().t); }

MovingMesh::Moment MovingMesh::moment(double t) const {
  const auto next = std::ranges::upper_bound(keys_, t, {}, &KeyVertices::t);
  if (next == keys_.begin()) return {0, 0};
  const KeyVertices& last = *(next - 1);
  const double part = next == keys_.end() ? 0 : (t - last.t) / (next->t - last.t);
  return {static_cast<std::size_t>(next - keys_.begin()) - 1, part};
}

void MovingMesh::place(double t, std::vector<Vector3d>& vertices) const {
  const auto [key, part] = moment(t);
  const std::vector<Vector3d>& last = keys_[key].vertices;
  if (part == 0) {
    vertices = last;
    return;
  }
  const std::vector<Vector3d>& next = keys_[key + 1].vertices;
  for (std::size_t v = 0; v < last.size(); ++v) vertices[v] = last[v] + part * (next[v] - last[v]);
}

Vector3d MovingMesh::velocity(double t, int vertex) const {
  if (t < keys_.front().t || t >= keys_.back().t) return Vector3d::Zero();
  const std::size_t key = moment(t).key;
  const KeyVertices &last = keys_[key], &next = keys_[key + 1];
  return (next.vertices[vertex] - last.vertices[vertex]) / (next.t - last.t);
}

double MovingMesh::way(double t) const {
  const auto [key, part] = moment(t);
  return part == 0 ? ways_[key] : ways_[key] + part * (ways_[key + 1] - ways_[key]);
}

}  // namespace drape::model
