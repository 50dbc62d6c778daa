#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string_view>
#include <utility>

#include "model/keys/scene_error.hpp"
#include "model/pattern/readers.hpp"
#include "solver/base/printable.hpp"

namespace drape::model {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Json = nlohmann::ordered_json;  // panels in the order of the file

/// A value of the file that knows where it is.
class JsonNode {
 public:
  JsonNode(const Json& json, std::string place) : json_(json), place_(std::move(place)) {}

  const Json& json() const { return json_; }
  const std::string& place() const { return place_; }

  [[noreturn]] void fail(const std::string& what) const { throw SceneError(fmt::format("{}: {}", place_, what)); }

  JsonNode at(const char* key) const {
    if (!json_.is_object() || !json_.contains(key)) fail(fmt::format("expected the key \"{}\"", key));
    return {json_[key], fmt::format("{}: {}", place_, key)};
  }

  std::vector<JsonNode> list(std::size_t least, std::size_t most) const {
    if (!json_.is_array() || json_.size() < least || json_.size() > most)
      fail(least == most ? fmt::format("expected an array of {}", least)
                         : fmt::format("expected an array of {} to {}", least, most));
    std::vector<JsonNode> all;
    for (const Json& entry : json_) all.emplace_back(entry, place_);
    return all;
  }

  double number() const {
    constexpr double largest = 1e6;
    const double value = json_.is_number() ? json_.get<double>() : NAN;
    if (!(std::abs(value) <= largest)) fail("expected numbers, of at most a million");
    return value;
  }

  std::size_t index(std::size_t size) const {
    if (!json_.is_number_unsigned() || json_.get<std::uint64_t>() >= size)
      fail(fmt::format("expected a number from 0 to {}", size - 1));
    return json_.get<std::size_t>();
  }

  template <int size>
  Eigen::Vector<double, size> vector() const {
    Eigen::Vector<double, size> all;
    const std::vector<JsonNode> entries = list(size, size);
    for (int c = 0; c < size; ++c) all[c] = entries[static_cast<std::size_t>(c)].number();
    return all;
  }

 private:
  const Json& json_;
  std::string place_;
};

/// A point beside an edge: its parts along the edge and, turned to the left, across.
Vector2d beside(const Vector2d& from, const Vector2d& to, const Vector2d& parts) {
  const Vector2d along = to - from, across(-along.y(), along.x());
  return from + parts.x() * along + parts.y() * across;
}

/// The middle of an arc of a circle, which is on the left of the edge or on its right.
Vector2d middle_of_arc(const Vector2d& from, const Vector2d& to, double radius, bool large, bool right) {
  const double half = (to - from).norm() / 2;
  const double to_centre = std::sqrt(std::max(radius * radius - half * half, 0.0));
  const double height = large ? radius + to_centre : radius - to_centre;
  return beside(from, to, {0.5, (right ? -1 : 1) * height / (2 * half)});
}

CurvePiece read_edge_curve(const JsonNode& edge, const Vector2d& from, const Vector2d& to, double metres) {
  if ((to - from).norm() == 0) edge.fail("expected ends that differ");
  if (!edge.json().contains("curvature")) return {CurvePiece::Kind::line, {from, to}};
  const JsonNode curvature = edge.at("curvature");
  if (curvature.json().is_array()) return {CurvePiece::Kind::bezier, {from, beside(from, to, curvature.vector<2>()), to}};
  const JsonNode type = curvature.at("type"), params = curvature.at("params");
  if (type.json() == "quadratic" || type.json() == "cubic") {
    const std::size_t count = type.json() == "cubic" ? 2 : 1;
    CurvePiece piece{CurvePiece::Kind::bezier, {from}};
    for (const JsonNode& point : params.list(count, count)) piece.points.push_back(beside(from, to, point.vector<2>()));
    piece.points.push_back(to);
    return piece;
  }
  if (type.json() != "circle") type.fail("expected \"quadratic\", \"cubic\" or \"circle\"");
  const Vector3d arc = params.vector<3>();  // radius, 1 for more than half of the circle, 1 for the right side
  const double radius = metres * arc[0], least = (to - from).norm() / 2;
  if (radius < least * (1 - 1e-9))
    params.fail(fmt::format("expected a radius of at least {:g}, half of the edge", least / metres));
  return {CurvePiece::Kind::arc, {from, middle_of_arc(from, to, radius, arc[1] != 0, arc[2] != 0), to}};
}

/// From the frame of the file, y up, to ours.
Eigen::Matrix3d upright() { return Eigen::Matrix3d{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}; }

/// Turned about its own x, then y, then z.
Eigen::Matrix3d turned(const Vector3d& degrees) {
  const Vector3d angles = degrees * std::numbers::pi / 180;
  return (Eigen::AngleAxisd(angles[0], Vector3d::UnitX()) * Eigen::AngleAxisd(angles[1], Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles[2], Vector3d::UnitZ()))
      .toRotationMatrix();
}

PatternPanel read_pattern_panel(const std::string& name, const JsonNode& node, double metres) {
  PatternPanel panel{base::shortened(base::printable(name), 100), {}, {}, {}};
  std::vector<Vector2d> vertices;
  for (const JsonNode& vertex : node.at("vertices").list(2, most_edges)) vertices.emplace_back(metres * vertex.vector<2>());
  std::size_t first = 0, last = 0;
  for (const JsonNode& listed : node.at("edges").list(2, most_edges)) {
    const int number = static_cast<int>(panel.edges.size());
    const JsonNode edge(listed.json(), fmt::format("{}: edge {}", node.place(), number));
    const std::vector<JsonNode> ends = edge.at("endpoints").list(2, 2);
    const std::size_t from = ends[0].index(vertices.size()), to = ends[1].index(vertices.size());
    if (number == 0) first = from;
    if (number > 0 && from != last)
      edge.fail(fmt::format("begins at vertex {}, the one before ends at {}: expected a closed outline", from, last));
    panel.edges.push_back({read_edge_curve(edge, vertices[from], vertices[to], metres), std::to_string(number)});
    last = to;
  }
  if (last != first)
    node.fail(fmt::format("edge {} ends at vertex {}, edge 0 begins at {}: expected a closed outline", panel.edges.size() - 1,
                          last, first));
  make_counterclockwise(panel, node.place());
  panel.rotation = upright() * turned(node.at("rotation").vector<3>()) * upright().transpose();
  panel.position = metres * upright() * node.at("translation").vector<3>();
  return panel;
}

EdgeOfPanel read_end(const JsonNode& node, const SewingPattern& pattern) {
  const JsonNode name = node.at("panel");
  const auto found = std::ranges::find_if(pattern.panels, [&](const PatternPanel& panel) { return name.json() == panel.name; });
  if (found == pattern.panels.end()) name.fail(fmt::format("there is no panel {}", base::quoted(name.json().dump())));
  const std::size_t number = node.at("edge").index(found->edges.size());
  const auto edge = std::ranges::find(found->edges, std::to_string(number), &PatternEdge::name);
  return {static_cast<std::size_t>(found - pattern.panels.begin()), static_cast<std::size_t>(edge - found->edges.begin())};
}

}  // namespace

SewingPattern read_garmentcode(const std::string& file) {
  const Json json = Json::parse(pattern_text(file), nullptr, false);
  SewingPattern pattern{base::printable(file), std::filesystem::path(file).stem().string(), {}, {}};
  const JsonNode whole(json, pattern.file);
  if (!json.is_object()) whole.fail("expected the JSON of a pattern of GarmentCode");
  const JsonNode body = whole.at("pattern"), panels = body.at("panels");
  if (!panels.json().is_object() || panels.json().empty() || panels.json().size() > most_panels)
    panels.fail(fmt::format("expected an object of 1 to {} panels", most_panels));
  const double units = json.contains("properties") && json["properties"].contains("units_in_meter")
                           ? whole.at("properties").at("units_in_meter").number()
                           : 100;
  if (!(units > 0)) whole.fail("properties: units_in_meter: expected a number above 0");
  for (const auto& [name, panel] : panels.json().items())
    pattern.panels.push_back(
        read_pattern_panel(name, {panel, fmt::format("{}: panel {}", pattern.file, base::quoted(name))}, 1 / units));
  int number = 0;
  for (const JsonNode& listed : body.at("stitches").list(0, most_panels * most_edges)) {
    const JsonNode stitch(listed.json(), fmt::format("{}: stitch {}", pattern.file, number++));
    const std::vector<JsonNode> ends = stitch.list(2, 3);  // a third says which face of the cloth is outside
    pattern.stitches.push_back({read_end(ends[0], pattern), read_end(ends[1], pattern)});
    const Stitch& last = pattern.stitches.back();
    if (last.one.panel == last.other.panel && last.one.edge == last.other.edge)
      stitch.fail("expected two edges, not one with itself");
  }
  return pattern;
}

}  // namespace drape::model
