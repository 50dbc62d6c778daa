#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "results/run_record.hpp"
#include "results/table.hpp"

/// What older files do not say. Those of schema version 4 do not say what their columns are: it is known by names and units.
namespace drape::results {

Role usual_role(std::string_view name, std::string_view unit);

Figure usual_figure(const Table& table);

/// Moves what a curve comes to from its last row, where such files have it, to its first.
void move_to_first_rows(Table& curves);

/// A verdict of such a file as verdict.hpp has it: "NOT 4" is "missed: not 4".
std::string usual_verdict(const std::string& text);

/// The keys of a scene, which files before November 2026 have only as text.
std::vector<SceneValue> keys_in(const std::string& scene_toml);

}  // namespace drape::results
