#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bench/runs/checkpoint_json.hpp"
#include "bench/studies/field/tables.hpp"
#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"
#include "model/fabric.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"
#include "solver/integrator.hpp"

/// A laboratory for fabrics: they are stretched, sheared and bent as Kawabata's instruments do it, hang over an edge, and are
/// let go by all methods.
namespace drape::bench {
namespace {

using model::Fabric;
using model::Grid;
using results::ColumnOf;
using results::field;
using results::Part;
using results::Role;
using solver::State;
using solver::Vectors;

// --- Tests with prescribed strains -------------------------------------------------------------------------------------------

/// What an instrument does to a sample: positions for a strain, up to the largest, back, and as far to the other side if it
/// goes there. Strains of bending are curvatures [1/m].
struct Instrument {
  const char* name;
  double largest;
  bool to_both_sides;
  double model::WeftWarp::*bends;  ///< direction along which it bends; null: it does not
  Vectors (*positions)(const Grid& grid, double strain);
};

Vectors affine(const Grid& grid, const Eigen::RowVector3d& s_u, const Eigen::RowVector3d& s_v) {
  return grid.parameters().col(0) * s_u + grid.parameters().col(1) * s_v;
}

/// Arcs along the weft or the warp, whose chords are the edges.
Vectors bent(const Grid& grid, double kappa, bool weft) {
  const double l = weft ? grid.spacing_u() : grid.spacing_v(), angle = 2 * std::asin(kappa * l / 2);
  Vectors x = grid.parameters();
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a) {
      const int place = weft ? a : b;
      if (place == 0) continue;
      const double turn = angle * (place - 0.5);
      const int i = grid.index(a, b), before = weft ? grid.index(a - 1, b) : grid.index(a, b - 1);
      x(i, weft ? 0 : 1) = x(before, weft ? 0 : 1) + l * std::cos(turn);
      x(i, 2) = x(before, 2) + l * std::sin(turn);
    }
  return x;
}

constexpr Instrument instruments[] = {
    {"stretch along the weft", 0.05, false, nullptr,
     [](const Grid& g, double e) {
       return affine(g, {1 + e, 0, 0}, {0, 1, 0});
     }},
    {"stretch along the warp", 0.05, false, nullptr,
     [](const Grid& g, double e) {
       return affine(g, {1, 0, 0}, {0, 1 + e, 0});
     }},
    {"shear", 0.14, true, nullptr,
     [](const Grid& g, double e) {
       return affine(g, {1, 0, 0}, {std::sin(e), std::cos(e), 0});
     }},
    {"bending along the weft", 250, true, &model::WeftWarp::weft,
     [](const Grid& g, double kappa) { return bent(g, kappa, true); }},
    {"bending along the warp", 250, true, &model::WeftWarp::warp,
     [](const Grid& g, double kappa) { return bent(g, kappa, false); }},
};

struct LoopPoint {
  std::string fabric, test;
  double strain = 0, stress = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LoopPoint, fabric, test, strain, stress)

/// What a test says.
struct Trial {
  std::string fabric, test;
  double stiffness = 0;  ///< at the beginning
  double secant = 0;     ///< stress over strain at the largest strain
  double loss = 0;       ///< area of the second loop
  double residual = 0;   ///< strain without stress on the way back
  double published = 0;  ///< that of bending, 2HB/2B; 0: none
  std::vector<LoopPoint> loop = {};

  bool shows_residual() const { return published > 0; }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Trial, fabric, test, stiffness, secant, loss, residual, published, loop)

model::Scene sample_of(const Fabric& fabric) {
  model::Scene scene;
  scene.sheet.grid = {.nu = 5, .nv = 5, .size_u = 0.008, .size_v = 0.008};
  scene.sheet.material = fabric.material;
  scene.sheet.material.bend_projected = false;
  if (fabric.material.tables != model::FabricTables()) scene.sheet.material.law = model::StretchLaw::tables;
  return scene;
}

/// Stress of a sample as the work by strain and area: of the whole sheet, or of the particles that know a curvature.
class Sample {
 public:
  Sample(const Fabric& fabric, const Instrument& instrument)
      : scene_(sample_of(fabric)), instrument_(instrument), cloth_(model::compile(scene_)), y_(cloth_.start) {
    const Grid& grid = scene_.sheet.grid;
    area_ = grid.size_u * grid.size_v * (instrument.bends != nullptr ? 1 - 1.0 / (grid.nu - 1) : 1);
    if (cloth_.ode.memory) cloth_.ode.memory->begin(1, 0, y_);
  }

  double stress(double strain) {
    const double step = 1e-6 * instrument_.largest;
    const Vectors by = (at(strain + step) - at(strain - step)) / (2 * step);
    y_.x = at(strain);
    cloth_.ode.force(0, y_.x, y_.v, f_);
    const double work = -f_.cwiseProduct(by).sum();
    if (cloth_.ode.memory) {
      cloth_.ode.memory->carry(0, y_);
      cloth_.ode.memory->pass(0, y_);
    }
    return work / area_;
  }

 private:
  Vectors at(double strain) const { return instrument_.positions(scene_.sheet.grid, strain); }

  model::Scene scene_;
  const Instrument& instrument_;
  model::Cloth cloth_;
  State y_;
  Vectors f_;
  double area_;
};

Trial trial(const Fabric& fabric, const Instrument& instrument) {
  constexpr int steps = 100, recorded = 4;  // of the steps every fourth
  Sample sample(fabric, instrument);
  Trial result{fabric.name, instrument.name};
  double before = 0, stress_before = 0;
  const auto go = [&](double to, const auto& see) {
    const double from = before;
    for (int k = 1; k <= steps; ++k) {
      const double strain = from + (to - from) * k / steps, stress = sample.stress(strain);
      if (k % recorded == 0) result.loop.push_back({fabric.name, instrument.name, strain, stress});
      see(strain, stress);
      before = strain, stress_before = stress;
    }
  };
  const double most = instrument.largest, least = instrument.to_both_sides ? -most : 0;
  go(most, [&](double strain, double stress) {
    if (result.stiffness == 0) result.stiffness = stress / strain;
  });
  result.secant = stress_before / most;
  go(least, [&](double strain, double stress) {
    const bool crosses = stress_before > 0 && stress <= 0;
    if (crosses) result.residual = before + (strain - before) * stress_before / (stress_before - stress);
    result.loss += 0.5 * (stress + stress_before) * (strain - before);
  });
  go(most, [&](double strain, double stress) { result.loss += 0.5 * (stress + stress_before) * (strain - before); });
  constexpr double round_off = 1e-9;  // of elastic samples, with their positions' differences
  if (std::abs(result.loss) < round_off * std::abs(result.secant) * most * most) result.loss = 0;
  if (std::abs(result.residual) < round_off * most) result.residual = 0;
  const model::Material& m = fabric.material;
  if (instrument.bends != nullptr) result.published = m.friction.bend.*instrument.bends / m.bend.*instrument.bends;
  return result;
}

std::vector<Trial> trials(Checkpoint& checkpoint) {
  std::vector<Trial> all;
  for (const Fabric& fabric : model::fabrics())
    for (const Instrument& instrument : instruments) all.push_back(trial(fabric, instrument));
  checkpoint.advance();
  return all;
}

constexpr double residual_deviation = 0.05;

constexpr ColumnOf<Trial> trial_columns[] = {
    {"fabric", "fabric", "", "see bench/run list fabrics", Role::key, field<&Trial::fabric>},
    {"test", "test", "", "what is done to it", Role::key, field<&Trial::test>},
    {"stiffness", "at first", "", "stiffness of the first hundredth: N/m, of bending N m", Role::quantity,
     field<&Trial::stiffness>},
    {"secant", "at most", "", "stress over strain at a strain of 0.05, a shear of 8 degrees, a curvature of 250/m",
     Role::quantity, field<&Trial::secant>},
    {"loss", "loss", "", "area of the loop: J/m²", Role::quantity, field<&Trial::loss>},
    {"residual", "residual", "", "strain without stress on the way back; of bending a curvature [1/m]", Role::quantity,
     field<&Trial::residual>},
    {"published", "2HB/2B", "1/m", "residual curvature as published", Role::quantity,
     [](const Trial& row) { return row.shows_residual() ? results::to_datum(row.published) : results::Datum(); }},
    {"verdict", "verdict", "", "whether the residual curvature is within 5 % of what is published", Role::verdict,
     [](const Trial& row) {
       if (!row.shows_residual()) return results::Datum();
       const bool agrees = std::abs(row.residual / row.published - 1) < residual_deviation;
       return results::to_datum(results::check(agrees, "within 5 %", "not within 5 %"));
     }},
};

constexpr ColumnOf<LoopPoint> loop_columns[] = {
    {"test", "test", "", "what is done to it", Role::key, field<&LoopPoint::test>},
    {"fabric", "fabric", "", "see bench/run list fabrics", Role::key, field<&LoopPoint::fabric>},
    {"strain", "strain", "1", "of shear the angle", Role::quantity, field<&LoopPoint::strain>},
    {"stress", "stress", "N/m", "work by strain and area", Role::quantity, field<&LoopPoint::stress>},
};

constexpr ColumnOf<LoopPoint> bent_columns[] = {
    loop_columns[0],
    loop_columns[1],
    {"curvature", "κ", "1/m", "curvature", Role::quantity, field<&LoopPoint::strain>},
    {"moment", "moment", "N", "moment by width", Role::quantity, field<&LoopPoint::stress>},
};

/// One of the two: what is stretched and sheared has other units than what is bent.
results::Table loop_table(const char* name, const char* title, const ColumnOf<LoopPoint> (&columns)[4],
                          const std::vector<LoopPoint>& points) {
  results::Table table = results::make_table(name, title, columns, points);
  draw(table, results::Figure::curves,
       {{Part::figure, columns[0].name},
        {Part::curve, columns[1].name},
        {Part::x, columns[2].name},
        {Part::y, columns[3].name}});
  return table;
}

std::vector<results::Table> trial_tables(const std::vector<Trial>& trials) {
  std::vector<LoopPoint> flat, bent;
  for (const Trial& one : trials)
    for (const Instrument& instrument : instruments)
      if (one.test == instrument.name) {
        std::vector<LoopPoint>& points = instrument.bends != nullptr ? bent : flat;
        points.insert(points.end(), one.loop.begin(), one.loop.end());
      }
  return {results::make_table("fabric-tests", "Fabrics that are stretched, sheared and bent", trial_columns, trials),
          loop_table("fabric-loops", "Stress over strain of fabrics, to and fro", loop_columns, flat),
          loop_table("fabric-bending-loops", "Moment over curvature of fabrics, to and fro", bent_columns, bent)};
}

// --- Cantilever --------------------------------------------------------------------------------------------------------------

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

std::vector<Cantilever> cantilevers(Checkpoint& checkpoint) {
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

std::vector<Job> fabric_tests(const Question& question) {
  return {job("fabric-tests", 1, trials, trial_tables),
          job("cantilever", 1, cantilevers,
              [](const std::vector<Cantilever>& rows) {
                return results::make_table("cantilever", "Strips of fabrics that hang over an edge, against the closed form",
                                           cantilever_columns, rows);
              }),
          field_job(fabric_sheets(question.quick), question.methods)};
}

}  // namespace drape::bench
