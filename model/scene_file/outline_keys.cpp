#include "model/scene_file/outline_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "model/keys/key.hpp"
#include "model/sheet/cells.hpp"
#include "model/sheet/cut.hpp"

namespace drape::model {
namespace {

using Eigen::Vector2d;

std::string shown(const Vector2d& point) { return fmt::format("[{:g}, {:g}]", point.x(), point.y()); }

/// `length`: of a curve that begins or ends there.
bool same(const Vector2d& a, const Vector2d& b, double length) {
  constexpr double round_off = 1e-9;
  return (a - b).norm() <= round_off * length;
}

struct PieceKind {
  std::string_view name;
  CurvePiece::Kind kind;
  std::size_t least, most;  ///< points
};
constexpr PieceKind piece_kinds[] = {{"line", CurvePiece::Kind::line, 2, 2},
                                     {"arc", CurvePiece::Kind::arc, 3, 3},
                                     {"bezier", CurvePiece::Kind::bezier, 3, 6},
                                     {"polyline", CurvePiece::Kind::polyline, 2, 10000}};

const PieceKind& kind_of(const CurvePiece& piece) { return *std::ranges::find(piece_kinds, piece.kind, &PieceKind::kind); }

Vector2d read_point(const Value& point) {
  constexpr double largest = 1e6;  // [m]
  const std::vector<Value> xy = point.list(2);
  Vector2d read(xy[0].number(), xy[1].number());
  if (read.cwiseAbs().maxCoeff() > largest) point.fail("coordinates in metres, of at most a thousand kilometres");
  return read;
}

void read_points(const Value& value, const PointReader& point, CurvePiece& piece) {
  const PieceKind& kind = kind_of(piece);
  for (const Value& listed : value.list()) piece.points.push_back(point(listed));
  const std::size_t count = piece.points.size();
  if (count < kind.least || count > kind.most)
    value.fail(kind.least == kind.most ? fmt::format("{} points", kind.least)
                                       : fmt::format("{} to {} points", kind.least, kind.most));
  if (piece.kind == CurvePiece::Kind::arc) {
    const Vector2d a = piece.points[1] - piece.points[0], b = piece.points[2] - piece.points[0];
    if (!(std::abs(a.x() * b.y() - a.y() * b.x()) > 1e-9 * a.norm() * b.norm()))
      value.fail("three points that are not on one line");
  }
  if (!(Curve({piece}).length() > 0)) value.fail("points that differ");
}

/// A piece of a curve of a scene.
CurvePiece read_scene_piece(const Value& value) {
  static constexpr KeyInfo cells_key[] = {{"cells", "1", "of the grid along it"}};
  CurvePiece piece = read_piece(value, read_point, cells_key);
  if (const toml::node* cells = value.table().get("cells")) piece.cells = value.child("cells", *cells).count();
  return piece;
}

[[noreturn]] void fail(const std::string& origin, const std::string& what) { throw SceneError(origin + ": " + what); }

/// One side and where it has to begin and end.
struct Corner {
  std::string_view side, end, other, other_end;
  Vector2d point, other_point;
};

void check_corners(const Outline& o, const std::string& origin) {
  const auto first = [](const std::vector<CurvePiece>& side) { return side.front().points.front(); };
  const auto last = [](const std::vector<CurvePiece>& side) { return side.back().points.back(); };
  for (const Corner& corner : {Corner{"lower", "begin", "left", "begins", first(o.lower), first(o.left)},
                               Corner{"lower", "end", "right", "begins", last(o.lower), first(o.right)},
                               Corner{"upper", "begin", "left", "ends", first(o.upper), last(o.left)},
                               Corner{"upper", "end", "right", "ends", last(o.upper), last(o.right)}})
    if (!same(corner.point, corner.other_point, Curve(o.lower).length() + Curve(o.upper).length()))
      fail(origin, fmt::format("grid.{}: expected to {} where grid.{} {}, at {}, not at {}: the outline is open", corner.side,
                               corner.end, corner.other, corner.other_end, shown(corner.other_point), shown(corner.point)));
}

/// A side of a grid: n particles, graded or not.
struct GridSide {
  std::string_view name;
  const std::vector<CurvePiece>& pieces;
  int n;
  double grading;

  bool has_its_cells() const { return counted_cells(pieces) == 0 || counted_cells(pieces) == n - 1; }
};

std::array<GridSide, 4> sides_of(const Grid& grid) {
  const Outline& o = grid.outline;
  return {{{"lower", o.lower, grid.nu, grid.grading_u},
           {"right", o.right, grid.nv, grid.grading_v},
           {"upper", o.upper, grid.nu, grid.grading_u},
           {"left", o.left, grid.nv, grid.grading_v}}};
}

/// Pieces that count cells do so on a whole side, and have all of its cells.
void check_cells(const Grid& grid, const std::string& origin) {
  for (const GridSide& side : sides_of(grid)) {
    const std::int64_t counted = counted_cells(side.pieces);
    if (counted == 0) continue;
    if (std::ranges::any_of(side.pieces, [](const CurvePiece& piece) { return piece.cells == 0; }))
      fail(origin, fmt::format("grid.{}: expected cells of all of its pieces, or of none", side.name));
    if (!side.has_its_cells())
      fail(origin,
           fmt::format("grid.{}: expected {} cells on its pieces, as grid.n has, not {}", side.name, side.n - 1, counted));
    if (side.grading != 1) fail(origin, fmt::format("grid.{}: expected a grading of 1 beside cells of pieces", side.name));
  }
}

/// The corners of all quadrilaterals turn left, more than round-off does.
void check_lines(const Grid& grid, const std::string& origin) {
  constexpr double flattest = 1e-6;
  const Vectors x = grid.parameters();
  const auto turn = [&](int from, int at, int to) {
    const Eigen::RowVector3d p = x.row(at) - x.row(from), q = x.row(to) - x.row(at);
    return (p[0] * q[1] - p[1] * q[0]) / (p.norm() * q.norm());
  };
  for (int b = 0; b + 1 < grid.nv; ++b)
    for (int a = 0; a + 1 < grid.nu; ++a) {
      const int c[] = {grid.index(a, b), grid.index(a + 1, b), grid.index(a + 1, b + 1), grid.index(a, b + 1)};
      for (int k = 0; k < 4; ++k)
        if (!(turn(c[k], c[(k + 1) % 4], c[(k + 2) % 4]) > flattest))
          fail(origin, fmt::format("grid: its lines cross or touch at the cell [{}, {}], near {}: expected lower, right, upper "
                                   "and left counterclockwise, and no side that bends over another",
                                   a, b, shown(x.row(c[k]).head<2>())));
    }
}

void check_cut(const Grid& grid, const std::string& origin) {
  const Vector2d &begin = grid.cut.front().points.front(), &end = grid.cut.back().points.back();
  if (!same(begin, end, Curve(grid.cut).length()))
    fail(origin, fmt::format("grid.cut: expected to end where it begins, at {}, not at {}: the curve is open", shown(begin),
                             shown(end)));
  if (counted_cells(grid.cut) > 0) fail(origin, "grid.cut: expected no cells, it is not along the grid");
  if (crosses_itself(closed_polygon(grid.cut))) fail(origin, "grid.cut: expected a curve that does not cross itself");
  if (grid.border_cells == BorderCells::whole) fail(origin, "grid.border_cells: expected \"dual\" beside a cut");
  if (cells(grid).empty()) fail(origin, "grid.cut: expected a curve with cloth inside, it lies beside the grid");
}

}  // namespace

CurvePiece read_piece(const Value& value, const PointReader& point, std::span<const KeyInfo> others) {
  std::vector<KeyInfo> keys;
  for (const PieceKind& kind : piece_kinds) keys.push_back({kind.name, "m", "[x, y] of its points"});
  keys.insert(keys.end(), others.begin(), others.end());
  require_keys(value, "piece of a curve", keys);
  const auto is_given = [&](const PieceKind& kind) { return value.table().contains(kind.name); };
  if (std::ranges::count_if(piece_kinds, is_given) != 1) value.fail("one of line, arc, bezier and polyline in every piece");
  const PieceKind& kind = *std::ranges::find_if(piece_kinds, is_given);
  CurvePiece piece{kind.kind, {}};
  read_points(value.child(kind.name, *value.table().get(kind.name)), point, piece);
  return piece;
}

std::vector<CurvePiece> read_curve(const std::vector<Value>& entries) {
  std::vector<CurvePiece> curve;
  for (const Value& entry : entries) {
    CurvePiece piece = read_scene_piece(entry);
    if (!curve.empty() && !same(curve.back().points.back(), piece.points.front(), Curve({piece}).length()))
      entry.fail(fmt::format("a piece that begins where the one before ends, at {}", shown(curve.back().points.back())));
    curve.push_back(std::move(piece));
  }
  return curve;
}

Data curve_data(const std::vector<CurvePiece>& curve) {
  List pieces;
  for (const CurvePiece& piece : curve) {
    List points;
    for (const Vector2d& point : piece.points) points.emplace_back(List{point.x(), point.y()});
    Entries entries{{std::string(kind_of(piece).name), points}};
    if (piece.cells > 0) entries.push_back({"cells", double(piece.cells)});
    pieces.emplace_back(std::move(entries));
  }
  return pieces;
}

void fit_size(Grid& grid) {
  const std::array<GridSide, 4> sides = sides_of(grid);
  if (std::ranges::any_of(sides, [](const GridSide& side) { return side.pieces.empty() || !side.has_its_cells(); })) return;
  const Vectors pattern = grid.parameters();
  const Eigen::RowVector3d size = pattern.colwise().maxCoeff() - pattern.colwise().minCoeff();
  grid.size_u = size[0], grid.size_v = size[1];
}

void check_outline(const Grid& grid, const std::string& origin) {
  if (grid.uniform()) return;
  const auto is_graded = [](double grading, int n) { return grading != 1 && n < 3; };
  if (is_graded(grid.grading_u, grid.nu) || is_graded(grid.grading_v, grid.nv))
    fail(origin, "grid.grading: expected 1 along lines of fewer than 3 particles, which have no second spacing");
  if (grid.nu < 2 || grid.nv < 2)
    fail(origin, "grid: expected no sides, no cut and a grading of 1, a chain has equal spacings");
  const Outline& o = grid.outline;
  if (o.given()) {
    for (const auto& [name, side] : {std::pair("lower", &o.lower), {"right", &o.right}, {"upper", &o.upper}, {"left", &o.left}})
      if (side->empty()) fail(origin, fmt::format("grid.{}: expected all of lower, right, upper and left, or none", name));
    check_corners(o, origin);
    check_cells(grid, origin);
  }
  check_lines(grid, origin);
  if (grid.is_cut()) check_cut(grid, origin);
}

}  // namespace drape::model
