#include "model/outline_mesh.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "model/sheet/cut.hpp"

namespace drape::model {
namespace {

using Eigen::Vector2d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using FlatStructure =
    CGAL::Triangulation_data_structure_2<CGAL::Delaunay_mesh_vertex_base_2<Kernel>, CGAL::Delaunay_mesh_face_base_2<Kernel>>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, FlatStructure>;
using SizeCriteria = CGAL::Delaunay_mesh_size_criteria_2<Triangulation>;

/// Points of a piece, from its first on without its last.
void add_points(const CurvePiece& piece, int parts, std::vector<Vector2d>& all) {
  if (piece.kind == CurvePiece::Kind::polyline) {
    all.insert(all.end(), piece.points.begin(), piece.points.end() - 1);
    return;
  }
  const Curve curve({piece});
  for (int k = 0; k < parts; ++k) all.push_back(curve.at(k / double(parts)));
}

/// Points of a side with this number of cells.
void add_side(const std::vector<CurvePiece>& side, int cells, bool backwards, std::vector<Vector2d>& all) {
  const double length = Curve(side).length();
  std::vector<Vector2d> points;
  for (const CurvePiece& piece : side) {
    const double share = piece.cells > 0 ? piece.cells : cells * Curve({piece}).length() / length;
    add_points(piece, std::max(1, static_cast<int>(std::lround(2 * share))), points);
  }
  points.push_back(side.back().points.back());
  if (backwards) std::ranges::reverse(points);
  all.insert(all.end(), points.begin(), points.end() - 1);
}

/// The border counterclockwise, or clockwise where the sides are so.
std::vector<Vector2d> border_of(const Grid& grid, double spacing) {
  std::vector<Vector2d> all;
  if (grid.is_cut()) {
    for (const CurvePiece& piece : grid.cut)
      add_points(piece, std::max(1, static_cast<int>(std::lround(2 * Curve({piece}).length() / spacing))), all);
    return all;
  }
  const Outline sides = grid.outline.given() ? grid.outline : parallelogram({grid.size_u, 0}, {0, grid.size_v});
  add_side(sides.lower, grid.nu - 1, false, all);
  add_side(sides.right, grid.nv - 1, false, all);
  add_side(sides.upper, grid.nu - 1, true, all);
  add_side(sides.left, grid.nv - 1, true, all);
  return all;
}

}  // namespace

TriangleMesh outline_mesh(const Grid& grid) {
  const double cells = std::max(1, (grid.nu - 1) * (grid.nv - 1));
  const double spacing = std::sqrt(grid.quad_areas(grid.parameters()).sum() / cells);
  Triangulation triangulation;
  std::vector<Triangulation::Vertex_handle> border;
  for (const Vector2d& point : border_of(grid, spacing)) border.push_back(triangulation.insert({point.x(), point.y()}));
  for (std::size_t k = 0; k < border.size(); ++k) {
    const Triangulation::Vertex_handle& to = border[(k + 1) % border.size()];
    if (border[k] != to) triangulation.insert_constraint(border[k], to);
  }
  constexpr double least_angle = 0.125;  // the square of the sine: 20.7 degrees, for which refinement ends
  CGAL::refine_Delaunay_mesh_2(triangulation, SizeCriteria(least_angle, 1.4 * spacing));

  TriangleMesh mesh{"the outline", {}, {}};
  std::map<Triangulation::Vertex_handle, int> number;
  const auto number_of = [&](const Triangulation::Vertex_handle& vertex) {
    const auto [found, is_new] = number.try_emplace(vertex, static_cast<int>(mesh.vertices.size()));
    if (is_new) mesh.vertices.emplace_back(vertex->point().x(), vertex->point().y(), 0);
    return found->second;
  };
  for (const auto& face : triangulation.finite_face_handles())
    if (face->is_in_domain())
      mesh.triangles.push_back({number_of(face->vertex(0)), number_of(face->vertex(1)), number_of(face->vertex(2))});
  return mesh;
}

}  // namespace drape::model
