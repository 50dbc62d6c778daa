#pragma once

#include "model/keys/data.hpp"
#include "model/keys/value.hpp"
#include "model/scene.hpp"

namespace drape::model {

/// Reads an entry of `panels`: its name, and keys of the sections grid, material, start and trim, which change those of the
/// scene.
/// Throws SceneError.
PanelRule read_panel(const Value& value, const Scene& scene);
Entries entries_of(const PanelRule& panel, const Scene& scene);

/// The same of `seams`.
SeamRule read_seam(const Value& value);
Entries entries_of(const SeamRule& seam);

/// The same of `phases`, whose times ascend.
PhaseRule read_phase(const Value& value, const Scene& scene);
Entries entries_of(const PhaseRule& phase, const Scene& scene);

/// A scene that has the panel as its only sheet.
Scene scene_of(const PanelRule& panel, const Scene& scene);

}  // namespace drape::model
