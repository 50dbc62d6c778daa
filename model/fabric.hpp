#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "model/sheet/sheet.hpp"

namespace drape::model {

/// A cloth that was measured, as it is published.
struct Fabric {
  std::string name, description;
  std::string source;
  Material material;  ///< without damping, which was not measured
  double drape = 0;   ///< published drape coefficient, a part of 1; 0: none
};

/// The fabrics of model/fabrics/, in the order of their names.
std::span<const Fabric> fabrics();

/// Tables   [Wang, O'Brien, Ramamoorthi 2011] with the moduli of small strains and curvatures: k1 = 2 C11, k2 = 2 C22, C12
/// twice that of the table, G = C33/2 and the bending stiffness without curvature. What is negative counts as 0, as in the
/// published model.
Material material_of(double density, const FabricTables& tables);

/// A fabric as TOML has it in model/fabrics/. `origin`: its file, for errors. Throws SceneError.
Fabric read_fabric(std::string_view toml, std::string_view name, std::string_view origin);

}  // namespace drape::model
