#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bench/runs/checkpoint_json.hpp"
#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"
#include "model/fabric.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"
#include "solver/base/largest.hpp"
#include "solver/base/noise.hpp"
#include "solver/integrator.hpp"

namespace drape::bench {
namespace {

using model::Fabric;
using results::ColumnOf;
using results::field;
using results::Part;
using results::Role;
using solver::Vectors;

constexpr double sample_radius = 0.15, disc_radius = 0.09;  // [m], of Cusick's tester and of the scene
constexpr double longest_fall = 10;                         // [s]
constexpr double at_rest = 1e-4;                            // [m/s]
constexpr double unevenness = 1e-3;                         // [m], without which the sample would fall evenly
constexpr int directions = 720;

struct DrapeCase {
  std::int64_t cells, seed;
  double step;
};

/// The first is varied: coarser, finer, with other bumps, by longer steps.
constexpr DrapeCase full_cases[] = {{60, 1, 0.01}, {40, 1, 0.01}, {90, 1, 0.01}, {60, 2, 0.01}, {60, 3, 0.01}, {60, 1, 0.02}};
constexpr DrapeCase quick_cases[] = {{24, 1, 0.02}, {20, 1, 0.02}, {30, 1, 0.02}, {24, 2, 0.02}};

struct Drape {
  std::string fabric;
  std::int64_t cells = 0, seed = 0;
  double step = 0, time = 0, speed = 0, coefficient = 0;
  std::int64_t folds = 0;
  std::vector<double> shadow = {};  ///< the farthest point in each direction [m]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Drape, fabric, cells, seed, step, time, speed, coefficient, folds, shadow)

/// Seen from above, of particles at x: bilinear in the cells, at points on circles of the pattern.
std::vector<double> shadow_of(const model::Grid& grid, const Vectors& x) {
  constexpr int around = 4 * directions, outwards = 40;
  constexpr double inside = 0.9999;  // of the radius
  std::vector<double> farthest(directions, disc_radius);
  for (int k = 0; k < around; ++k)
    for (int s = 0; s <= outwards; ++s) {
      const double angle = 2 * std::numbers::pi * k / around;
      const double r = disc_radius + (sample_radius - disc_radius) * inside * s / outwards;
      const double u = (sample_radius + r * std::cos(angle)) / grid.spacing_u();
      const double v = (sample_radius + r * std::sin(angle)) / grid.spacing_v();
      const int a = static_cast<int>(u), b = static_cast<int>(v);
      const auto line = [&](int at) -> Eigen::RowVector3d {
        return (1 - (u - a)) * x.row(grid.index(a, at)) + (u - a) * x.row(grid.index(a + 1, at));
      };
      const Eigen::RowVector3d p = (1 - (v - b)) * line(b) + (v - b) * line(b + 1);
      const double px = p[0] - sample_radius, py = p[1] - sample_radius;
      const double turns = std::atan2(py, px) / (2 * std::numbers::pi) + 1;
      double& far = farthest[static_cast<std::size_t>(turns * directions) % directions];
      far = std::max(far, std::hypot(px, py));
    }
  return farthest;
}

/// The shadow's area beyond the disc over that of the flat sample.
double coefficient_of(const std::vector<double>& shadow) {
  double squares = 0;
  for (const double r : shadow) squares += r * r;
  const double disc = disc_radius * disc_radius;
  return (squares / directions - disc) / (sample_radius * sample_radius - disc);
}

/// How often the shadow, on average over five degrees to both sides, comes to lie beyond its mean.
int folds_of(const std::vector<double>& shadow) {
  constexpr int reach = directions / 72;
  const auto smooth = [&](int k) {
    double sum = 0;
    for (int j = -reach; j <= reach; ++j) sum += shadow[(k + j + directions) % directions];
    return sum / (2 * reach + 1);
  };
  double mean = 0;
  for (int k = 0; k < directions; ++k) mean += smooth(k) / directions;
  int count = 0;
  for (int k = 0; k < directions; ++k) count += smooth(k) <= mean && smooth(k + 1) > mean ? 1 : 0;
  return count;
}

/// Lets a flat sample with small bumps fall until nothing moves. Implicit Euler takes the energy out.
Drape let_fall(const Fabric& fabric, const DrapeCase& one) {
  model::Scene scene = model::load_scene("cusick", {});
  model::Grid& grid = scene.sheet.grid;
  grid.nu = grid.nv = static_cast<int>(one.cells) + 1;
  scene.sheet.material = fabric.material;
  scene.sheet.material.bend_projected = false;
  model::Cloth cloth = model::compile(scene);
  cloth.start.x.col(2) += unevenness * base::noise(grid.particles(), static_cast<unsigned>(one.seed));
  for (const solver::Pin& pin : cloth.ode.pins) cloth.start.x(pin.particle, 2) = 0;
  if (cloth.ode.memory) cloth.ode.memory->begin(1, 0, cloth.start);

  solver::Options options;
  options.stage = &solver::stage_kind("newton");
  solver::Integrator integrator(cloth.ode, solver::method("implicit-euler"), options, cloth.start);
  Drape result{fabric.name, one.cells, one.seed, one.step};
  result.coefficient = result.speed = NAN;
  do {
    if (integrator.step(one.step).outcome != solver::Outcome::success) return result;
    result.time += one.step;
    result.speed = integrator.state().v.rowwise().norm().maxCoeff();
  } while (result.time < longest_fall && !(result.speed < at_rest));
  result.shadow = shadow_of(grid, integrator.state().x);
  result.coefficient = coefficient_of(result.shadow);
  result.folds = folds_of(result.shadow);
  return result;
}

/// What the cases of one fabric say together.
struct DrapeCoefficient {
  std::string fabric;
  double coefficient = 0, by_mesh = 0, by_rest = 0, published = 0;

  double uncertainty() const { return by_mesh + by_rest; }
  double off() const { return std::abs(coefficient - published); }
};

/// The coefficient is that of the finest mesh.
std::vector<DrapeCoefficient> coefficients(const std::vector<Drape>& all) {
  std::vector<DrapeCoefficient> found;
  for (const Fabric& fabric : model::fabrics()) {
    std::vector<Drape> own;
    std::ranges::copy_if(all, std::back_inserter(own), [&](const Drape& one) { return one.fabric == fabric.name; });
    if (own.empty()) continue;
    const auto finest = std::ranges::max_element(own, {}, &Drape::cells);
    DrapeCoefficient& summed = found.emplace_back(DrapeCoefficient{
        fabric.name, finest->coefficient, std::abs(finest->coefficient - own[0].coefficient), 0, fabric.drape});
    for (const Drape& one : own)
      if (one.cells == own[0].cells)
        summed.by_rest = base::larger(summed.by_rest, std::abs(one.coefficient - own[0].coefficient));
  }
  return found;
}

constexpr ColumnOf<Drape> drape_columns[] = {
    {"fabric", "fabric", "", "see bench/run list fabrics", Role::key, field<&Drape::fabric>},
    {"cells", "cells", "1", "along the sample's diameter", Role::key, field<&Drape::cells>},
    {"step", "h", "s", "step of implicit Euler", Role::key, field<&Drape::step>},
    {"seed", "seed", "1", "of the bumps with which it begins", Role::key, field<&Drape::seed>},
    {"time", "at rest", "s", "when nothing moves faster than 0.1 mm/s", Role::quantity, field<&Drape::time>},
    {"speed", "speed", "m/s", "largest at that time", Role::quantity, field<&Drape::speed>},
    {"coefficient", "drape", "1", "drape coefficient: the shadow's area beyond the disc over that of the flat sample",
     Role::quantity, field<&Drape::coefficient>},
    {"folds", "folds", "1", "of the shadow", Role::quantity, field<&Drape::folds>},
    {"verdict", "verdict", "", "whether it came to rest", Role::verdict,
     [](const Drape& row) { return results::to_datum(results::check(row.speed < at_rest, "at rest", "not at rest")); }},
};

constexpr double small = 0.05;

constexpr ColumnOf<DrapeCoefficient> coefficient_columns[] = {
    {"fabric", "fabric", "", "see bench/run list fabrics", Role::key, field<&DrapeCoefficient::fabric>},
    {"coefficient", "drape", "1", "drape coefficient on the finest mesh", Role::quantity,
     field<&DrapeCoefficient::coefficient>},
    {"by_mesh", "± mesh", "1", "how far that is from the mesh before", Role::uncertainty, field<&DrapeCoefficient::by_mesh>},
    {"by_rest", "± rest", "1", "how far other bumps and a step twice as long lead", Role::uncertainty,
     field<&DrapeCoefficient::by_rest>},
    {"published", "published", "1", "measured drape coefficient", Role::quantity, field<&DrapeCoefficient::published>},
    {"converged", "converged", "", "whether mesh, bumps and step change it by 0.05 at most", Role::verdict,
     [](const DrapeCoefficient& row) {
       return results::to_datum(results::check(row.uncertainty() <= small, "within 0.05", "not within 0.05"));
     }},
    {"verdict", "agrees", "", "whether the published one lies within that", Role::verdict,
     [](const DrapeCoefficient& row) {
       return results::to_datum(
           results::check(row.off() <= row.uncertainty(), "within the uncertainty", "beyond the uncertainty"));
     }},
};

struct ShadowPoint {
  std::string fabric;
  double x, y;
};

constexpr ColumnOf<ShadowPoint> shadow_columns[] = {
    {"fabric", "fabric", "", "see bench/run list fabrics", Role::key, field<&ShadowPoint::fabric>},
    {"x", "x", "m", "along the weft, from the centre", Role::quantity, field<&ShadowPoint::x>},
    {"y", "y", "m", "along the warp", Role::quantity, field<&ShadowPoint::y>},
};

/// Those of the finest meshes.
results::Table shadows(const std::vector<Drape>& all) {
  std::vector<ShadowPoint> points;
  for (const Drape& one : all) {
    const bool finest =
        std::ranges::none_of(all, [&](const Drape& other) { return other.fabric == one.fabric && other.cells > one.cells; });
    if (!finest || one.shadow.empty()) continue;
    for (int k = 0; k <= directions; k += 2) {
      const double r = one.shadow[k % directions], angle = 2 * std::numbers::pi * (k + 0.5) / directions;
      points.push_back({one.fabric, r * std::cos(angle), r * std::sin(angle)});
    }
  }
  results::Table table = results::make_table("drape-shadows", "Shadows of draped samples", shadow_columns, points);
  draw(table, results::Figure::curves, {{Part::curve, "fabric"}, {Part::x, "x"}, {Part::y, "y"}});
  return table;
}

}  // namespace

/// Cusick's drape test of the fabrics whose drape coefficients were published; of one of them on coarse meshes if it is quick.
std::vector<Job> drape_study(const Question& question) {
  const bool quick = question.quick;
  std::vector<std::pair<const Fabric*, DrapeCase>> cases;
  for (const Fabric& fabric : model::fabrics()) {
    if (fabric.drape == 0 || (quick && !cases.empty() && cases.front().first != &fabric)) continue;
    for (const DrapeCase& one : quick ? std::span<const DrapeCase>(quick_cases) : full_cases) cases.emplace_back(&fabric, one);
  }
  const auto compute = [=](Checkpoint& checkpoint) {
    std::vector<Drape> all;
    checkpoint.each(cases, [&](const auto& drape_case) {
      const auto& [fabric, one] = drape_case;
      const std::string id = fmt::format("{} {} cells, seed {}, h = {}", fabric->name, one.cells, one.seed, one.step);
      checkpoint.show("drape of " + id);
      all.push_back(checkpoint.once(id, [&, fabric = fabric, one = one] { return let_fall(*fabric, one); }));
      checkpoint.advance();
    });
    return all;
  };
  return {job("drape", static_cast<int>(cases.size()), compute, [](const std::vector<Drape>& all) {
    return std::vector<results::Table>{
        results::make_table("drape", "Cusick's drape test: samples that fall over a disc", drape_columns, all),
        results::make_table("drape-coefficients", "Drape coefficients beside published ones", coefficient_columns,
                            coefficients(all)),
        shadows(all)};
  })};
}

}  // namespace drape::bench
