#include <cmath>
#include <string>
#include <vector>

#include "bench/runs/checkpoint_json.hpp"
#include "bench/studies/fabrics/fabrics.hpp"
#include "bench/studies/fabrics/sample.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"
#include "solver/integrator.hpp"

namespace drape::bench {
namespace {

using model::Fabric;
using results::ColumnOf;
using results::field;
using results::Role;

constexpr double cantilever_deflection = 0.02;  ///< over the length, so that the closed form of small deflections holds
constexpr double cantilever_allowed = 0.01;

/// Deflection of the end of a strip of length L that hangs over an edge, with friction as a Coulomb moment:
/// w/8B (L² − 2 HB/w)², w being the weight by area.
double closed_form(const Fabric& fabric, double L) {
  constexpr double g = 9.81;
  const double w = fabric.material.density * g, rigid = 2 * fabric.material.friction.bend.weft / w;
  return L * L < rigid ? 0 : w / (8 * fabric.material.bend.weft) * std::pow(L * L - rigid, 2);
}

double cantilever_length(const Fabric& fabric) {
  double shorter = 0, longer = 1;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (shorter + longer);
    (closed_form(fabric, middle) < cantilever_deflection * middle ? shorter : longer) = middle;
  }
  return longer;
}

struct Cantilever {
  std::string fabric;
  double length = 0;
  std::int64_t cells = 0;
  double deflection = 0, exact = 0;

  double error() const { return std::abs(deflection / exact - 1); }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Cantilever, fabric, length, cells, deflection, exact)

/// Two columns are held, so that the slope is 0 between them: from there on the strip is free. One step of implicit Euler that
/// is long against all periods goes straight to the rest, so that no friction turns round.
Cantilever cantilever(const Fabric& fabric, int cells) {
  constexpr double g = 9.81, step = 1;
  Cantilever result{fabric.name, cantilever_length(fabric), cells};
  result.exact = closed_form(fabric, result.length);
  const double l = result.length / (cells - 0.5);
  model::Scene scene = sample_of(fabric);
  scene.sheet.grid = {.nu = cells + 1, .nv = 2, .size_u = l * cells, .size_v = l};
  scene.sheet.material.friction.law = model::FrictionKind::jenkin;
  scene.sheet.material.friction.bend_onset = 0.01;       // a Coulomb moment
  scene.sheet.material.law = model::StretchLaw::linear;  // as the closed form is
  scene.sheet.gravity = {0, 0, -g};
  scene.pins = {{.where = {}, .particles = {{0, 0}, {1, 0}, {0, 1}, {1, 1}}}};
  const model::Cloth cloth = model::compile(scene);
  solver::Options options;
  options.stage = &solver::stage_kind("newton");
  options.loop_tolerance = 1e-10;
  solver::Integrator integrator(cloth.ode, solver::method("implicit-euler"), options, cloth.start);
  if (integrator.step(step).outcome != solver::Outcome::success) {
    result.deflection = NAN;
    return result;
  }
  result.deflection = -integrator.state().x(scene.sheet.grid.index(cells, 0), 2);
  return result;
}

std::vector<Cantilever> hang_over_edges(Checkpoint& checkpoint) {
  std::vector<Cantilever> all;
  for (const Fabric& fabric : model::fabrics())
    for (const int cells : {10, 20, 40}) all.push_back(cantilever(fabric, cells));
  checkpoint.advance();
  return all;
}

constexpr ColumnOf<Cantilever> cantilever_columns[] = {
    {"fabric", "fabric", "", "see bench/run list fabrics", Role::key, field<&Cantilever::fabric>},
    {"cells", "cells", "1", "along the strip", Role::key, field<&Cantilever::cells>},
    {"length", "length", "m", "of the strip, which bends by 2 % of it", Role::quantity, field<&Cantilever::length>},
    {"deflection", "deflection", "m", "of its end", Role::quantity, field<&Cantilever::deflection>},
    {"exact", "closed form", "m", "w/8B (L² − 2 HB/w)²", Role::quantity, field<&Cantilever::exact>},
    {"error", "error", "1", "of the deflection, relatively", Role::error,
     [](const Cantilever& row) { return results::to_datum(row.error()); }},
    {"verdict", "verdict", "", "whether 40 cells are within 1 %", Role::verdict,
     [](const Cantilever& row) {
       if (row.cells != 40) return results::Datum();
       return results::to_datum(results::check(row.error() < cantilever_allowed, "within 1 %", "not within 1 %"));
     }},
};

}  // namespace

Job cantilevers() {
  return job("cantilever", 1, hang_over_edges, [](const std::vector<Cantilever>& rows) {
    return results::make_table("cantilever", "Strips of fabrics that hang over an edge, against the closed form",
                               cantilever_columns, rows);
  });
}

}  // namespace drape::bench
