#include "model/forces/term.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "solver/base/registry.hpp"

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

namespace {

template <std::optional<Term> (*make)(const Sheet&)>
std::optional<Term> own(const Sheet& sheet, std::span<const double> /*parameters*/) {
  return make(sheet);
}

constexpr TermKind own_rows[] = {
    {.name = "tension", .description = "springs along weft and warp (2.20), Alg. 1", .make = own<make_tension>},
    {.name = "curves", .description = "measured curves with branches, 2.1.3", .make = own<make_curves>},
    {.name = "tables", .description = "stretch and shear by a fabric's tables", .make = own<make_tables>},
    {.name = "damping",
     .description = "linear damping d/l² (v_j − v_i) along weft and warp (3.18)",
     .make = own<make_linear_damping>},
    {.name = "projected-damping",
     .description = "viscous tension, projected onto the edges (2.28), Alg. 1",
     .make = own<make_projected_damping>},
    {.name = "shear",
     .description = "conservative shear W = ½ G γ², γ = <s_u, s_v> less than at rest, with its viscous part",
     .make = own<make_shear>},
    {.name = "printed-shear", .description = "shear as Algorithm 2 prints it", .make = own<make_printed_shear>},
    {.name = "survey-shear",
     .description = "shear of the models in 2.1.2: diagonals, triangles, hinges, Baraff and Witkin",
     .make = own<make_survey_shear>},
    {.name = "relaxation",
     .description = "what Maxwell elements forget of tension and shear, 2.4.2",
     .make = own<make_relaxation>},
    {.name = "contraction",
     .description = "transverse contraction (2.22) with its viscous part",
     .make = own<make_contraction>},
    {.name = "membrane", .description = "membrane bending (2.24) with its viscous part", .make = own<make_membrane>},
    {.name = "plate", .description = "thin-plate bending (2.26) with its viscous part", .make = own<make_plate>},
    {.name = "printed-plate", .description = "thin-plate bending as Algorithm 4 prints it", .make = own<make_printed_plate>},
    {.name = "rest-curvature",
     .description = "what a plate takes off that rests curved, 2.3.5",
     .make = own<make_rest_curvature>},
    {.name = "friction", .description = "friction between yarns in shear and bending", .make = own<make_friction>},
    {.name = "gravity", .description = "weight", .make = own<make_gravity>},
    {.name = "wind", .description = "wind, divided by the normals into drag and lift (2.35), (2.36)", .make = own<make_wind>},
    {.name = "air", .description = "resistance of the air (2.37), against the motion", .make = own<make_air>},
};

/// The rows, and those that are added.
std::vector<TermKind>& term_table() {
  static std::vector<TermKind> all(std::begin(own_rows), std::end(own_rows));
  return all;
}

bool was_added(const TermKind& kind) { return !kind.parameters.empty(); }

}  // namespace

std::span<const TermKind> term_kinds() { return term_table(); }

void add_term_kind(const TermKind& row) { term_table().push_back(row); }

std::vector<TermKind> term_kinds_of(const Sheet& sheet) {
  std::vector<TermKind> all(std::begin(own_rows), std::end(own_rows));
  for (const AddedForce& force : sheet.added) all.push_back(base::find_named(term_kinds(), "force", force.name));
  return all;
}

std::optional<Term> make_term(const TermKind& kind, const Sheet& sheet) {
  if (!was_added(kind)) return kind.make(sheet, {});
  const auto refuse = [&](std::string_view why) { throw std::invalid_argument(fmt::format("forces.{}: {}", kind.name, why)); };
  std::optional<Term> term;
  try {
    term = kind.make(sheet, std::ranges::find(sheet.added, kind.name, &AddedForce::name)->parameters);
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  }
  if (term && term->needs_normals && (sheet.grid.nu < 2 || sheet.grid.nv < 2))
    refuse("expected a sheet, a chain has no normals");
  return term;
}

}  // namespace drape::model
