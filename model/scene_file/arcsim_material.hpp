#pragma once

#include <cstdint>
#include <string>

#include "model/sheet/sheet.hpp"

namespace drape::model {

inline constexpr std::uintmax_t most_arcsim_bytes = 1 << 20;  ///< of a file

/// A fabric of a material file of ARCSim: a JSON object with density, stretching and bending. Throws SceneError, naming the
/// file and the key.
Material read_arcsim_material(const std::string& file);

}  // namespace drape::model
