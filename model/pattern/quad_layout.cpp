#include "model/pattern/quad_layout.hpp"

#include <fmt/format.h>
#include <glpk.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <set>

#include "model/keys/scene_error.hpp"
#include "model/scene_file/outline_keys.hpp"
#include "solver/base/disjoint_sets.hpp"

namespace drape::model {
namespace {

using Eigen::Vector2d;

constexpr double right_angle = std::numbers::pi / 2;

double length_of(const PatternEdge& edge) { return Curve({edge.curve}).length(); }

/// The angle by which an outline turns to the left where an edge begins.
double turn_before(const PatternPanel& panel, std::size_t edge) {
  constexpr double nearby = 1e-3;  // of an edge
  const std::size_t before = (edge + panel.edges.size() - 1) % panel.edges.size();
  const Curve in({panel.edges[before].curve}), out({panel.edges[edge].curve});
  const Vector2d p = in.at(1) - in.at(1 - nearby), q = out.at(nearby) - out.at(0);
  return std::atan2(p.x() * q.y() - p.y() * q.x(), p.dot(q));
}

/// The edges of a panel's darts.
std::set<std::size_t> darts(const SewingPattern& pattern, std::size_t panel) {
  const std::size_t count = pattern.panels[panel].edges.size();
  std::set<std::size_t> all;
  for (const auto& [one, other, known] : pattern.stitches)
    if (one.panel == panel && other.panel == panel &&
        ((one.edge + 1) % count == other.edge || (other.edge + 1) % count == one.edge))
      all.insert({one.edge, other.edge});
  return all;
}

/// Four corners, and how far they are from those of a rectangle.
struct Choice {
  FourSides corners;
  double distortion;
};

/// What a panel's corners are chosen by.
class QuadCorners {
 public:
  QuadCorners(const PatternPanel& panel, const std::set<std::size_t>& darts) {
    const std::size_t count = panel.edges.size();
    for (std::size_t edge = 0; edge < count; ++edge) {
      const bool of_dart = darts.contains(edge), behind_dart = darts.contains((edge + count - 1) % count);
      lengths_.push_back(of_dart ? 0 : length_of(panel.edges[edge]));
      turns_.push_back(turn_before(panel, edge));
      if (!of_dart && !behind_dart) candidates_.push_back(edge);
    }
  }

  const std::vector<std::size_t>& candidates() const { return candidates_; }

  double distortion(const FourSides& corners) const {
    double sum = 0;
    for (const std::size_t edge : candidates_) {
      const bool is_corner = std::ranges::find(corners, edge) != corners.end();
      const double off = (turns_[edge] - (is_corner ? right_angle : 0)) / right_angle;
      sum += is_corner ? off * off : off * off / 2;
    }
    for (const std::size_t side : {0, 1}) {
      const double ratio = std::log(length(corners, side) / length(corners, side + 2));
      sum += ratio * ratio;
    }
    return sum;
  }

 private:
  double length(const FourSides& corners, std::size_t side) const {
    double sum = 0;
    for (const std::size_t edge : edges_of_side(corners, side, lengths_.size())) sum += lengths_[edge];
    return sum;
  }

  std::vector<double> lengths_;  ///< of edges, 0 of darts
  std::vector<double> turns_;    ///< before edges
  std::vector<std::size_t> candidates_;
};

/// All choices, the best first.
std::vector<Choice> choices(const QuadCorners& corners) {
  const std::vector<std::size_t>& of = corners.candidates();
  std::vector<Choice> all;
  for (std::size_t i = 0; i < of.size(); ++i)
    for (std::size_t j = i + 1; j < of.size(); ++j)
      for (std::size_t k = j + 1; k < of.size(); ++k)
        for (std::size_t l = k + 1; l < of.size(); ++l) {
          const FourSides four{of[i], of[j], of[k], of[l]};
          all.push_back({four, corners.distortion(four)});
        }
  std::ranges::stable_sort(all, {}, &Choice::distortion);
  return all;
}

/// With the side first that goes along u as far as one does.
FourSides lower_first(const PatternPanel& panel, FourSides corners) {
  const auto along_u = [&](std::size_t side) {
    const Vector2d from = panel.edges[corners[side]].curve.points.front();
    const Vector2d to = panel.edges[corners[(side + 1) % 4]].curve.points.front();
    return (to - from).normalized().x();
  };
  const auto lower = std::ranges::max(std::array<std::size_t, 4>{0, 1, 2, 3}, {}, along_u);
  std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(lower), corners.end());
  return corners;
}

/// Whether the lines of a fine grid do not cross.
bool can_be_filled(const PatternPanel& panel, const FourSides& sides) try {
  Grid grid;
  grid.nu = grid.nv = 33;
  grid.outline = outline_of(panel, sides, {});
  check_outline(grid, "");
  return true;
} catch (const SceneError&) {
  return false;
}

/// The ways to divide the outline of a panel into four sides, the best first.
class Sides {
 public:
  Sides(const SewingPattern& pattern, std::size_t which) : panel_(pattern.panels[which]) {
    const QuadCorners corners(panel_, darts(pattern, which));
    if (corners.candidates().size() < 4)
      throw SceneError(
          fmt::format("{}: expected four corners beside darts, so that it can be filled with quadrilaterals, not {}",
                      pattern.place(which), corners.candidates().size()));
    all_ = choices(corners);
    if (all_.size() > most_tried) all_.resize(most_tried);
    if (!find())
      throw SceneError(pattern.place(which) +
                       ": expected an outline that can be filled with quadrilaterals between four of its corners");
  }

  const FourSides& current() const { return current_; }

  /// Whether there is another.
  bool advance() { return ++at_ < all_.size() && find(); }

 private:
  static constexpr std::size_t most_tried = 200;

  /// The first from here on whose grid can be drawn.
  bool find() {
    for (; at_ < all_.size(); ++at_)
      if (current_ = lower_first(panel_, all_[at_].corners); can_be_filled(panel_, current_)) return true;
    return false;
  }

  const PatternPanel& panel_;
  std::vector<Choice> all_;
  std::size_t at_ = 0;
  FourSides current_{};
};

// --- Numbers of cells --------------------------------------------------------------------------------------------------------

/// Edges with the same number of cells, since they are sewn.
class SewnEdges {
 public:
  explicit SewnEdges(const SewingPattern& pattern) : sets_(total(pattern)) {
    int first = 0;
    for (const PatternPanel& panel : pattern.panels) {
      first_.push_back(first);
      first += static_cast<int>(panel.edges.size());
    }
    for (const Stitch& stitch : pattern.stitches) sets_.join(place(stitch.one), place(stitch.other));
  }

  int count() const { return sets_.count(); }
  int set_of(const EdgeOfPanel& at) { return sets_.root(place(at)); }

 private:
  static int total(const SewingPattern& pattern) {
    std::size_t sum = 0;
    for (const PatternPanel& panel : pattern.panels) sum += panel.edges.size();
    return static_cast<int>(sum);
  }

  int place(const EdgeOfPanel& at) const { return first_[at.panel] + static_cast<int>(at.edge); }

  std::vector<int> first_;
  base::DisjointSets sets_;
};

/// A mixed-integer programme of GLPK. Columns and rows count from 1.
class Programme {
 public:
  Programme() : problem_(glp_create_prob(), glp_delete_prob) {
    glp_term_out(GLP_OFF);
    glp_set_obj_dir(problem_.get(), GLP_MIN);
  }

  /// A variable between two numbers. Returns its column.
  int add(double least, double most, double cost, bool is_integer = false) {
    const int column = glp_add_cols(problem_.get(), 1);
    glp_set_col_bnds(problem_.get(), column, most < HUGE_VAL ? GLP_DB : GLP_LO, least, most);
    glp_set_col_kind(problem_.get(), column, is_integer ? GLP_IV : GLP_CV);
    glp_set_obj_coef(problem_.get(), column, cost);
    return column;
  }

  /// The sum of factors times columns is this number.
  void require(const std::map<int, double>& factors, double sum) {
    std::vector<int> columns{0};
    std::vector<double> values{0};
    for (const auto& [column, factor] : factors)
      if (factor != 0) columns.push_back(column), values.push_back(factor);
    const int row = glp_add_rows(problem_.get(), 1);
    glp_set_row_bnds(problem_.get(), row, GLP_FX, sum, sum);
    glp_set_mat_row(problem_.get(), row, static_cast<int>(columns.size()) - 1, columns.data(), values.data());
  }

  /// Whether there is a solution.
  bool solve() {
    glp_iocp parameters;
    glp_init_iocp(&parameters);
    parameters.presolve = GLP_ON;
    parameters.msg_lev = GLP_MSG_OFF;
    parameters.mip_gap = 0.05;
    parameters.tm_lim = 10000;  // [ms]
    glp_intopt(problem_.get(), &parameters);
    const int status = glp_mip_status(problem_.get());
    return status == GLP_OPT || status == GLP_FEAS;
  }

  int value(int column) const { return static_cast<int>(std::lround(glp_mip_col_val(problem_.get(), column))); }

 private:
  std::unique_ptr<glp_prob, decltype(&glp_delete_prob)> problem_;
};

/// Numbers of cells on every edge of every panel.
std::vector<std::vector<int>> cells_of_edges(const SewingPattern& pattern, const std::vector<FourSides>& sides,
                                             double spacing) {
  SewnEdges sewn(pattern);
  std::vector<double> wished(static_cast<std::size_t>(sewn.count()), 0.0), edges = wished;
  for (std::size_t panel = 0; panel < pattern.panels.size(); ++panel)
    for (std::size_t edge = 0; edge < pattern.panels[panel].edges.size(); ++edge) {
      const int set = sewn.set_of({panel, edge});
      wished[set] += length_of(pattern.panels[panel].edges[edge]) / spacing, edges[set] += 1;
    }
  Programme programme;
  std::map<int, int> column;  // of a set
  for (int set = 0; set < sewn.count(); ++set) {
    if (edges[set] == 0) continue;
    const double mean = wished[set] / edges[set];
    column[set] = programme.add(1, HUGE_VAL, 0, true);
    // As much for half of the cells as for twice as many, and more the farther away.
    const double per_cell = 1 / std::max(mean, 1.0);
    const int more = programme.add(0, mean / 2, per_cell), many_more = programme.add(0, HUGE_VAL, 2 * per_cell);
    const int fewer = programme.add(0, mean / 4, 1.5 * per_cell), many_fewer = programme.add(0, HUGE_VAL, 3 * per_cell);
    programme.require({{column[set], 1}, {more, -1}, {many_more, -1}, {fewer, 1}, {many_fewer, 1}}, mean);
  }
  for (std::size_t panel = 0; panel < pattern.panels.size(); ++panel)
    for (const std::size_t side : {0, 1}) {
      std::map<int, double> factors;
      const std::size_t count = pattern.panels[panel].edges.size();
      for (const std::size_t edge : edges_of_side(sides[panel], side, count)) factors[column[sewn.set_of({panel, edge})]] += 1;
      for (const std::size_t edge : edges_of_side(sides[panel], side + 2, count))
        factors[column[sewn.set_of({panel, edge})]] -= 1;
      programme.require(factors, 0);
    }
  if (!programme.solve())
    throw SceneError(
        fmt::format("{}: expected seams that allow grids with as many cells on opposite sides of every panel", pattern.file));
  std::vector<std::vector<int>> cells;
  for (std::size_t panel = 0; panel < pattern.panels.size(); ++panel) {
    std::vector<int>& own = cells.emplace_back();
    for (std::size_t edge = 0; edge < pattern.panels[panel].edges.size(); ++edge)
      own.push_back(programme.value(column[sewn.set_of({panel, edge})]));
  }
  return cells;
}

CurvePiece backwards(CurvePiece piece) {
  std::ranges::reverse(piece.points);
  return piece;
}

int cells_on(const FourSides& sides, const std::vector<int>& cells, std::size_t side) {
  int sum = 0;
  for (const std::size_t edge : edges_of_side(sides, side, cells.size())) sum += cells[edge];
  return sum;
}

}  // namespace

std::vector<std::size_t> edges_of_side(const FourSides& sides, std::size_t side, std::size_t edges) {
  std::vector<std::size_t> all;
  for (std::size_t edge = sides[side]; edge != sides[(side + 1) % 4]; edge = (edge + 1) % edges) all.push_back(edge);
  return all;
}

QuadLayout quad_layout(const SewingPattern& pattern, double spacing) {
  std::vector<Sides> all;
  for (std::size_t panel = 0; panel < pattern.panels.size(); ++panel) all.emplace_back(pattern, panel);
  for (;;) {
    QuadLayout layout;
    for (const Sides& sides : all) layout.sides.push_back(sides.current());
    layout.cells = cells_of_edges(pattern, layout.sides, spacing);
    bool fits = true;
    for (std::size_t panel = 0; panel < all.size(); ++panel) try {
        check_outline(grid_of(pattern.panels[panel], layout.sides[panel], layout.cells[panel]), pattern.place(panel));
      } catch (const SceneError&) {
        if (!all[panel].advance()) throw;
        fits = false;
      }
    if (fits) return layout;
  }
}

Outline outline_of(const PatternPanel& panel, const FourSides& sides, const std::vector<int>& cells) {
  Outline outline;
  std::vector<CurvePiece>* const all[] = {&outline.lower, &outline.right, &outline.upper, &outline.left};
  for (std::size_t side = 0; side < 4; ++side) {
    for (const std::size_t edge : edges_of_side(sides, side, panel.edges.size())) {
      CurvePiece piece = panel.edges[edge].curve;
      if (!cells.empty()) piece.cells = cells[edge];
      all[side]->push_back(side < 2 ? piece : backwards(piece));
    }
    if (side >= 2) std::ranges::reverse(*all[side]);
  }
  return outline;
}

Grid grid_of(const PatternPanel& panel, const FourSides& sides, const std::vector<int>& cells) {
  Grid grid;
  grid.nu = cells_on(sides, cells, 0) + 1, grid.nv = cells_on(sides, cells, 1) + 1;
  grid.outline = outline_of(panel, sides, cells);
  fit_size(grid);
  return grid;
}

}  // namespace drape::model
