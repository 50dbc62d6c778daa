#include "model/forces/term.hpp"

namespace drape::model {

std::span<const TermKind> term_kinds() {
  static constexpr TermKind table[] = {
      {"tension", "springs along weft and warp (2.20), Alg. 1", make_tension},
      {"damping", "linear damping d/l² (v_j − v_i) along weft and warp (3.18)", make_linear_damping},
      {"projected-damping", "viscous tension, projected onto the edges (2.28), Alg. 1", make_projected_damping},
      {"shear", "conservative shear W = ½ G <s_u, s_v>² with its viscous part", make_shear},
      {"printed-shear", "shear as Algorithm 2 prints it", make_printed_shear},
      {"contraction", "transverse contraction (2.22) with its viscous part", make_contraction},
      {"membrane", "membrane bending (2.24) with its viscous part", make_membrane},
      {"plate", "thin-plate bending (2.26) with its viscous part", make_plate},
      {"printed-plate", "thin-plate bending as Algorithm 4 prints it", make_printed_plate},
      {"gravity", "weight", make_gravity},
      {"wind", "wind, divided by the normals into drag and lift (2.35), (2.36)", make_wind},
      {"air", "resistance of the air (2.37), against the motion", make_air},
  };
  return table;
}

}  // namespace drape::model
