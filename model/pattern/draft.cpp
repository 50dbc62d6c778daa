#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "model/keys/key.hpp"
#include "model/pattern/readers.hpp"
#include "model/scene_file/outline_keys.hpp"
#include "model/scene_file/toml_nesting.hpp"
#include "solver/base/printable.hpp"
#include "solver/base/registry.hpp"

namespace drape::model {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double millimetre = 1e-3;    // [m]
constexpr double touching = 1e-5;      // [m]: ends that are nearer are the same point
constexpr double largest_draft = 1e6;  // [mm]
constexpr double same_place = 1e-4;    // as a part of a stretch: places that are nearer are one

/// An edge as it is drawn.
struct DraftEdge {
  std::string name;  ///< empty: it has none
  CurvePiece curve;  ///< [m]
};

struct DraftPanel {
  std::string name;
  std::map<std::string, Vector2d, std::less<>> points;  ///< [mm]
  std::vector<DraftEdge> edges;                         ///< closed
  Vector3d rotation = Vector3d::Zero();                 ///< axis times angle [degrees]
  Vector3d position = Vector3d::Zero();                 ///< [mm]
};

/// One side of a stitch.
struct DraftSide {
  std::string panel, edge;
  bool backwards = false;
};

struct DraftStitch {
  DraftSide one, other;
  double ease = 0.02;
};

// --- Keys --------------------------------------------------------------------------------------------------------------------

std::string in_millimetres(const Vector2d& p) { return fmt::format("[{:g}, {:g}]", p.x() / millimetre, p.y() / millimetre); }

Vector2d read_draft_point(const Value& value) {
  const std::vector<Value> xy = value.list(2);
  Vector2d point(xy[0].number(), xy[1].number());
  if (point.cwiseAbs().maxCoeff() > largest_draft) value.fail("coordinates in mm, of at most a million");
  return point;
}

void read_draft_points(const Value& value, DraftPanel& panel) {
  for (const auto& [name, node] : value.table())
    panel.points.emplace(name.str(), read_draft_point(value.child(name.str(), node)));
}

/// A point by its name or its coordinates [m].
Vector2d find_draft_point(const Value& value, const DraftPanel& panel) {
  if (value.is_list()) return millimetre * read_draft_point(value);
  const auto found = panel.points.find(value.text());
  if (found != panel.points.end()) return millimetre * found->second;
  std::vector<std::string> names;
  for (const auto& [name, point] : panel.points) names.push_back(name);
  value.fail(fmt::format("[x, y] in mm or one of the points of panel {}: {}", panel.name, fmt::join(names, ", ")));
}

std::string label(const DraftPanel& panel, std::size_t edge) {
  const std::string& name = panel.edges[edge].name;
  return name.empty() ? std::to_string(edge) : name;
}

void read_draft_outline(const Value& value, DraftPanel& panel) {
  static constexpr KeyInfo name_key[] = {{"name", "", "of the edge"}};
  const auto point = [&](const Value& listed) { return find_draft_point(listed, panel); };
  const std::vector<Value> listed = value.list();
  if (listed.size() < 2 || listed.size() > most_edges) value.fail(fmt::format("2 to {} edges", most_edges));
  for (const Value& entry : listed) {
    DraftEdge edge{"", read_piece(entry, point, name_key)};
    if (const toml::node* name = entry.table().get("name")) edge.name = base::printable(entry.child("name", *name).title());
    panel.edges.push_back(std::move(edge));
  }
  for (std::size_t k = 0; k < listed.size(); ++k) {
    const std::size_t before = (k + listed.size() - 1) % listed.size();
    const Vector2d& end = panel.edges[before].curve.points.back();
    Vector2d& begin = panel.edges[k].curve.points.front();
    if (!((begin - end).norm() <= touching))
      listed[k].fail(fmt::format("edge {} of panel {} to begin where edge {} ends, at {}, not at {}: the outline is open",
                                 label(panel, k), panel.name, label(panel, before), in_millimetres(end),
                                 in_millimetres(begin)));
    begin = end;
  }
}

/// Patterns are only read.
template <class Record>
Data not_written(const Record&) {
  return {};
}

constexpr Key<DraftPanel> panel_keys[] = {
    {"name", "", "of the panel", at<&DraftPanel::name>, check::title, true},
    {"points", "mm", "{ name = [x, y] }", read_draft_points, not_written<DraftPanel>},
    {"outline", "", "edges that follow each other", read_draft_outline, not_written<DraftPanel>, true},
    {"rotation", "degrees", "axis times angle, of the panel that stands upright", at<&DraftPanel::rotation>, check::number},
    {"position", "mm", "of the origin", at<&DraftPanel::position>, check::number},
};

constexpr Key<DraftSide> draft_side_keys[] = {
    {"panel", "", "its name", at<&DraftSide::panel>, check::text, true},
    {"edge", "", "its name, or that of edges that follow each other", at<&DraftSide::edge>, check::text, true},
    {"backwards", "", "whether it is sewn against the outline as it is drawn", at<&DraftSide::backwards>, check::flag},
};

template <auto member>
void read_draft_side(const Value& value, DraftStitch& stitch) {
  read_table<DraftSide>(value, "side of a stitch", draft_side_keys, stitch.*member);
}

constexpr Key<DraftStitch> stitch_keys[] = {
    {"one", "", "{ panel, edge, backwards }", read_draft_side<&DraftStitch::one>, not_written<DraftStitch>, true},
    {"other", "", "{ panel, edge, backwards }", read_draft_side<&DraftStitch::other>, not_written<DraftStitch>, true},
    {"ease", "1", "part by which one may be longer than the other", at<&DraftStitch::ease>, check::non_negative},
};

const std::vector<KeyInfo> draft_keys = {
    {"name", "", "of the pattern"}, {"panels", "", "of cloth", true}, {"stitches", "", "what joins their edges"}};

// --- Stretches ---------------------------------------------------------------------------------------------------------------

/// Edges of a panel with one name that follow each other.
struct Stretch {
  std::size_t panel, first, count;  ///< `count` edges as drawn, from the last of the panel on to the first
  double length;                    ///< [m]
  bool backwards;
};

double length_of(const DraftEdge& edge) { return Curve({edge.curve}).length(); }

std::string names_of_edges(const DraftPanel& panel) {
  std::set<std::string> names;
  for (const DraftEdge& edge : panel.edges)
    if (!edge.name.empty()) names.insert(edge.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

Stretch find_stretch(const Value& value, const DraftSide& side, const std::vector<DraftPanel>& panels) {
  const auto found = std::ranges::find(panels, side.panel, &DraftPanel::name);
  if (found == panels.end()) {
    std::vector<std::string> names;
    for (const DraftPanel& panel : panels) names.push_back(panel.name);
    value.fail(fmt::format("one of the panels {}", fmt::join(names, ", ")));
  }
  const std::size_t edges = found->edges.size();
  const auto is_named = [&](std::size_t edge) { return found->edges[edge % edges].name == side.edge; };
  Stretch stretch{static_cast<std::size_t>(found - panels.begin()), 0, 0, 0, side.backwards};
  int beginnings = 0;
  for (std::size_t k = 0; k < edges; ++k) {
    if (!is_named(k)) continue;
    ++stretch.count;
    stretch.length += length_of(found->edges[k]);
    if (!is_named(k + edges - 1)) stretch.first = k, ++beginnings;
  }
  if (side.edge.empty() || stretch.count == 0)
    value.fail(fmt::format("one of the named edges of panel {}: {}", found->name, names_of_edges(*found)));
  if (beginnings != 1)
    value.fail(fmt::format("edges of panel {} that follow each other, with others before and behind them", found->name));
  return stretch;
}

/// Two stretches that are sewn.
struct SewnStretches {
  Stretch one, other;
};

/// Where stretches have to be divided, so that those that are sewn have their edges' ends at the same parts of their lengths.
class Division {
 public:
  Division(const std::vector<DraftPanel>& panels, const std::vector<SewnStretches>& seams) {
    for (const auto& [one, other] : seams)
      for (const Stretch& stretch : {one, other}) {
        std::vector<double>& ends = ends_of(stretch);
        ends.clear();
        double length = 0;
        for (std::size_t k = 0; k + 1 < stretch.count; ++k) {
          const DraftPanel& panel = panels[stretch.panel];
          length += length_of(panel.edges[(stretch.first + k) % panel.edges.size()]);
          ends.push_back(length / stretch.length);
        }
      }
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& [one, other] : seams) {
        changed |= carry_over(one, other);
        changed |= carry_over(other, one);
      }
    }
  }

  /// The ends of a stretch's edges but the last, ascending, as parts of its length as it is drawn.
  std::vector<double>& ends_of(const Stretch& stretch) { return ends_[{stretch.panel, stretch.first}]; }

 private:
  bool carry_over(const Stretch& from, const Stretch& to) {
    std::vector<double>& ends = ends_of(to);
    bool changed = false;
    for (const double end : std::vector<double>(ends_of(from))) {
      const double place = from.backwards == to.backwards ? end : 1 - end;
      const auto is_same = [&](double other) { return std::abs(other - place) <= same_place; };
      if (std::ranges::any_of(ends, is_same)) continue;
      ends.insert(std::ranges::upper_bound(ends, place), place);
      changed = true;
    }
    return changed;
  }

  std::map<std::pair<std::size_t, std::size_t>, std::vector<double>> ends_;
};

/// A panel of which some edges are divided.
struct DividedPanel {
  PatternPanel panel;
  bool turned;                      ///< whether it goes round the other way than it is drawn
  std::vector<std::size_t> firsts;  ///< of the edges that each edge became, as drawn

  /// The place of the k-th edge from an edge on that is there as drawn.
  std::size_t edge(std::size_t drawn, std::size_t k) const {
    const std::size_t count = panel.edges.size(), at = (firsts[drawn] + k) % count;
    return turned ? count - 1 - at : at;
  }
};

DividedPanel divide(const DraftPanel& draft, const std::map<std::size_t, std::vector<double>>& parts,
                    const std::string& place) {
  DividedPanel divided_panel{{draft.name, {}, {}, {}}, false, {}};
  PatternPanel& panel = divided_panel.panel;
  for (std::size_t k = 0; k < draft.edges.size(); ++k) {
    divided_panel.firsts.push_back(panel.edges.size());
    CurvePiece rest = draft.edges[k].curve;
    double begin = 0;
    if (const auto found = parts.find(k); found != parts.end())
      for (const double part : found->second) {
        auto [first, second] = divided(rest, (part - begin) / (1 - begin));
        panel.edges.push_back({std::move(first), label(draft, k)});
        rest = std::move(second);
        begin = part;
      }
    panel.edges.push_back({std::move(rest), label(draft, k)});
  }
  divided_panel.turned = make_counterclockwise(panel, place);
  const double angle = draft.rotation.norm() * std::numbers::pi / 180;
  panel.rotation = Eigen::AngleAxisd(angle, draft.rotation.stableNormalized()).toRotationMatrix();
  panel.position = millimetre * draft.position;
  return divided_panel;
}

/// The parts of the lengths of edges at which they are divided. `ends`: of the edges of a stretch, its own among them.
void add_parts(const DraftPanel& panel, const Stretch& stretch, const std::vector<double>& ends,
               std::map<std::size_t, std::vector<double>>& parts) {
  double begin = 0;
  for (std::size_t k = 0; k < stretch.count; ++k) {
    const std::size_t edge = (stretch.first + k) % panel.edges.size();
    const double length = length_of(panel.edges[edge]) / stretch.length;
    std::vector<double>& own = parts[edge];
    own.clear();
    for (const double end : ends)
      if (end > begin + same_place / 2 && end < begin + length - same_place / 2) own.push_back((end - begin) / length);
    begin += length;
  }
}

toml::table draft_table(const std::string& file) {
  return parse_toml(pattern_text(file), base::printable(file),
                    fmt::format("expected a pattern, which is not nested deeper than {} levels", most_toml_levels));
}

/// The panels of a file, and where they stand there.
struct Drafts {
  std::vector<DraftPanel> panels;
  std::vector<std::string> places;  ///< "skirt.toml:3: panel front"
};

Drafts read_drafts(const Value& list, const std::string& origin) {
  const std::vector<Value> listed = list.list();
  if (listed.empty() || listed.size() > most_panels) list.fail(fmt::format("1 to {} panels", most_panels));
  Drafts drafts;
  for (const Value& value : listed) {
    DraftPanel panel;
    read_table<DraftPanel>(value, "panel", panel_keys, panel);
    if (panel.name.empty() || std::ranges::find(drafts.panels, panel.name, &DraftPanel::name) != drafts.panels.end())
      value.fail("a name that no other panel has");
    drafts.places.push_back(fmt::format("{}: panel {}", place(origin, value.table()), base::quoted(panel.name)));
    drafts.panels.push_back(std::move(panel));
  }
  return drafts;
}

SewnStretches read_stitch(const Value& value, const std::vector<DraftPanel>& panels) {
  DraftStitch stitch;
  read_table<DraftStitch>(value, "stitch", stitch_keys, stitch);
  const auto side = [&](const char* key, const DraftSide& given) {
    return find_stretch(value.child(key, *value.table().get(key)), given, panels);
  };
  const Stretch one = side("one", stitch.one), other = side("other", stitch.other);
  if (one.panel == other.panel && one.first == other.first) value.fail("two stretches, not one with itself");
  if (std::max(one.length, other.length) > (1 + stitch.ease) * std::min(one.length, other.length))
    value.fail(
        fmt::format("lengths that differ by {:g} % at most (ease = {:g}): edge {} of panel {} has {:.1f} mm, edge {} of panel "
                    "{} has {:.1f} mm",
                    100 * stitch.ease, stitch.ease, stitch.one.edge, stitch.one.panel, one.length / millimetre,
                    stitch.other.edge, stitch.other.panel, other.length / millimetre));
  return {one, other};
}

/// The panels with the edges of stretches divided. Throws unless both sides of every stitch then have as many.
std::vector<DividedPanel> divide(const Drafts& drafts, const std::vector<Value>& stitches,
                                 const std::vector<SewnStretches>& seams, Division& division) {
  std::vector<std::map<std::size_t, std::vector<double>>> parts(drafts.panels.size());
  for (std::size_t k = 0; k < seams.size(); ++k) {
    const auto& [one, other] = seams[k];
    for (const Stretch& stretch : {one, other})
      add_parts(drafts.panels[stretch.panel], stretch, division.ends_of(stretch), parts[stretch.panel]);
    if (division.ends_of(one).size() != division.ends_of(other).size())
      stitches[k].fail("edges whose ends meet, or are farther apart than a thousandth of what is sewn");
  }
  std::vector<DividedPanel> panels;
  for (std::size_t k = 0; k < drafts.panels.size(); ++k) panels.push_back(divide(drafts.panels[k], parts[k], drafts.places[k]));
  return panels;
}

}  // namespace

SewingPattern read_draft(const std::string& file) {
  const toml::table root = draft_table(file);
  SewingPattern pattern{base::printable(file), std::filesystem::path(file).stem().string(), {}, {}};
  const auto node = [&](std::string_view key) -> Value { return {*root.get(key), std::string(key), pattern.file}; };
  require_keys({root, "pattern", pattern.file}, "pattern", draft_keys);
  if (root.contains("name")) pattern.name = node("name").title();
  const Drafts drafts = read_drafts(node("panels"), pattern.file);
  const std::vector<Value> stitches = root.contains("stitches") ? node("stitches").list() : std::vector<Value>();
  std::vector<SewnStretches> seams;
  for (const Value& value : stitches) seams.push_back(read_stitch(value, drafts.panels));
  Division division(drafts.panels, seams);
  const std::vector<DividedPanel> panels = divide(drafts, stitches, seams, division);
  for (const DividedPanel& divided_panel : panels) pattern.panels.push_back(divided_panel.panel);
  for (const auto& [one, other] : seams) {
    const std::size_t count = division.ends_of(one).size() + 1;
    const auto edge = [&](const Stretch& stretch, std::size_t k) -> EdgeOfPanel {
      return {stretch.panel, panels[stretch.panel].edge(stretch.first, stretch.backwards ? count - 1 - k : k)};
    };
    const auto goes_along = [&](const Stretch& stretch) { return stretch.backwards == panels[stretch.panel].turned; };
    for (std::size_t k = 0; k < count; ++k)
      pattern.stitches.push_back({edge(one, k), edge(other, k), goes_along(one) == goes_along(other)});
  }
  return pattern;
}

}  // namespace drape::model
