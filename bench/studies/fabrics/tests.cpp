#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bench/runs/checkpoint_json.hpp"
#include "bench/studies/fabrics/fabrics.hpp"
#include "bench/studies/fabrics/sample.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"

namespace drape::bench {
namespace {

using model::Fabric;
using results::ColumnOf;
using results::field;
using results::Part;
using results::Role;

struct LoopPoint {
  std::string fabric, test;
  double strain = 0, stress = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LoopPoint, fabric, test, strain, stress)

/// What a test says.
struct Trial {
  std::string fabric, test;
  bool bends = false;
  double stiffness = 0;  ///< at the beginning
  double secant = 0;     ///< stress over strain at the largest strain
  double loss = 0;       ///< area of the second loop
  double residual = 0;   ///< strain without stress on the way back
  double published = 0;  ///< that of bending, 2HB/2B; 0: none
  std::vector<LoopPoint> loop = {};

  bool shows_residual() const { return published > 0; }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Trial, fabric, test, bends, stiffness, secant, loss, residual, published, loop)

Trial trial(const Fabric& fabric, const Instrument& instrument) {
  constexpr int steps = 100, recorded = 4;  // of the steps every fourth
  Sample sample(sample_of(fabric), instrument);
  Trial result{fabric.name, instrument.name, instrument.bends != nullptr};
  double before = 0, stress_before = 0;
  const auto go = [&](double to, const auto& see) {
    const double from = before;
    for (int k = 1; k <= steps; ++k) {
      const double strain = from + (to - from) * k / steps, stress = sample.stress(0, strain);
      sample.pass(0, strain);
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
    for (const Instrument& instrument : instruments()) all.push_back(trial(fabric, instrument));
  checkpoint.advance();
  return all;
}

constexpr double residual_deviation = 0.05;

constexpr auto published_column = [](const Trial& row) {
  return row.shows_residual() ? results::to_datum(row.published) : results::Datum();
};

constexpr ColumnOf<Trial> flat_columns[] = {
    {"fabric", "fabric", "", "see bench/run list fabrics", Role::key, field<&Trial::fabric>},
    {"test", "test", "", "what is done to it", Role::key, field<&Trial::test>},
    {"stiffness", "at first", "N/m", "stiffness of the first hundredth", Role::quantity, field<&Trial::stiffness>},
    {"secant", "at most", "N/m", "stress over strain at a strain of 0.05, a shear of 8 degrees", Role::quantity,
     field<&Trial::secant>},
    {"loss", "loss", "J/m²", "area of the loop", Role::quantity, field<&Trial::loss>},
    {"residual", "residual", "1", "strain without stress on the way back", Role::quantity, field<&Trial::residual>},
};

constexpr ColumnOf<Trial> bent_columns[] = {
    flat_columns[0],
    flat_columns[1],
    {"stiffness", "at first", "N m", "stiffness of the first hundredth", Role::quantity, field<&Trial::stiffness>},
    {"secant", "at most", "N m", "moment over curvature at 250/m", Role::quantity, field<&Trial::secant>},
    {"loss", "loss", "J/m²", "area of the loop", Role::quantity, field<&Trial::loss>},
    {"residual", "residual", "1/m", "curvature without moment on the way back", Role::quantity, field<&Trial::residual>},
    {"published", "2HB/2B", "1/m", "residual curvature as published", Role::quantity, published_column},
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

constexpr ColumnOf<LoopPoint> moment_columns[] = {
    loop_columns[0],
    loop_columns[1],
    {"curvature", "κ", "1/m", "curvature", Role::quantity, field<&LoopPoint::strain>},
    {"moment", "moment", "N", "moment by width", Role::quantity, field<&LoopPoint::stress>},
};

/// One of the two: what is stretched and sheared has other units than what is bent.
results::Table loop_table(const char* name, const char* title, const ColumnOf<LoopPoint> (&columns)[4],
                          const std::vector<Trial>& trials) {
  std::vector<LoopPoint> points;
  for (const Trial& one : trials) points.insert(points.end(), one.loop.begin(), one.loop.end());
  results::Table table = results::make_table(name, title, columns, points);
  draw(table, results::Figure::curves,
       {{Part::figure, columns[0].name},
        {Part::curve, columns[1].name},
        {Part::x, columns[2].name},
        {Part::y, columns[3].name}});
  return table;
}

std::vector<results::Table> trial_tables(const std::vector<Trial>& trials) {
  std::vector<Trial> flat, bent;
  for (const Trial& one : trials) (one.bends ? bent : flat).push_back(one);
  return {results::make_table("fabric-tests", "Fabrics that are stretched and sheared", flat_columns, flat),
          results::make_table("fabric-bending-tests", "Fabrics that are bent", bent_columns, bent),
          loop_table("fabric-loops", "Stress over strain of fabrics, to and fro", loop_columns, flat),
          loop_table("fabric-bending-loops", "Moment over curvature of fabrics, to and fro", moment_columns, bent)};
}

}  // namespace

Job fabric_tests() { return job("fabric-tests", 1, trials, trial_tables); }

}  // namespace drape::bench
