#include "model/collision/cloth_surface.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "model/sheet/cells.hpp"

namespace drape::model {
namespace {

std::vector<std::array<int, 3>> halves_of_cells(const Garment& garment) {
  std::vector<std::array<int, 3>> all;
  for (const Garment::Panel& panel : garment.panels()) {
    const Grid& grid = panel.sheet.grid;
    for (const Cell& cell : cells(grid))
      for (const int side : {0, 1}) {
        const auto& c = cell.corner;
        all.push_back({panel.node(c[side][side]), panel.node(c[1 - side][side]), panel.node(c[side][1 - side])});
      }
    if (grid.nu == 1 || grid.nv == 1)
      for (const model::Edge& edge : edges(grid)) all.push_back({panel.node(edge.i), panel.node(edge.j), panel.node(edge.j)});
  }
  return all;
}

}  // namespace

ClothSurface::ClothSurface(const Garment& garment) : ClothSurface(halves_of_cells(garment), garment.start().x) {
  sewn_ = garment.sewn_nodes();
}

ClothSurface::ClothSurface(std::span<const std::array<int, 3>> corners, Vectors places) : places_(std::move(places)) {
  std::map<std::array<int, 2>, int> index;
  std::vector<bool> is_owned(static_cast<std::size_t>(places_.rows()), false);
  for (const std::array<int, 3>& c : corners) {
    Face& face = faces_.emplace_back(Face{c, {-1, -1, -1}, {-1, -1, -1}});
    int vertices = 0, edges = 0;
    for (int k = 0; k < (face.is_edge() ? 2 : 3); ++k)
      if (!is_owned[static_cast<std::size_t>(c[k])]) {
        is_owned[static_cast<std::size_t>(c[k])] = true;
        face.vertices[vertices++] = c[k];
      }
    for (int k = 0; k < (face.is_edge() ? 1 : 3); ++k) {
      const auto [low, high] = std::minmax(c[k], c[(k + 1) % 3]);
      const auto [found, is_new] = index.try_emplace({low, high}, static_cast<int>(edges_.size()));
      if (is_new) {
        edges_.push_back({{low, high}, false});
        face.edges[edges++] = found->second;
      }
      edges_[found->second].has_face |= !face.is_edge();
    }
  }
}

std::vector<std::array<int, 3>> ClothSurface::triangles() const {
  std::vector<std::array<int, 3>> all;
  for (const Face& face : faces_)
    if (!face.is_edge()) all.push_back(face.corners);
  return all;
}

std::vector<Eigen::Vector3d> ClothSurface::centres() const {
  std::vector<Eigen::Vector3d> all;
  for (int k = 0; k < static_cast<int>(faces_.size()); ++k) {
    const auto& [a, b, c] = corners(k, places_);
    all.emplace_back((a + b + c) / 3);
  }
  return all;
}

Corners ClothSurface::corners(int face, const Vectors& x) const {
  const auto& [a, b, c] = faces_[face].corners;
  return {x.row(a), x.row(b), x.row(c)};
}

bool ClothSurface::joined(int one, int other) const {
  return std::ranges::any_of(faces_[one].corners, [&](int i) {
    return std::ranges::any_of(faces_[other].corners, [&](int j) { return joined_nodes(i, j); });
  });
}

}  // namespace drape::model
