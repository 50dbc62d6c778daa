#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "model/sheet/sheet.hpp"

namespace drape::model {

/// A cloth that was measured, as it is published   [Wang, O'Brien, Ramamoorthi 2011].
struct Fabric {
  std::string name, description;
  std::string source;
  double density;  ///< [kg/m²]

  /// C11, C12, C22, C33 [N/m] of the energy ½ (C11 ε11² + 2 C12 ε11 ε22 + C22 ε22² + C33 ε12²) of Green's strain, which is to
  /// be doubled: at rest, and stretched by a sixth in directions of 0, 22.5, 45, 67.5 and 90 degrees from the weft.
  std::array<std::array<double, 4>, 6> stretching = {};

  /// Bending stiffness [N m] along 0, 45 and 90 degrees from the weft, for five curvatures, the least first.
  std::array<std::array<double, 5>, 3> bending = {};
};

/// The fabrics of model/fabrics/, in the order of their names.
std::span<const Fabric> fabrics();

/// Its material where strains and curvatures are small: k1 = 2 C11, k2 = 2 C22, C12 twice that of the table, G = C33/2 and the
/// bending stiffness of the least curvature; what is negative counts as 0, as in the published model. It has no damping, which
/// was not measured.
Material material_of(const Fabric& fabric);

/// A fabric as TOML has it in model/fabrics/. `origin`: its file, for errors. Throws SceneError.
Fabric read_fabric(std::string_view toml, std::string_view name, std::string_view origin);

}  // namespace drape::model
