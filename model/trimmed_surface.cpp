#include "model/trimmed_surface.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <unsupported/Eigen/BVH>

#include "model/obstacles/surface.hpp"
#include "model/sheet/cells.hpp"

namespace drape::model {
namespace {

using Rectangle = Eigen::AlignedBox2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using RectangleTree = Eigen::KdBVH<double, 2, int>;

/// The halves of the cells of a grid, on its pattern.
class Halves {
 public:
  /// `reach`: how far outside of them places are found, in barycentric coordinates.
  Halves(const Grid& grid, double reach) : pattern_(grid.parameters()) {
    std::vector<Rectangle> boxes;
    for (const Cell& cell : cells(grid))
      for (const int side : {0, 1}) {
        const std::array<int, 3> corners{cell.corner[side][side], cell.corner[1][0], cell.corner[0][1]};
        Rectangle box;
        for (const int corner : corners) box.extend(place(corner));
        const Vector2d margin = reach * box.sizes();
        boxes.emplace_back(box.min() - margin, box.max() + margin);
        corners_.push_back(corners);
      }
    std::vector<int> order(boxes.size());
    std::iota(order.begin(), order.end(), 0);
    hierarchy_ = RectangleTree(order.begin(), order.end(), boxes.begin(), boxes.end());
  }

  /// The half in which a place lies deepest; weights of −infinity if none is near.
  TrimmedSurface::Vertex find(const Vector2d& p) const {
    Search search{*this, p};
    Eigen::BVIntersect(hierarchy_, search);
    return search.found;
  }

 private:
  struct Search {
    const Halves& halves;
    const Vector2d& p;
    TrimmedSurface::Vertex found{{0, 0, 0}, Vector3d::Constant(-HUGE_VAL)};

    // NOLINTBEGIN(readability-identifier-naming): names for Eigen
    bool intersectVolume(const Rectangle& box) const { return box.contains(p); }
    bool intersectObject(int half) {
      const Vector3d weights = halves.barycentric(half, p);
      if (weights.minCoeff() > found.weights.minCoeff()) found = {halves.corners_[half], weights};
      return false;  // there may be a deeper one
    }
    // NOLINTEND(readability-identifier-naming)
  };

  Vector2d place(int i) const { return pattern_.row(i).head<2>(); }

  Vector3d barycentric(int half, const Vector2d& p) const {
    const auto& [a, b, c] = corners_[half];
    Eigen::Matrix2d edges;
    edges << place(b) - place(a), place(c) - place(a);
    const Vector2d bc = edges.inverse() * (p - place(a));
    return {1 - bc.sum(), bc[0], bc[1]};
  }

  Vectors pattern_;
  std::vector<std::array<int, 3>> corners_;
  RectangleTree hierarchy_;
};

}  // namespace

TrimmedSurface::TrimmedSurface(const Grid& grid) : faces_(sheet_polygons(grid, grid.parameters()).faces) {
  for (int i = 0; i < grid.particles(); ++i) vertices_.push_back({{i, i, i}, {1, 0, 0}});
}

TrimmedSurface::TrimmedSurface(const Grid& grid, const TriangleMesh& pattern, double reach) {
  for (const auto& [a, b, c] : pattern.triangles) faces_.push_back({a, b, c});
  const Halves halves(grid, reach);
  const double flat = 1e-6 * std::max(grid.size_u, grid.size_v);
  for (std::size_t k = 0; k < pattern.vertices.size(); ++k) {
    const Vector3d& vertex = pattern.vertices[k];
    const auto refuse = [&](const char* expected) {
      throw std::invalid_argument(fmt::format("{}: vertex {} at [{:g}, {:g}, {:g}]: expected {}", pattern.name, k + 1,
                                              vertex.x(), vertex.y(), vertex.z(), expected));
    };
    if (!(std::abs(vertex.z()) <= flat)) refuse("a flat mesh, with z = 0");
    vertices_.push_back(halves.find(vertex.head<2>()));
    if (!(vertices_.back().weights.minCoeff() >= -reach)) refuse("vertices on the grid, in metres times trim.scale");
  }
}

void TrimmedSurface::add(const TrimmedSurface& other, int first) {
  const int before = static_cast<int>(vertices_.size());
  for (Vertex vertex : other.vertices_) {
    for (int& particle : vertex.particles) particle += first;
    vertices_.push_back(vertex);
  }
  for (std::vector<int> face : other.faces_) {
    for (int& corner : face) corner += before;
    faces_.push_back(std::move(face));
  }
}

Polygons TrimmedSurface::at(const Vectors& x) const {
  Polygons polygons{{}, faces_};
  for (const auto& [particles, weights] : vertices_) {
    Vector3d vertex = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) vertex += weights[k] * x.row(particles[k]).transpose();
    polygons.vertices.push_back(vertex);
  }
  return polygons;
}

}  // namespace drape::model
