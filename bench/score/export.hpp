#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "bench/score/true_motion.hpp"

namespace drape::bench {

/// A scene as a benchmark for other simulators: contents of files by their names. `times` [s] are those of the frames, the
/// first is 0.
std::map<std::string, std::string> exported(const TrueMotion& truth, std::span<const double> times);

/// What is in scene.json.
std::string scene_json(const TrueMotion& truth, std::span<const double> times);

}  // namespace drape::bench
