#include "model/pattern/garment_mesh.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "model/keys/scene_error.hpp"
#include "model/pattern/readers.hpp"
#include "solver/base/disjoint_sets.hpp"

namespace drape::model {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// --- Islands -----------------------------------------------------------------------------------------------------------------

using VertexPair = std::pair<int, int>;

double signed_area(const GarmentMesh& mesh, const MeshFace& face) {
  const auto& [a, b, c] = face.places;
  const Vector2d p = mesh.places[b] - mesh.places[a], q = mesh.places[c] - mesh.places[a];
  return (p.x() * q.y() - p.y() * q.x()) / 2;
}

/// A line of the border of an island, counterclockwise on the pattern.
struct BorderLine {
  std::array<int, 2> places, vertices;   ///< its ends
  std::optional<EdgeOfPanel> sewn = {};  ///< the line of a border that is the same edge in space
  bool ends_edge = false;                ///< whether an edge of the panel ends with it
};

/// Faces that hang together on the pattern.
struct Island {
  std::vector<const MeshFace*> faces;
  std::map<int, int> vertex_of = {};    ///< in space, of each place
  std::vector<BorderLine> border = {};  ///< one after the other
};

std::vector<Island> islands_of(const GarmentMesh& mesh) {
  base::DisjointSets sets(static_cast<int>(mesh.faces.size()));
  std::map<VertexPair, int> first;  // the face that has an edge
  for (int k = 0; k < static_cast<int>(mesh.faces.size()); ++k)
    for (int side = 0; side < 3; ++side) {
      const auto& places = mesh.faces[k].places;
      const auto [found, is_new] = first.try_emplace(std::minmax(places[side], places[(side + 1) % 3]), k);
      if (!is_new) sets.join(found->second, k);
    }
  std::map<int, std::size_t> number;
  std::vector<Island> islands;
  for (int k = 0; k < static_cast<int>(mesh.faces.size()); ++k) {
    const auto [found, is_new] = number.try_emplace(sets.root(k), islands.size());
    if (is_new) islands.emplace_back();
    islands[found->second].faces.push_back(&mesh.faces[k]);
  }
  return islands;
}

/// Throws unless all triangles of an island show the same face and have an area. Returns whether it is the other face.
bool is_mirrored(const GarmentMesh& mesh, const Island& island) {
  constexpr double flattest = 1e-9;  // of the square of a side
  std::size_t mirrored = 0;
  for (const MeshFace* face : island.faces) {
    const auto& [a, b, c] = face->places;
    const double longest =
        std::max({(mesh.places[b] - mesh.places[a]).squaredNorm(), (mesh.places[c] - mesh.places[b]).squaredNorm(),
                  (mesh.places[a] - mesh.places[c]).squaredNorm()});
    const double area = signed_area(mesh, *face);
    if (!(std::abs(area) > flattest * longest)) mesh.fail(face->line, "expected a triangle that has an area on the pattern");
    mirrored += area < 0;
  }
  const bool most = 2 * mirrored > island.faces.size();
  for (const MeshFace* face : island.faces)
    if ((signed_area(mesh, *face) < 0) != most)
      mesh.fail(face->line, "the triangle is turned over on the pattern: expected all of its island to show the same face");
  return most;
}

/// The lines that belong to one triangle only, one after the other. Throws unless the island is a disc.
void find_border(const GarmentMesh& mesh, Island& island) {
  const int line = island.faces.front()->line;
  const bool mirrored = is_mirrored(mesh, island);
  std::map<VertexPair, int> uses;
  std::map<int, int>& vertex_of = island.vertex_of;
  for (const MeshFace* face : island.faces)
    for (int side = 0; side < 3; ++side) {
      vertex_of[face->places[side]] = face->vertices[side];
      if (++uses[std::minmax(face->places[side], face->places[(side + 1) % 3])] > 2)
        mesh.fail(face->line, "expected edges of at most two triangles on the pattern");
    }
  std::map<int, int> next;
  for (const MeshFace* face : island.faces)
    for (int side = 0; side < 3; ++side) {
      int from = face->places[side], to = face->places[(side + 1) % 3];
      if (uses[std::minmax(from, to)] > 1) continue;
      if (mirrored) std::swap(from, to);
      if (!next.emplace(from, to).second) mesh.fail(face->line, "expected an island that is a disc, its border touches itself");
    }
  const auto euler = static_cast<std::ptrdiff_t>(vertex_of.size()) - static_cast<std::ptrdiff_t>(uses.size()) +
                     static_cast<std::ptrdiff_t>(island.faces.size());
  for (int at = next.empty() ? 0 : next.begin()->first; !next.empty();) {
    const auto found = next.find(at);
    if (found == next.end()) break;
    island.border.push_back({{at, found->second}, {vertex_of[at], vertex_of[found->second]}});
    at = found->second;
    next.erase(found);
  }
  if (euler != 1 || !next.empty())
    mesh.fail(line, "the island of this face: expected a disc, with one border and without holes");
}

double turn_behind(const GarmentMesh& mesh, const BorderLine& line, const BorderLine& following) {
  const Vector2d p = mesh.places[line.places[1]] - mesh.places[line.places[0]];
  const Vector2d q = mesh.places[following.places[1]] - mesh.places[following.places[0]];
  return std::atan2(p.x() * q.y() - p.y() * q.x(), p.dot(q));
}

/// Joins the lines of borders that are the same edge in space.
void find_sewn(const GarmentMesh& mesh, std::vector<Island>& islands) {
  std::map<VertexPair, std::vector<EdgeOfPanel>> lines;
  for (std::size_t panel = 0; panel < islands.size(); ++panel)
    for (std::size_t k = 0; k < islands[panel].border.size(); ++k) {
      const auto& [from, to] = islands[panel].border[k].vertices;
      lines[std::minmax(from, to)].push_back({panel, k});
    }
  for (const auto& [ends, same] : lines) {
    if (same.size() > 2)
      throw SceneError(fmt::format("{}: vertices {} and {}: expected at most two pieces of cloth along an edge, not {}",
                                   mesh.file, ends.first + 1, ends.second + 1, same.size()));
    if (same.size() < 2) continue;
    islands[same[0].panel].border[same[0].edge].sewn = same[1];
    islands[same[1].panel].border[same[1].edge].sewn = same[0];
  }
}

/// Whether the lines of both go the same way in space.
bool same_way(const BorderLine& one, const BorderLine& other) { return one.vertices[0] == other.vertices[0]; }

bool same_line(const EdgeOfPanel& one, const EdgeOfPanel& other) { return one.panel == other.panel && one.edge == other.edge; }

/// Edges end where the border turns, and where what is sewn to it does.
void divide_borders(const GarmentMesh& mesh, std::vector<Island>& islands) {
  constexpr double corner = std::numbers::pi / 6;
  const auto line_of = [&](const EdgeOfPanel& at) -> BorderLine& { return islands[at.panel].border[at.edge]; };
  const auto follower = [&](const EdgeOfPanel& at) -> EdgeOfPanel {
    return {at.panel, (at.edge + 1) % islands[at.panel].border.size()};
  };
  const auto each_line = [&](const auto& act) {
    for (std::size_t panel = 0; panel < islands.size(); ++panel)
      for (std::size_t k = 0; k < islands[panel].border.size(); ++k) act(EdgeOfPanel{panel, k});
  };
  // The line behind which the same point is on the other side of a seam, if the seam goes on there.
  const auto across = [&](const EdgeOfPanel& at) -> std::optional<EdgeOfPanel> {
    const BorderLine &line = line_of(at), &following = line_of(follower(at));
    if (!line.sewn || !following.sewn) return {};
    const bool along = same_way(line, line_of(*line.sewn)), follows = same_way(following, line_of(*following.sewn));
    const EdgeOfPanel first = along ? *line.sewn : *following.sewn, second = follower(first);
    const EdgeOfPanel& expected = along ? *following.sewn : *line.sewn;
    if (along != follows || !same_line(second, expected) || same_line(first, at)) return {};
    return first;
  };
  each_line([&](const EdgeOfPanel& at) {
    BorderLine& line = line_of(at);
    const BorderLine& following = line_of(follower(at));
    const bool is_free = !line.sewn && !following.sewn;
    line.ends_edge = std::abs(turn_behind(mesh, line, following)) > corner || (!is_free && !across(at));
  });
  each_line([&](const EdgeOfPanel& at) {
    if (const auto other = across(at); other && line_of(at).ends_edge) line_of(*other).ends_edge = true;
  });
}

// --- Panels ------------------------------------------------------------------------------------------------------------------

/// Rotation and position of the panel that come nearest to its places in space: least squares without strain [Kabsch 1976].
void fit_to_space(const GarmentMesh& mesh, const Island& island, PatternPanel& panel) {
  Vector3d middle = Vector3d::Zero(), drawn_middle = Vector3d::Zero();
  const auto upright = [&](int place) -> Vector3d { return {mesh.places[place].x(), 0, mesh.places[place].y()}; };
  for (const auto& [at, vertex] : island.vertex_of) middle += mesh.vertices[vertex], drawn_middle += upright(at);
  const auto count = static_cast<double>(island.vertex_of.size());
  middle /= count, drawn_middle /= count;
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (const auto& [at, vertex] : island.vertex_of)
    products += (mesh.vertices[vertex] - middle) * (upright(at) - drawn_middle).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) *= -1;
  panel.rotation = u * svd.matrixV().transpose();
  panel.position = middle - panel.rotation * drawn_middle;
}

/// The edges of an island, and which of them each line of its border became part of.
std::vector<std::size_t> add_edges(const GarmentMesh& mesh, const Island& island, PatternPanel& panel) {
  const std::size_t count = island.border.size();
  std::vector<std::size_t> edge_of(count);
  std::size_t first = 0;
  while (first < count && !island.border[first].ends_edge) ++first;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = (first + 1 + k) % count;
    const BorderLine& line = island.border[at];
    if (k == 0 || island.border[(at + count - 1) % count].ends_edge)
      panel.edges.push_back({{CurvePiece::Kind::polyline, {mesh.places[line.places[0]]}}, std::to_string(panel.edges.size())});
    panel.edges.back().curve.points.push_back(mesh.places[line.places[1]]);
    edge_of[at] = panel.edges.size() - 1;
  }
  return edge_of;
}

double length_of(const GarmentMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices) box.extend(vertex);
  return box.sizes().maxCoeff();
}

void check_length(const GarmentMesh& mesh) {
  constexpr double longest = 20, longest_of_centimetres = 200;
  const double length = length_of(mesh);
  if (length > longest)
    throw SceneError(fmt::format("{}: expected vertices in metres, not a cloth {:.4g} m long: {}", mesh.file, length,
                                 length > longest_of_centimetres ? "these may be millimetres, to be divided by 1000"
                                                                 : "these may be centimetres, to be divided by 100"));
}

/// Without texture coordinates the pattern is the mesh itself, if it is flat: seen from the front or, if it lies, from above.
void lay_flat(GarmentMesh& mesh) {
  constexpr double flat = 1e-4;  // of its length: files have six digits
  weld(mesh);
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& vertex : mesh.vertices) middle += vertex / static_cast<double>(mesh.vertices.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& vertex : mesh.vertices) spread += (vertex - middle) * (vertex - middle).transpose();
  Vector3d normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  double off = 0;
  for (const Vector3d& vertex : mesh.vertices) off = std::max(off, std::abs(normal.dot(vertex - middle)));
  if (off > flat * length_of(mesh))
    throw SceneError(
        fmt::format("{}: expected texture coordinates, which are those of the pattern, or a flat mesh, not one that "
                    "is up to {:.3g} m off a plane",
                    mesh.file, off));
  constexpr double steep = 0.7;
  const Vector3d up = std::abs(normal.z()) < steep ? Vector3d::UnitZ() : Vector3d::UnitY();
  const Vector3d v = (up - up.dot(normal) * normal).normalized();
  Vector3d u = v.cross(normal);
  if (u.x() + u.y() < 0) u = -u;
  for (const Vector3d& vertex : mesh.vertices) mesh.places.emplace_back(u.dot(vertex), v.dot(vertex));
  for (MeshFace& face : mesh.faces) face.places = face.vertices;
}

/// Texture coordinates are often parts of a picture.
void check_units(const GarmentMesh& mesh) {
  double drawn = 0, worn = 0;
  for (const MeshFace& face : mesh.faces) {
    const auto& [a, b, c] = face.vertices;
    drawn += std::abs(signed_area(mesh, face));
    worn += (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm() / 2;
  }
  if (!(drawn > worn / 4 && drawn < 4 * worn))
    throw SceneError(
        fmt::format("{}: expected vertices and texture coordinates in metres, the pattern has {:.3g} m², the "
                    "garment in space {:.3g} m²",
                    mesh.file, drawn, worn));
}

}  // namespace

void weld(GarmentMesh& mesh) {
  std::map<std::array<double, 3>, int> known;
  std::vector<int> welded;
  std::vector<Vector3d> vertices;
  for (const Vector3d& v : mesh.vertices) {
    const auto [at, is_new] = known.try_emplace({v.x(), v.y(), v.z()}, static_cast<int>(vertices.size()));
    if (is_new) vertices.push_back(v);
    welded.push_back(at->second);
  }
  mesh.vertices = std::move(vertices);
  for (MeshFace& face : mesh.faces)
    for (int& corner : face.vertices) corner = welded[static_cast<std::size_t>(corner)];
}

SewingPattern read_garment_mesh(const std::string& file) {
  GarmentMesh mesh = file.ends_with(".ply") ? read_ply(file) : read_obj(file);
  check_length(mesh);
  if (mesh.places.empty()) lay_flat(mesh);
  std::vector<Island> islands = islands_of(mesh);
  if (islands.size() > most_panels)
    throw SceneError(fmt::format("{}: expected at most {} islands, not {}", mesh.file, most_panels, islands.size()));
  for (Island& island : islands) find_border(mesh, island);
  check_units(mesh);
  find_sewn(mesh, islands);
  divide_borders(mesh, islands);

  SewingPattern pattern{mesh.file, std::filesystem::path(file).stem().string(), {}, {}};
  std::vector<std::vector<std::size_t>> edges;
  for (const Island& island : islands) {
    PatternPanel& panel =
        pattern.panels.emplace_back(PatternPanel{fmt::format("island {}", pattern.panels.size()), {}, {}, {}});
    edges.push_back(add_edges(mesh, island, panel));
    fit_to_space(mesh, island, panel);
    make_counterclockwise(panel, fmt::format("{}: {}", mesh.file, panel.name));
  }
  for (std::size_t panel = 0; panel < islands.size(); ++panel)
    for (std::size_t k = 0; k < islands[panel].border.size(); ++k) {
      const BorderLine& line = islands[panel].border[k];
      if (!line.sewn || !line.ends_edge) continue;
      const EdgeOfPanel one{panel, edges[panel][k]}, other{line.sewn->panel, edges[line.sewn->panel][line.sewn->edge]};
      if (std::pair(one.panel, one.edge) > std::pair(other.panel, other.edge)) continue;
      pattern.stitches.push_back({one, other, same_way(line, islands[line.sewn->panel].border[line.sewn->edge])});
    }
  return pattern;
}

}  // namespace drape::model
