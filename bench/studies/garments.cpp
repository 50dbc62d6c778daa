#include "bench/studies/garments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/runs/checkpoint_json.hpp"
#include "bench/runs/costs.hpp"
#include "bench/runs/record.hpp"
#include "bench/runs/timing.hpp"
#include "bench/studies/studies.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"
#include "solver/base/statistics.hpp"

namespace drape::bench {
namespace {

using results::ColumnOf;
using results::Datum;
using results::field;
using results::Role;
using results::Verdict;

constexpr double usual_step = 0.01;  // [s], that of the thesis
constexpr double longer_steps[] = {0.02, 0.04}, shorter_steps[] = {0.005, 0.0025};

/// How deep a particle may be within the distance that is kept [m].
constexpr double negligible_depth = 1e-9;

model::Scene scene_of(const std::string& name, bool quick) {
  model::Scene scene = model::load_scene(name);
  if (quick) scene.end = 0.03;
  return scene;
}

bool stays_outside(const model::Scene& scene, const results::RunRecord& run) {
  return run.contact->clearance >= scene.contact.distance - negligible_depth;
}

// --- The dress of table 3.2 -------------------------------------------------------------------------------------------------

/// The dress as the thesis prints it: 1310 particles, 5 s, k = 300 N/m; times are of a Pentium III.
const std::map<std::string_view, PublishedRun> published_dress{{"imex-euler", {{500, 17198}, 152.7}},
                                                               {"implicit-euler", {{1654, 21424}, 204.9}},
                                                               {"sbdf2", {{500, 15360}, 169.5}},
                                                               {"bdf2", {{1431, 19307}, 194.4}},
                                                               {"midpoint", {{2078, 15877}, 211.3}}};

/// A method on the dress.
struct DressRun {
  std::string solver, method, outcome;
  std::int64_t updates = 0, cg_iterations = 0;
  double clearance = 0, energy_rise = 0, solver_ms = 0;
  std::optional<std::int64_t> thesis_updates = {}, thesis_cg = {};
  std::optional<double> thesis_seconds = {};
  std::string verdict = {};
  bool as_told = false;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DressRun, solver, method, outcome, updates, cg_iterations, clearance, energy_rise, solver_ms,
                                   thesis_updates, thesis_cg, thesis_seconds, verdict, as_told)

/// What the thesis orders: "the second order methods reduce work against the Euler method of their class".
struct Ordering {
  std::string_view less, more;
};
constexpr Ordering orderings[] = {{"sbdf2", "imex-euler"}, {"bdf2", "implicit-euler"}};

void judge(std::vector<DressRun>& rows) {
  for (DressRun& row : rows)
    for (const Ordering& ordering : orderings) {
      if (row.solver != "thesis" || row.method != ordering.less) continue;  // direct solvers have no iterations
      const auto other = std::ranges::find_if(
          rows, [&](const DressRun& one) { return one.method == ordering.more && one.solver == row.solver; });
      if (other == rows.end()) continue;
      row.as_told = row.cg_iterations < other->cg_iterations;
      row.verdict = fmt::format("{} CG iterations than {}", row.as_told ? "fewer" : "not fewer", ordering.more);
    }
}

constexpr ColumnOf<DressRun> dress_columns[] = {
    {"solver", "solvers", "", "the loop of the thesis with CG and incomplete Cholesky, or our defaults", Role::key,
     field<&DressRun::solver>},
    {"method", "method", "", "time integrator", Role::key, field<&DressRun::method>},
    {"updates", "updates", "1", "of the stage solver; of IMEX methods one a step, more in contact", Role::counter,
     field<&DressRun::updates>},
    {"cg_iterations", "CG", "1", "iterations of conjugate gradients", Role::counter, field<&DressRun::cg_iterations>},
    {"clearance", "clearance", "m", "least distance of a particle from the mannequin; 0.02 m are kept", Role::quantity,
     field<&DressRun::clearance>},
    {"energy_rise", "energy rise", "1", "largest rise of the total energy, over the run's energies", Role::quantity,
     field<&DressRun::energy_rise>},
    {"outcome", "outcome", "", "how the run ended", Role::outcome, field<&DressRun::outcome>},
    {"thesis_updates", "thesis: updates", "1", "printed in the thesis", Role::note, field<&DressRun::thesis_updates>},
    {"thesis_cg_iterations", "thesis: CG", "1", "printed in the thesis", Role::note, field<&DressRun::thesis_cg>},
    {"solver_ms", "solver", "ms", "wall time of the run: solver, detection and response; median of interleaved runs",
     Role::time, field<&DressRun::solver_ms>},
    {"thesis_seconds", "thesis: solver", "s", "printed in the thesis: Pentium III, 660 MHz", Role::note,
     field<&DressRun::thesis_seconds>},
    {"verdict", "as the thesis says", "", "whether a method of second order reduces work against Euler's of its class",
     Role::verdict,
     [](const DressRun& row) {
       return row.verdict.empty() ? Datum() : results::to_datum(results::check(row.as_told, row.verdict, row.verdict));
     }},
};

std::vector<DressRun> run_dress(bool quick, Checkpoint& checkpoint) {
  Group group;
  std::vector<DressRun> rows;
  const model::Scene scene = scene_of("dress", quick);
  for (const auto& [name, options] : {std::pair("thesis", solver::thesis_options()), {"defaults", solver::Options()}})
    for (const solver::Method& method : solver::thesis_methods()) {
      const auto published = published_dress.find(method.name);
      if (published == published_dress.end()) continue;
      group.push_back({scene, "", &method, usual_step, options});
      DressRun& row = rows.emplace_back(DressRun{name, std::string(method.name), {}});
      const PublishedRun& printed = published->second;
      row.thesis_updates = printed.work.updates, row.thesis_cg = printed.work.cg_iterations;
      row.thesis_seconds = printed.seconds;
    }
  std::vector<std::size_t> counts;
  std::size_t k = 0;
  checkpoint.each(rows, [&](DressRun& row) {
    const RunSpec& spec = group[k++];
    const auto run = checkpoint.once(fmt::format("dress {} {}", row.solver, row.method), [&] {
      checkpoint.show(fmt::format("dress, {} with the solvers of {}", row.method, row.solver));
      return record(spec);
    });
    row.updates = work_count(run, "updates"), row.cg_iterations = work_count(run, "cg_iterations");
    row.clearance = run.contact->clearance, row.energy_rise = run.contact->energy_rise;
    row.outcome = ending(run.outcome, run.last_good_time);
    counts.push_back(steps_to_time(run));
    checkpoint.advance();
  });
  checkpoint.show("timing the dress");
  const auto times = checkpoint.timed("times dress", [&] { return time_group(group, counts, quick ? 1 : 3, [] {}); });
  for (k = 0; k < rows.size(); ++k) rows[k].solver_ms = base::quantile(times[k], 0.5);
  judge(rows);
  return rows;
}

// --- All garments ------------------------------------------------------------------------------------------------------------

constexpr const char* garment_scenes[] = {"dress", "sewn_dress", "walking_dress", "sweater", "trousers"};
constexpr const char* garment_methods[] = {"imex-euler", "sbdf2", "implicit-euler", "bdf2", "midpoint", "bridson"};
constexpr double most_seconds = 1200;  // a run

/// A reference is trusted up to this disagreement, over the size of the scene.
constexpr double trusted = 0.01;

/// A method on a garment.
struct GarmentRun {
  std::string scene, method, outcome;
  std::int64_t particles = 0;
  double forces = 0, detection = 0, response = 0, rest = 0;  ///< [ms] a simulated second, medians
  double spread = 0;                                         ///< of the total
  double clearance = 0, energy_rise = 0, area = 0;
  std::optional<double> largest_step = {}, off = {}, unsure = {}, area_off = {}, area_unsure = {}, centre_off = {},
                        centre_unsure = {};

  double total() const { return forces + detection + response + rest; }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(GarmentRun, scene, method, outcome, particles, forces, detection, response, rest, spread,
                                   clearance, energy_rise, area, largest_step, off, unsure, area_off, area_unsure, centre_off,
                                   centre_unsure)

constexpr double real_time = 1000;  // [ms/s]

constexpr ColumnOf<GarmentRun> garment_columns[] = {
    {"scene", "scene", "", "built-in scene", Role::key, field<&GarmentRun::scene>},
    {"particles", "particles", "1", "that move", Role::key, field<&GarmentRun::particles>},
    {"method", "method", "", "time integrator, h = 0.01 s", Role::key, field<&GarmentRun::method>},
    {"forces", "forces", "ms/s", "wall time a simulated second: forces, their parts and derivatives", Role::time,
     field<&GarmentRun::forces>},
    {"detection", "detection", "ms/s", "of contacts", Role::time, field<&GarmentRun::detection>},
    {"response", "response", "ms/s", "to contacts: which constraints hold, friction", Role::time, field<&GarmentRun::response>},
    {"rest", "systems", "ms/s", "linear systems, which contacts make more", Role::time, field<&GarmentRun::rest>},
    {"total", "total", "ms/s", "of all, median", Role::time,
     [](const GarmentRun& row) { return results::to_datum(row.total()); }},
    {"spread", "±", "ms/s", "half the range of the total in interleaved repetitions", Role::time, field<&GarmentRun::spread>},
    {"clearance", "clearance", "m", "least distance of a particle from the body, a part of which is kept", Role::quantity,
     field<&GarmentRun::clearance>},
    {"energy_rise", "energy rise", "1", "largest rise of the total energy, over the run's energies", Role::quantity,
     field<&GarmentRun::energy_rise>},
    {"outcome", "outcome", "", "how the run ended", Role::outcome, field<&GarmentRun::outcome>},
    {"largest_step", "largest h", "s", "of 0.0025, 0.005, 0.01, 0.02 and 0.04 with which the run ends and nothing is inside",
     Role::quantity, field<&GarmentRun::largest_step>},
    {"off", "off", "m", "root mean square distance at the end from the reference, if it is trusted", Role::error,
     field<&GarmentRun::off>},
    {"unsure", "±", "m", "largest distance of the reference from its two witnesses", Role::uncertainty,
     field<&GarmentRun::unsure>},
    {"centre_off", "centre off", "m", "distance of the particles' mean position at the end from the reference's", Role::error,
     field<&GarmentRun::centre_off>},
    {"centre_unsure", "±", "m", "the same of the witnesses", Role::uncertainty, field<&GarmentRun::centre_unsure>},
    {"area", "contact", "1", "area in contact at the end, over that of the cloth", Role::quantity, field<&GarmentRun::area>},
    {"area_off", "contact off", "1", "difference from the reference's", Role::error, field<&GarmentRun::area_off>},
    {"area_unsure", "±", "1", "the same of the witnesses", Role::uncertainty, field<&GarmentRun::area_unsure>},
    {"verdict", "real time", "", "whether it takes less than the time that it simulates", Role::verdict,
     [](const GarmentRun& row) {
       if (row.outcome != "success") return Datum();
       const std::string factor = fmt::format("{:.2g} times real time", row.total() / real_time);
       return results::to_datum(results::check(row.total() < real_time, factor, factor));
     }},
};

results::RunRecord run_garment(const model::Scene& scene, std::string_view method, double h) {
  Limits limits;
  limits.seconds = most_seconds;
  return record({scene, "", &solver::method(method), h, {}}, {}, limits);
}

double distance_between(const results::RunRecord& one, const results::RunRecord& other) {
  return std::sqrt((one.final_state.x - other.final_state.x).rowwise().squaredNorm().mean());
}

double centre_distance(const results::RunRecord& one, const results::RunRecord& other) {
  return (one.final_state.x - other.final_state.x).colwise().mean().norm();
}

double area_difference(const results::RunRecord& one, const results::RunRecord& other) {
  return std::abs(one.contact->area - other.contact->area);
}

/// What contact has in the place of a certified reference: BDF(2) with a quarter of the step, and two witnesses, BDF(2) with
/// half of the step and explicit sub-steps, whose response to contacts shares no code with that of BDF(2), with a quarter.
class GarmentReference {
 public:
  template <class Run>
  GarmentReference(const model::Scene& scene, const Run& run)
      : finest_(run("bdf2", usual_step / 4)),
        witnesses_{run("bdf2", usual_step / 2), run("verlet", usual_step / 4)},
        size_(model::size(scene)) {}

  bool exists() const {
    return finest_.outcome == solver::Outcome::success &&
           std::ranges::all_of(witnesses_, [](const auto& run) { return run.outcome == solver::Outcome::success; });
  }

  /// Sets the differences of a run that succeeded.
  void compare(const results::RunRecord& run, GarmentRun& row) const {
    row.unsure = unsure(distance_between);
    if (*row.unsure <= trusted * size_) row.off = distance_between(run, finest_);
    row.centre_off = centre_distance(run, finest_), row.centre_unsure = unsure(centre_distance);
    row.area_off = area_difference(run, finest_), row.area_unsure = unsure(area_difference);
  }

 private:
  double unsure(double (*difference)(const results::RunRecord&, const results::RunRecord&)) const {
    return std::max(difference(witnesses_[0], finest_), difference(witnesses_[1], finest_));
  }

  results::RunRecord finest_;
  std::array<results::RunRecord, 2> witnesses_;
  double size_;  ///< [m]
};

/// The largest step with which nothing is inside at the end: from the usual one upwards while that is so, else downwards until
/// it is. `ends_well`: whether it is so of a step.
std::optional<double> largest_step(const std::function<bool(double)>& ends_well) {
  if (ends_well(usual_step)) {
    double largest = usual_step;
    for (const double h : longer_steps)
      if (!ends_well(h))
        return largest;
      else
        largest = h;
    return largest;
  }
  for (const double h : shorter_steps)
    if (ends_well(h)) return h;
  return {};
}

std::vector<GarmentRun> run_scene(const std::string& name, bool quick, Checkpoint& checkpoint) {
  const model::Scene scene = scene_of(name, quick);
  const auto kept = [&](std::string_view method, double h) {
    return checkpoint.once(fmt::format("{} {} {}", name, method, h), [&] {
      checkpoint.show(fmt::format("{} {} h = {}", name, method, h));
      return run_garment(scene, method, h);
    });
  };
  const GarmentReference reference(scene, kept);
  std::vector<GarmentRun> rows;
  Group group;
  std::vector<std::size_t> counts;
  checkpoint.each(garment_methods, [&](const std::string_view method) {
    const auto run = kept(method, usual_step);
    GarmentRun& row = rows.emplace_back(GarmentRun{name, std::string(method), std::string(to_string(run.outcome))});
    row.particles = model::nodes(scene);
    row.clearance = run.contact->clearance, row.energy_rise = run.contact->energy_rise, row.area = run.contact->area;
    if (reference.exists() && run.outcome == solver::Outcome::success) reference.compare(run, row);
    row.largest_step = largest_step([&](double h) {
      const auto tried = kept(method, h);
      return tried.outcome == solver::Outcome::success && stays_outside(scene, tried);
    });
    group.push_back({scene, "", &solver::method(method), usual_step, {}});
    counts.push_back(steps_to_time(run));
    checkpoint.advance();
  });
  checkpoint.show("timing " + name);
  return checkpoint.timed("costs " + name, [&] {
    const std::vector<MedianCosts> times = median_costs(group, counts, quick ? 1 : 3);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const Costs& median = times[k].median;
      rows[k].forces = median.forces, rows[k].detection = median.detection;
      rows[k].response = median.response, rows[k].rest = median.rest, rows[k].spread = times[k].spread;
    }
    return rows;
  });
}

}  // namespace

Job dress_block(bool quick) {
  const auto compute = [quick](Checkpoint& checkpoint) { return run_dress(quick, checkpoint); };
  return job("table-3.2-dress", static_cast<int>(2 * published_dress.size()), compute, [](const std::vector<DressRun>& rows) {
    return results::make_table("table-3.2-dress",
                               "Table 3.2: the methods on the dress; the thesis' figures are from a Pentium III", dress_columns,
                               rows);
  });
}

std::vector<Job> garments(const Question& question) {
  const bool quick = question.quick;
  std::vector<Job> jobs;
  for (const std::string name : garment_scenes)
    jobs.push_back(job(
        "garment " + name, static_cast<int>(std::size(garment_methods)),
        [=](Checkpoint& checkpoint) { return run_scene(name, quick, checkpoint); },
        [name](const std::vector<GarmentRun>& rows) {
          return results::make_table("garment-" + name, "Methods on the scene " + name, garment_columns, rows);
        }));
  return jobs;
}

}  // namespace drape::bench
