#include "model/forces/term.hpp"

namespace drape::model {

// Each in its file under model/forces/.
std::optional<Term> make_tension(const Sheet& sheet);
std::optional<Term> make_curves(const Sheet& sheet);
std::optional<Term> make_linear_damping(const Sheet& sheet);
std::optional<Term> make_projected_damping(const Sheet& sheet);
std::optional<Term> make_shear(const Sheet& sheet);
std::optional<Term> make_printed_shear(const Sheet& sheet);
std::optional<Term> make_survey_shear(const Sheet& sheet);
std::optional<Term> make_friction(const Sheet& sheet);
std::optional<Term> make_rest_curvature(const Sheet& sheet);
std::optional<Term> make_tables(const Sheet& sheet);
std::optional<Term> make_relaxation(const Sheet& sheet);
std::optional<Term> make_contraction(const Sheet& sheet);
std::optional<Term> make_membrane(const Sheet& sheet);
std::optional<Term> make_plate(const Sheet& sheet);
std::optional<Term> make_printed_plate(const Sheet& sheet);
std::optional<Term> make_gravity(const Sheet& sheet);
std::optional<Term> make_wind(const Sheet& sheet);
std::optional<Term> make_air(const Sheet& sheet);

std::span<const TermKind> term_kinds() {
  static constexpr TermKind table[] = {
      {.name = "tension", .description = "springs along weft and warp (2.20), Alg. 1", .make = make_tension},
      {.name = "curves", .description = "measured curves with branches, 2.1.3", .make = make_curves},
      {.name = "tables", .description = "stretch and shear by a fabric's tables", .make = make_tables},
      {.name = "damping",
       .description = "linear damping d/l² (v_j − v_i) along weft and warp (3.18)",
       .make = make_linear_damping},
      {.name = "projected-damping",
       .description = "viscous tension, projected onto the edges (2.28), Alg. 1",
       .make = make_projected_damping},
      {.name = "shear",
       .description = "conservative shear W = ½ G γ², γ = <s_u, s_v> less than at rest, with its viscous part",
       .make = make_shear},
      {.name = "printed-shear", .description = "shear as Algorithm 2 prints it", .make = make_printed_shear},
      {.name = "survey-shear",
       .description = "shear of the models in 2.1.2: diagonals, triangles, hinges, Baraff and Witkin",
       .make = make_survey_shear},
      {.name = "relaxation",
       .description = "what Maxwell elements forget of tension and shear, 2.4.2",
       .make = make_relaxation},
      {.name = "contraction", .description = "transverse contraction (2.22) with its viscous part", .make = make_contraction},
      {.name = "membrane", .description = "membrane bending (2.24) with its viscous part", .make = make_membrane},
      {.name = "plate", .description = "thin-plate bending (2.26) with its viscous part", .make = make_plate},
      {.name = "printed-plate", .description = "thin-plate bending as Algorithm 4 prints it", .make = make_printed_plate},
      {.name = "rest-curvature", .description = "what a plate takes off that rests curved, 2.3.5", .make = make_rest_curvature},
      {.name = "friction", .description = "friction between yarns in shear and bending", .make = make_friction},
      {.name = "gravity", .description = "weight", .make = make_gravity},
      {.name = "wind", .description = "wind, divided by the normals into drag and lift (2.35), (2.36)", .make = make_wind},
      {.name = "air", .description = "resistance of the air (2.37), against the motion", .make = make_air},
  };
  return table;
}

}  // namespace drape::model
