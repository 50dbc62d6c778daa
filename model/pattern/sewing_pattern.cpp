#include "model/pattern/sewing_pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "model/keys/scene_error.hpp"
#include "model/pattern/readers.hpp"
#include "model/sheet/cut.hpp"
#include "solver/base/input_file.hpp"
#include "solver/base/printable.hpp"

namespace drape::model {
namespace {

using Eigen::Vector2d;

std::vector<Vector2d> polygon_of(const PatternEdge& edge) {
  constexpr int chords = 32;
  if (edge.curve.kind == CurvePiece::Kind::polyline) return edge.curve.points;
  const Curve curve({edge.curve});
  const int parts = edge.curve.kind == CurvePiece::Kind::line ? 1 : chords;
  std::vector<Vector2d> all;
  for (int k = 0; k <= parts; ++k) all.push_back(curve.at(k / double(parts)));
  return all;
}

/// Whether two chains of lines cross, beside the corners where they meet.
bool chains_cross(const std::vector<Vector2d>& one, const std::vector<Vector2d>& other) {
  for (std::size_t i = 0; i + 1 < one.size(); ++i)
    for (std::size_t j = 0; j + 1 < other.size(); ++j)
      if (lines_cross(one[i], one[i + 1], other[j], other[j + 1])) return true;
  return false;
}

struct PatternFormat {
  std::string_view ending;
  SewingPattern (*read)(const std::string& file);
};
constexpr PatternFormat pattern_formats[] = {
    {".json", read_garmentcode}, {".toml", read_draft}, {".obj", read_garment_mesh}, {".ply", read_garment_mesh}};

}  // namespace

std::string SewingPattern::place(std::size_t panel) const { return fmt::format("{}: panel {}", file, panels[panel].name); }

bool is_pattern(const std::string& file) {
  return std::ranges::any_of(
      pattern_formats, [&](const PatternFormat& format) { return format.ending != ".toml" && file.ends_with(format.ending); });
}

SewingPattern read_pattern(const std::string& file) {
  for (const auto& [ending, read] : pattern_formats)
    if (file.ends_with(ending)) return read(file);
  throw SceneError(fmt::format("{}: expected a pattern, whose name ends in .json (GarmentCode), .toml, .obj or .ply",
                               base::printable(file)));
}

std::string pattern_text(const std::string& file) try {
  constexpr std::uintmax_t most_pattern_bytes = 16 << 20;
  return base::content_of(file, most_pattern_bytes);
} catch (const base::UnreadableFile& error) {
  throw SceneError(fmt::format("{}: {}", base::printable(file), error.what()));
}

bool make_counterclockwise(PatternPanel& panel, const std::string& place) {
  std::vector<std::vector<Vector2d>> all;
  for (const PatternEdge& edge : panel.edges) all.push_back(polygon_of(edge));
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i; j < all.size(); ++j)
      if (chains_cross(all[i], all[j]))
        throw SceneError(fmt::format("{}: edges {} and {} cross: expected an outline that does not cross itself", place,
                                     panel.edges[i].name, panel.edges[j].name));
  std::vector<Vector2d> outline;
  for (const std::vector<Vector2d>& part : all) outline.insert(outline.end(), part.begin(), part.end() - 1);
  const double area = polygon_area(outline);
  if (area == 0) throw SceneError(place + ": expected an outline with an area");
  if (area > 0) return false;
  std::ranges::reverse(panel.edges);
  for (PatternEdge& edge : panel.edges) std::ranges::reverse(edge.curve.points);
  return true;
}

}  // namespace drape::model
