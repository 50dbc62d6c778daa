#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "results/run_record.hpp"
#include "results/table.hpp"

/// What older files do not say. Those of schema version 4 do not say what their columns are: it is known by names and units.
/// Only here verdicts are read out of texts.
namespace drape::results {

Role usual_role(std::string_view name, std::string_view unit);

Figure usual_figure(const Table& table);

/// Moves what a curve comes to from its last row, where such files have it, to its first.
void move_to_first_rows(Table& curves);

/// A cell in a column of verdicts that has no standings beside it, as in files of version 4 and the first of version 5: a
/// Verdict, or a text that classifies. In version 4 "NOT 4" is missed, "4 as declared" is met; in version 5 "missed: not 4" is
/// missed.
Datum written_verdict(const std::string& text, int version);

/// The keys of a scene, which files before November 2026 have only as text.
std::vector<SceneValue> keys_in(const std::string& scene_toml);

}  // namespace drape::results
