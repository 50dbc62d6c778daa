#include "model/pattern/sewn_pattern.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <string_view>
#include <utility>
#include <variant>

#include "model/garment.hpp"
#include "model/keys/scene_error.hpp"
#include "model/pattern/quad_layout.hpp"
#include "model/scene_file/scene_file.hpp"
#include "model/sheet/cut.hpp"

namespace drape::model {
namespace {

constexpr double most_particles = 1e6;
constexpr double sewing_time = 0.5;  // [s]

/// What is not in a pattern: a cloth, a body and times.
constexpr std::string_view surroundings = R"(
name = "pattern"

[material]
density = 0.3
tension = 300
damping = 1
shear = 3
bend = 2e-5
bend_projected = false

[forces]
gravity = [0, 0, -9.81]
air = 0.05

[start]
plane = "vertical"

[[obstacles]]
shape = "mannequin"
friction = 0.3

[contact]
distance = 0.02

[end]
time = 3
)";

/// Where an edge is in a grid: a side, and the particles at its ends, counterclockwise.
struct EdgeOfGrid {
  PanelSide side;
  int begin, end;
};

/// Where all edges of a panel are.
std::vector<EdgeOfGrid> edges_of_grid(const FourSides& sides, const std::vector<int>& cells) {
  std::vector<EdgeOfGrid> all(cells.size());
  for (std::size_t side = 0; side < 4; ++side) {
    const std::vector<std::size_t> edges = edges_of_side(sides, side, cells.size());
    const bool is_opposite = side >= 2;  // upper and left go against the outline
    int place = 0;
    if (is_opposite)
      for (const std::size_t edge : edges) place += cells[edge];
    for (const std::size_t edge : edges) {
      const int begin = place, end = place += is_opposite ? -cells[edge] : cells[edge];
      all[edge] = {PanelSide(side), begin, end};
    }
  }
  return all;
}

/// The ends of an edge before it is sewn [m].
std::array<Eigen::Vector3d, 2> ends_of(const SewingPattern& pattern, const EdgeOfPanel& at) {
  const PatternPanel& panel = pattern.panel(at);
  const auto placed = [&](const Eigen::Vector2d& p) -> Eigen::Vector3d {
    return panel.position + panel.rotation * Eigen::Vector3d(p.x(), 0, p.y());
  };
  const std::vector<Eigen::Vector2d>& points = pattern.edge(at).curve.points;
  return {placed(points.front()), placed(points.back())};
}

Eigen::Vector3d in_degrees(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * 180 / std::numbers::pi * turn.axis();
}

/// How two edges can be sewn: the sum of the ways of their ends [m].
struct Ways {
  double same;      ///< if the edges, counterclockwise both, run side by side
  double opposite;  ///< if they run in opposite directions
};

Ways ways_of(const SewingPattern& pattern, const Stitch& stitch) {
  const auto [a, b] = ends_of(pattern, stitch.one);
  const auto [c, d] = ends_of(pattern, stitch.other);
  return {(a - c).norm() + (b - d).norm(), (a - d).norm() + (b - c).norm()};
}

/// Sets of panels that are known to show the same or different faces on the outside of the cloth.
class ShownFaces {
 public:
  explicit ShownFaces(std::size_t panels) : parent_(panels), turned_(panels, false) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  /// Whether they show different faces; `guess`, which holds from now on, if that is not known.
  bool differ(std::size_t one, std::size_t other, bool guess) {
    const auto [i, i_turned] = root(one);
    const auto [j, j_turned] = root(other);
    const bool differ = i == j ? i_turned != j_turned : guess;
    if (i != j) parent_[j] = i, turned_[j] = (i_turned != j_turned) != guess;
    return differ;
  }

 private:
  /// The root of its set, and whether it shows another face than that.
  std::pair<std::size_t, bool> root(std::size_t panel) const {
    bool turned = false;
    for (; parent_[panel] != panel; panel = parent_[panel]) turned = turned != turned_[panel];
    return {panel, turned};
  }

  std::vector<std::size_t> parent_;
  std::vector<bool> turned_;  ///< against the parent
};

/// Whether edges are sewn side by side: those of panels that show the same face run in opposite directions. Where the pattern
/// does not say, the ends that are nearer meet, where that is clearest first; the others follow from the faces.
std::vector<bool> side_by_side(const SewingPattern& pattern, const std::vector<Ways>& ways) {
  std::vector<std::size_t> order(pattern.stitches.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t k) {
    return pattern.stitches[k].side_by_side ? -HUGE_VAL : -std::abs(ways[k].same - ways[k].opposite);
  });
  ShownFaces faces(pattern.panels.size());
  std::vector<bool> all(order.size());
  for (const std::size_t k : order) {
    const auto& [one, other, known] = pattern.stitches[k];
    const bool differ = faces.differ(one.panel, other.panel, known.value_or(ways[k].same < ways[k].opposite));
    all[k] = known.value_or(differ);
  }
  return all;
}

/// The part by which one side of a seam is longer than the other, as particles are placed.
double excess(const Scene& scene, const SeamRule& seam) {
  const auto length = [&](const SeamSide& side) { return sewn_length(find_panel(scene, side.panel).grid, side); };
  const double one = length(seam.one), other = length(seam.other);
  return std::max(one, other) / std::min(one, other) - 1;
}

/// Makes a sheet of the only panel, without a body, and pins the two corners beside each other that are highest, or farthest
/// back if all are as high.
void hang(Scene& scene) {
  const Grid grid = scene.sheet.grid = scene.panels.front().grid;
  scene.start = scene.panels.front().start;
  scene.panels.clear();
  const int u = grid.nu - 1, v = grid.nv - 1;
  const std::array<std::pair<int, int>, 4> corners = {{{0, 0}, {u, 0}, {u, v}, {0, v}}};
  const solver::Vectors x = start_of(grid, scene.start).x;
  const auto height = [&](std::size_t side) {  // to a tenth of a millimetre
    const auto row = [&](std::size_t k) { return x.row(grid.index(corners[k % 4].first, corners[k % 4].second)); };
    const Eigen::RowVector3d both = row(side) + row(side + 1);
    return std::pair(std::round(1e4 * both.z()), std::round(1e4 * both.y()));
  };
  std::size_t highest = 0;
  for (std::size_t side = 1; side < 4; ++side)
    if (height(side) > height(highest)) highest = side;
  scene.obstacles.clear();
  scene.contact = {};
  scene.end = 1;
  scene.pins.push_back({.where = {}, .particles = {corners[highest], corners[(highest + 1) % 4]}});
}

/// Keys that differ from the usual ones as TOML; lists as tables, behind them.
std::string changed_keys(const Scene& scene) {
  std::map<std::string, std::string> usual, own;
  for (const KeyValue& row : key_values(Scene{})) usual[row.key] = to_toml(row.value);
  const std::vector<KeyValue> rows = key_values(scene);
  std::string text;
  for (const KeyValue& row : rows) {
    const std::string value = own[row.key] = to_toml(row.value);
    if (!std::holds_alternative<Entries>(row.value) && usual[row.key] != value)
      text += fmt::format("{} = {}\n", row.key, value);
  }
  for (const KeyValue& row : rows) {
    const auto* table = std::get_if<Entries>(&row.value);
    if (table == nullptr) continue;
    text += fmt::format("\n[[{}]]\n", row.key);
    for (const auto& [key, data] : *table) {
      const std::string value = to_toml(data);
      const bool is_usual = own.contains(key) ? own[key] == value : value.empty() || value == "[]";
      if (!is_usual) text += fmt::format("{} = {}\n", key, value);
    }
  }
  return text;
}

}  // namespace

std::string to_toml(const SewnPattern& sewn) {
  std::string text;
  if (!sewn.remarks.empty()) text += "# Seams:\n";
  for (const std::string& remark : sewn.remarks) text += fmt::format("#   {}\n", remark);
  return text + "\n" + changed_keys(sewn.scene);
}

SewnPattern sew(const SewingPattern& pattern, double spacing) {
  double area = 0;
  for (const PatternPanel& panel : pattern.panels) {
    std::vector<CurvePiece> outline;
    for (const PatternEdge& edge : panel.edges) outline.push_back(edge.curve);
    area += polygon_area(closed_polygon(outline));
  }
  if (area > most_particles * spacing * spacing)
    throw SceneError(fmt::format("spacing: expected at least {:.2g} m, since the pattern has {:.3g} m²",
                                 std::sqrt(area / most_particles), area));
  const auto [sides, cells] = quad_layout(pattern, spacing);
  SewnPattern sewn{parse_scene(surroundings, pattern.file), {}};
  Scene& scene = sewn.scene;
  scene.name = pattern.name;
  std::vector<std::vector<EdgeOfGrid>> places;
  for (std::size_t k = 0; k < pattern.panels.size(); ++k) {
    const PatternPanel& panel = pattern.panels[k];
    PanelRule& rule = scene.panels.emplace_back(PanelRule{panel.name, "", {}, scene.sheet.material, scene.start});
    rule.grid = grid_of(panel, sides[k], cells[k]);
    rule.start.rotation = in_degrees(panel.rotation);
    rule.start.position = panel.position;
    places.push_back(edges_of_grid(sides[k], cells[k]));
  }
  std::vector<Ways> ways;
  for (const Stitch& stitch : pattern.stitches) ways.push_back(ways_of(pattern, stitch));
  const std::vector<bool> run_side_by_side = side_by_side(pattern, ways);
  for (std::size_t k = 0; k < pattern.stitches.size(); ++k) {
    const auto& [one, other, known] = pattern.stitches[k];
    const EdgeOfGrid &first = places[one.panel][one.edge], &second = places[other.panel][other.edge];
    SeamRule seam{{pattern.panel(one).name, first.side, {first.begin, first.end}},
                  {pattern.panel(other).name, second.side, {second.begin, second.end}}};
    if (!run_side_by_side[k]) std::swap(seam.other.ends[0], seam.other.ends[1]);
    const double way = run_side_by_side[k] ? ways[k].same : ways[k].opposite;
    const double other_way = run_side_by_side[k] ? ways[k].opposite : ways[k].same;
    std::string& remark = sewn.remarks.emplace_back(
        fmt::format("{} edge {} with {} edge {}: ends {:.2f} m away, the other way round {:.2f} m", seam.one.panel,
                    pattern.edge(one).name, seam.other.panel, pattern.edge(other).name, way, other_way));
    if (way > other_way) remark += known ? "; sewn as the pattern says" : "; sewn so that no panel is inside out";
    if (const double gathered = excess(scene, seam); gathered > seam.ease / 2) {
      seam.ease = std::ceil(100 * (gathered + seam.ease)) / 100;
      remark += fmt::format("; {:.0f} % are gathered", 100 * gathered);
    }
    scene.seams.push_back(std::move(seam));
  }
  const bool is_one_sheet = scene.panels.size() == 1 && scene.seams.empty();
  if (!scene.seams.empty()) scene.phases.push_back({sewing_time, Eigen::Vector3d::Zero(), SeamState::pulled, {}});
  if (is_one_sheet) hang(scene);
  try {
    const Garment garment(scene);
    scene.description = is_one_sheet
                            ? fmt::format("The cloth {}, {} particles, hung by two corners", pattern.name, garment.nodes())
                            : fmt::format("The pattern {} of {} panels, {} particles, sewn around a mannequin", pattern.name,
                                          pattern.panels.size(), garment.nodes());
  } catch (const std::invalid_argument& error) {
    throw SceneError(fmt::format("{}: {}", pattern.file, error.what()));
  }
  return sewn;
}

}  // namespace drape::model
