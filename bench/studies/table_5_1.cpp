#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/runs/checkpoint_json.hpp"
#include "bench/runs/record.hpp"
#include "bench/runs/timing.hpp"
#include "bench/studies/draping.hpp"
#include "bench/studies/step_means.hpp"
#include "bench/studies/studies.hpp"
#include "model/adaptive/sheet_refinement.hpp"
#include "model/collision/cloth_surface.hpp"
#include "model/obstacles/triangle_hierarchy.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"
#include "solver/base/statistics.hpp"
#include "solver/base/stopwatch.hpp"

namespace drape::bench {
namespace {

using model::Vectors;
using results::ColumnOf;
using results::Datum;
using results::field;
using results::Role;
using results::Standing;
using results::Verdict;

constexpr double adaptive_step = 0.01;  // [s]

/// A scene of the table as the thesis prints it: times of a step on an R10000 of 180 MHz [ms].
struct PublishedRefinement {
  std::string_view scene;
  double projection, topology;
};
constexpr PublishedRefinement published_table_5_1[] = {
    {"round_table_100", 38.5, 38}, {"square_table_400", 24, 147.5}, {"ball_100", 150.5, 83.5}};

/// The scene of which the time is bounded, and the bound [ms].
constexpr std::string_view bounded_scene = "ball_100";
constexpr double most_refinement = 1;

std::span<const PublishedRefinement> refined_scenes(bool quick) {
  return std::span(published_table_5_1).first(quick ? 1 : std::size(published_table_5_1));
}

model::Scene refined_scene(std::string_view name, const std::vector<model::Override>& changes = {}) {
  return model::load_scene(std::string(name), changes);
}

RunSpec refined_spec(const model::Scene& scene, std::string_view method, double step) {
  return {scene, "", &solver::method(method), step, {}};
}

// --- What virtual particles cost -------------------------------------------------------------------------------------------

/// The means of a scene's steps.
struct RefinementCost {
  std::string scene;
  int particles = 0, edges = 0;
  double faces = 0, virtual_particles = 0;
  double projection = 0, topology = 0, combined = 0, spread = 0;  ///< a step [ms]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RefinementCost, scene, particles, edges, faces, virtual_particles, projection, topology,
                                   combined, spread)

const PublishedRefinement& as_published(const RefinementCost& row) {
  return *std::ranges::find(published_table_5_1, row.scene, &PublishedRefinement::scene);
}

constexpr ColumnOf<RefinementCost> cost_columns[] = {
    {"scene", "scene", "", "built-in, implicit Euler, h = 0.01 s; means over the steps of its second", Role::key,
     field<&RefinementCost::scene>},
    {"particles", "particles", "1", "of the sheet", Role::quantity, field<&RefinementCost::particles>},
    {"edges", "edges", "1", "of the obstacle", Role::quantity, field<&RefinementCost::edges>},
    {"faces", "hit faces", "1", "of the sheet", Role::counter, field<&RefinementCost::faces>},
    {"virtual_particles", "virtual", "1", "particles inserted", Role::counter, field<&RefinementCost::virtual_particles>},
    {"projection", "projection", "ms", "a step: edges of the obstacle projected onto the sheet, virtual particles", Role::time,
     field<&RefinementCost::projection>},
    {"topology", "topology", "ms", "a step: constrained Delaunay triangulations and the refined mesh", Role::time,
     field<&RefinementCost::topology>},
    {"combined", "combined", "ms", "both", Role::time, field<&RefinementCost::combined>},
    {"spread", "±", "ms", "half the range of the sum in interleaved repetitions", Role::time, field<&RefinementCost::spread>},
    {"thesis_projection", "thesis: projection", "ms", "printed in the thesis: R10000, 180 MHz", Role::note,
     [](const RefinementCost& row) { return results::to_datum(as_published(row).projection); }},
    {"thesis_topology", "thesis: topology", "ms", "printed in the thesis", Role::note,
     [](const RefinementCost& row) { return results::to_datum(as_published(row).topology); }},
    {"verdict", "verdict", "", "whether both take less than 1 ms, of the ball of 1227 edges", Role::verdict,
     [](const RefinementCost& row) {
       if (row.scene != bounded_scene) return Datum();
       return results::to_datum(results::check(row.combined < most_refinement, "below 1 ms", "not below 1 ms"));
     }},
};

template <class Compute>
auto timed(double& sum, const Compute& compute) {
  const base::Stopwatch stopwatch(&sum);
  return compute();
}

/// A run's states, to be refined again and again.
class Refinements {
 public:
  explicit Refinements(const model::Scene& scene)
      : garment_(scene),
        bodies_(scene.obstacles),
        search_(model::ClothSurface(garment_).triangles(), garment_.start().x, bodies_.mesh(), unused_) {
    cost_.scene = scene.name;
    cost_.particles = garment_.nodes();
    cost_.edges = static_cast<int>(search_.obstacle().edges().size());
    FunctionObserver observer([&](const solver::StepReport& step) { moments_.push_back({step.t, step.y.x}); });
    Observer* const observers[] = {&observer};
    record(refined_spec(scene, "implicit-euler", adaptive_step), observers);
  }

  /// Refines all states once.
  void measure() {
    double projection = 0, topology = 0, faces = 0, inserted = 0;
    std::vector<Eigen::Vector3d> vertices, velocities;
    for (const auto& [t, x] : moments_) {
      bodies_.place(t, vertices, velocities);
      const auto insertion = timed(projection, [&] { return search_.find(x, vertices); });
      const auto sheet = timed(topology, [&] { return model::refine(search_.sheet(), x, insertion); });
      faces += static_cast<double>(insertion.faces.size());
      inserted += static_cast<double>(sheet.particles.size());
    }
    const auto steps = static_cast<double>(moments_.size());
    cost_.faces = faces / steps, cost_.virtual_particles = inserted / steps;
    projections_.push_back(projection / steps);
    topologies_.push_back(topology / steps);
    sums_.push_back((projection + topology) / steps);
  }

  RefinementCost cost() const {
    RefinementCost row = cost_;
    row.projection = base::quantile(projections_, 0.5), row.topology = base::quantile(topologies_, 0.5);
    row.combined = base::quantile(sums_, 0.5);
    row.spread = (base::quantile(sums_, 1) - base::quantile(sums_, 0)) / 2;
    return row;
  }

 private:
  struct Moment {
    double t;  ///< [s]
    Vectors x;
  };
  model::Garment garment_;
  model::BodySurface bodies_;
  solver::Counters unused_;
  model::VirtualParticles search_;
  std::vector<Moment> moments_;
  RefinementCost cost_;
  std::vector<double> projections_, topologies_, sums_;
};

std::vector<RefinementCost> refinement_costs(bool quick, Checkpoint& checkpoint) {
  return checkpoint.timed("costs", [&] {
    std::vector<std::unique_ptr<Refinements>> all;
    for (const PublishedRefinement& one : refined_scenes(quick)) {
      checkpoint.show(fmt::format("refining {}", one.scene));
      all.push_back(std::make_unique<Refinements>(refined_scene(one.scene)));
    }
    for (int k = 0; k < (quick ? 1 : 7); ++k)
      for (const auto& one : all) one->measure();
    std::vector<RefinementCost> rows;
    for (const auto& one : all) rows.push_back(one->cost());
    checkpoint.advance();
    return rows;
  });
}

// --- What they are worth -----------------------------------------------------------------------------------------------------

constexpr std::string_view worth_method = "bdf2", worth_witness = "midpoint";
constexpr double worth_step = 0.005, worth_end = 2;  // [s]
constexpr int claimed = 20, claimed_as = 50;         // 400 adaptive particles are as good as 2500 [Etzmuß 2002, 5.5]

/// A sheet of n² particles.
struct SheetOf {
  int n;
  bool adaptive;
};
constexpr SheetOf compared_sheets[] = {{10, false}, {10, true}, {20, false}, {20, true}, {30, false}, {30, true}, {50, false}};

/// A sheet beside the finest one.
struct Worth {
  std::string scene, outcome;
  int n = 0;
  bool adaptive = false;
  std::optional<double> distance = {}, penetration = {}, height = {};
  std::optional<double> uncertainty = {};  ///< of the distance [m]; nothing if a run of the finest sheet fails
  double time = 0, lower = 0, upper = 0;   ///< quartiles [ms/s]
  Verdict verdict = {};
};

constexpr ColumnOf<Worth> worth_columns[] = {
    {"scene", "scene", "", "built-in, until 2 s, by BDF(2), h = 0.005 s", Role::key, field<&Worth::scene>},
    {"particles", "particles", "1", "of the sheet", Role::key,
     [](const Worth& row) { return results::to_datum(row.n * row.n); }},
    {"sheet", "sheet", "", "virtual: with virtual particles", Role::key,
     [](const Worth& row) { return results::to_datum(std::string(row.adaptive ? "virtual" : "plain")); }},
    {"distance", "distance", "m", "of the nodes of the finest sheet from the surface at the end, root mean square", Role::error,
     field<&Worth::distance>},
    {"uncertainty", "± ref", "m",
     "the same between the finest sheet and itself by twice the step, or by the midpoint rule: the larger", Role::uncertainty,
     field<&Worth::uncertainty>},
    {"penetration", "penetration", "m", "of the surface, with what is refined, into the obstacle: its deepest point",
     Role::quantity, field<&Worth::penetration>},
    {"height", "height off", "m", "of the centre of mass, above that of the finest sheet: what it has more of potential energy",
     Role::quantity, field<&Worth::height>},
    {"time", "time", "ms/s", "wall time a simulated second, median of interleaved runs", Role::time, field<&Worth::time>},
    {"lower", "from", "ms/s", "lower quartile", Role::time, field<&Worth::lower>},
    {"upper", "to", "ms/s", "upper quartile", Role::time, field<&Worth::upper>},
    {"outcome", "outcome", "", "how the run ended", Role::outcome, field<&Worth::outcome>},
    {"verdict", "C-28", "", "whether 400 adaptive particles are as near to the finest sheet as 2500 plain ones", Role::verdict,
     [](const Worth& row) { return row.n == claimed && row.adaptive ? results::to_datum(row.verdict) : Datum(); }},
};

model::Scene sheet_scene(std::string_view name, const SheetOf& sheet, bool quick) {
  const double end = quick ? 0.1 : worth_end;
  return refined_scene(name, {{"grid.n", fmt::format("{}", sheet.n)},
                              {"contact.adaptive", sheet.adaptive ? "true" : "false"},
                              {"end.time", fmt::format("{}", end)}});
}

/// The surface that a run ends with, refined if it is adaptive.
model::TriangleMesh surface_at_end(const model::Scene& scene, const results::RunRecord& run) {
  const std::span<const model::ObstacleRule> met =
      scene.contact.adaptive ? std::span(scene.obstacles) : std::span<const model::ObstacleRule>();
  const model::Polygons polygons =
      model::SheetRefinement(model::Garment(scene), met).polygons(run.last_good_time, run.final_state.x);
  return {"the sheet", polygons.vertices, model::fan_triangles(polygons)};
}

double distance_from(const model::TriangleMesh& surface, const Vectors& nodes) {
  const model::TriangleHierarchy hierarchy(surface);
  double sum = 0;
  for (const auto& node : nodes.rowwise()) {
    const Eigen::Vector3d p = node;
    sum += (hierarchy.nearest(p).nearest.point - p).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(nodes.rows()));
}

/// The deepest point of a surface in obstacles, of points that are at most `spacing` apart [m].
double penetration_of(const model::TriangleMesh& surface, const model::Cloth& cloth, double spacing, double t) {
  std::vector<Eigen::Vector3d> points;
  for (const auto& triangle : surface.triangles) {
    const auto [a, b, c] = model::corners(surface, triangle);
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int m = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
    for (int i = 0; i <= m; ++i)
      for (int j = 0; i + j <= m; ++j) points.emplace_back(((m - i - j) * a + i * b + j * c) / m);
  }
  Vectors x(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t k = 0; k < points.size(); ++k) x.row(static_cast<Eigen::Index>(k)) = points[k];
  return std::max(0.0, -cloth.contacts->distances(t, x).minCoeff());
}

/// Height of the centre of mass [m].
double height_at_end(const model::Cloth& cloth, const results::RunRecord& run) {
  const Eigen::VectorXd& mass = cloth.ode.mass;
  return mass.dot(run.final_state.x.col(2)) / mass.sum();
}

std::vector<Worth> worth_on(std::string_view name, bool quick, Checkpoint& checkpoint) {
  const int finest = quick ? 30 : 100;
  const auto kept = [&](const model::Scene& scene, std::string_view method, double step) {
    const std::string id =
        fmt::format("{} n = {} adaptive = {} {} h = {}", name, scene.sheet.grid.nu, scene.contact.adaptive, method, step);
    return checkpoint.once(id, [&] {
      checkpoint.show(id);
      return record(refined_spec(scene, method, step));
    });
  };
  const model::Scene fine_scene = sheet_scene(name, {finest, false}, quick);
  const results::RunRecord fine = kept(fine_scene, worth_method, worth_step);
  std::optional<double> uncertainty = 0;
  for (const results::RunRecord& other :
       {kept(fine_scene, worth_method, 2 * worth_step), kept(fine_scene, worth_witness, worth_step)}) {
    if (!fine.succeeded() || !other.succeeded()) uncertainty.reset();
    if (uncertainty) uncertainty = std::max(*uncertainty, distance_from(surface_at_end(fine_scene, other), fine.final_state.x));
  }
  const double height = height_at_end(model::compile(fine_scene), fine);
  std::vector<Worth> rows;
  Group group;
  std::vector<std::size_t> counts;
  for (const SheetOf& sheet : std::span(compared_sheets).first(quick ? 2 : std::size(compared_sheets))) {
    const model::Scene scene = sheet_scene(name, sheet, quick);
    const results::RunRecord run = kept(scene, worth_method, worth_step);
    Worth& row = rows.emplace_back(Worth{std::string(name), ending(run.outcome, run.last_good_time), sheet.n, sheet.adaptive});
    row.uncertainty = uncertainty;
    if (run.succeeded()) {
      const model::Cloth cloth = model::compile(scene);
      const model::TriangleMesh surface = surface_at_end(scene, run);
      row.distance = distance_from(surface, fine.final_state.x);
      row.penetration = penetration_of(surface, cloth, model::size(scene) / 100, scene.end);
      row.height = height_at_end(cloth, run) - height;
    }
    group.push_back(refined_spec(scene, worth_method, worth_step));
    counts.push_back(std::max<std::size_t>(1, steps_to_time(run)));
    checkpoint.advance();
  }
  checkpoint.show(fmt::format("timing {}", name));
  const auto times =
      checkpoint.timed(fmt::format("times {}", name), [&] { return time_group(group, counts, quick ? 1 : 5, [] {}); });
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double seconds = static_cast<double>(counts[k]) * worth_step;
    rows[k].time = base::quantile(times[k], 0.5) / seconds;
    rows[k].lower = base::quantile(times[k], 0.25) / seconds;
    rows[k].upper = base::quantile(times[k], 0.75) / seconds;
  }
  const auto row_of = [&](int n, bool adaptive) {
    return std::ranges::find_if(rows, [&](const Worth& row) { return row.n == n && row.adaptive == adaptive; });
  };
  const auto few = row_of(claimed, true), many = row_of(claimed_as, false);
  if (few == rows.end() || many == rows.end()) return rows;
  few->verdict = {Standing::open, "no reference"};
  if (!few->uncertainty || !few->distance || !many->distance) return rows;
  const std::string figures = fmt::format("{:.2g} times the distance in {:.2g} of the time of 2500 plain ones",
                                          *few->distance / *many->distance, few->time / many->time);
  few->verdict = results::check(*few->distance <= *many->distance + *few->uncertainty, figures, figures);
  return rows;
}

results::Table worth_table(const std::vector<Worth>& rows) {
  results::Table table = results::make_table(
      "table-5.1-worth", "Coarse sheets with and without virtual particles beside the finest one", worth_columns, rows);
  using results::Part;
  draw(table, results::Figure::work_precision,
       {{Part::figure, "scene"},
        {Part::side, "sheet"},
        {Part::x, "distance"},
        {Part::y, "time"},
        {Part::lower, "lower"},
        {Part::upper, "upper"},
        {Part::detail, "particles"},
        {Part::detail, "penetration"}});
  return table;
}

// --- What forces that jump do ------------------------------------------------------------------------------------------------

constexpr double jump_steps[] = {0.01, 0.005, 0.0025, 0.00125};  // [s]
constexpr double jump_end = 0.3;                                 // [s]
constexpr std::string_view jump_scene = "round_table_100";

/// A method with and without virtual particles.
struct Jumps {
  std::string method;
  bool adaptive = false;
  std::string outcome;
  std::int64_t changes = 0;
  double updates = 0, cg_iterations = 0;
  std::optional<double> order = {};
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Jumps, method, adaptive, outcome, changes, updates, cg_iterations, order)

constexpr ColumnOf<Jumps> jump_columns[] = {
    {"method", "method", "", "time integrator, on round_table_100 until 0.3 s", Role::key, field<&Jumps::method>},
    {"adaptive", "virtual", "", "whether there are virtual particles", Role::key,
     [](const Jumps& row) { return results::to_datum(std::string(row.adaptive ? "yes" : "no")); }},
    {"divided", "divided", "1", "springs that the obstacle divides, summed over steps, h = 0.01 s", Role::counter,
     field<&Jumps::changes>},
    {"updates", "updates", "1", "a step, h = 0.01 s", Role::counter, field<&Jumps::updates>},
    {"cg_iterations", "CG", "1", "iterations a step, h = 0.01 s", Role::counter, field<&Jumps::cg_iterations>},
    {"order", "order", "1", "of positions at the end: slope of differences of neighbours among h = 0.01, …, 0.00125 s",
     Role::quantity, field<&Jumps::order>},
    {"outcome", "outcome", "", "how the run with h = 0.01 s ended", Role::outcome, field<&Jumps::outcome>},
};

Jumps jumps_of(std::string_view method, bool adaptive) {
  const model::Scene scene =
      refined_scene(jump_scene, {{"contact.adaptive", adaptive ? "true" : "false"}, {"end.time", fmt::format("{}", jump_end)}});
  Jumps row{std::string(method), adaptive, {}};
  std::vector<double> steps, differences;
  std::optional<Vectors> before;
  for (const double h : jump_steps) {
    const results::RunRecord run = record(refined_spec(scene, method, h));
    if (h == jump_steps[0]) {
      row.outcome = ending(run.outcome, run.last_good_time);
      row.changes = work_count(run, "divided_springs");
      if (!run.steps.empty()) {
        row.updates = mean(run.steps, &results::StepRecord::updates);
        row.cg_iterations = iterations(run.steps);
      }
    }
    if (!run.succeeded()) return row;
    if (before) {
      steps.push_back(h);
      differences.push_back((run.final_state.x - *before).norm());
    }
    before = run.final_state.x;
  }
  row.order = base::exponent(steps, differences);
  return row;
}

}  // namespace

std::vector<Job> table_5_1(const Question& question) {
  const bool quick = question.quick;
  const auto scenes = refined_scenes(quick);
  const std::span<const solver::Method> methods = solver::thesis_methods();
  const auto tried = methods.first(quick ? 1 : methods.size());
  return {job(
              "table-5.1", 1, [=](Checkpoint& checkpoint) { return refinement_costs(quick, checkpoint); },
              [](const std::vector<RefinementCost>& rows) {
                return results::make_table("table-5.1", "Table 5.1: what virtual particles cost", cost_columns, rows);
              }),
          job(
              "table-5.1-worth", static_cast<int>(scenes.size()) * (quick ? 2 : static_cast<int>(std::size(compared_sheets))),
              [=](Checkpoint& checkpoint) {
                std::vector<Worth> rows;
                checkpoint.each(scenes, [&](const PublishedRefinement& one) {
                  std::ranges::move(worth_on(one.scene, quick, checkpoint), std::back_inserter(rows));
                });
                return rows;
              },
              worth_table),
          job(
              "table-5.1-jumps", 2 * static_cast<int>(tried.size()),
              [=](Checkpoint& checkpoint) {
                std::vector<Jumps> rows;
                checkpoint.each(tried, [&](const solver::Method& method) {
                  for (const bool adaptive : {false, true}) {
                    const std::string id = fmt::format("{} adaptive = {}", method.name, adaptive);
                    checkpoint.show(id);
                    rows.push_back(checkpoint.once(id, [&] { return jumps_of(method.name, adaptive); }));
                    checkpoint.advance();
                  }
                });
                return rows;
              },
              [](const std::vector<Jumps>& rows) {
                return results::make_table("table-5.1-jumps", "What forces that jump from step to step do to methods",
                                           jump_columns, rows);
              })};
}

}  // namespace drape::bench
