#pragma once

#include <cstddef>
#include <string>

#include "model/pattern/sewing_pattern.hpp"

/// What readers of patterns share. Each throws SceneError, naming the panel and the edge, unless every panel is closed and does
/// not cross itself, and stitches join edges that are there.
namespace drape::model {

inline constexpr std::size_t most_panels = 1000, most_edges = 1000;  ///< of a panel

/// The content of a file. Throws SceneError if it cannot be read.
std::string pattern_text(const std::string& file);

/// Turns an outline that goes round clockwise, and says whether it did. Throws SceneError, which begins with `place`, if edges
/// cross or have no area between them.
bool make_counterclockwise(PatternPanel& panel, const std::string& place);

/// JSON of GarmentCode with panels and stitches [Korosteleva, Sorkine-Hornung 2023]. Its y, which points up, becomes z.
SewingPattern read_garmentcode(const std::string& file);

/// TOML with pieces and stitches; lengths in mm.
SewingPattern read_draft(const std::string& file);

/// OBJ or PLY of a garment: its texture coordinates are those of the pattern, its islands on it the panels, and edges that are
/// one in space and two on the pattern are sewn. Panels begin where they come nearest to their places in space. Without texture
/// coordinates the mesh has to be flat, and is its own pattern.
SewingPattern read_garment_mesh(const std::string& file);

}  // namespace drape::model
