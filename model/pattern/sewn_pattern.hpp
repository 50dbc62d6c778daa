#pragma once

#include <string>
#include <vector>

#include "model/pattern/sewing_pattern.hpp"
#include "model/scene.hpp"

namespace drape::model {

/// A scene in which a pattern is sewn around a mannequin or hangs, and what a reader should know of how it was made.
struct SewnPattern {
  Scene scene;
  std::vector<std::string> remarks;  ///< a line each
};

inline constexpr double usual_spacing = 0.03;  ///< [m]

/// The scene as a file to be edited, without keys that are as usual, the remarks as comments.
std::string to_toml(const SewnPattern& sewn);

/// Panels become grids with cells of about this length [m], stitches become seams: where a pattern does not say which ends of
/// two edges meet, those that are nearer do. One panel alone hangs by two of its corners. Throws SceneError, naming the panel,
/// if one cannot be a grid.
SewnPattern sew(const SewingPattern& pattern, double spacing);

}  // namespace drape::model
