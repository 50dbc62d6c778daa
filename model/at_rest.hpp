#pragma once

#include "model/scene.hpp"

namespace drape::model {

/// Whether nothing moves in a scene, as where gravity was forgotten: there is no gravity and no wind, no velocity is given to
/// the sheet, its pins or an obstacle, and at the start no force acts that would move a particle by 1e-9 of the scene's size
/// until the end.
bool is_at_rest(const Scene& scene);

/// What is said of such a scene.
inline constexpr const char* at_rest_remark = "nothing moves: no force acts and no velocity is given";

}  // namespace drape::model
