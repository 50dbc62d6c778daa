#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/record.hpp"
#include "bench/runs/sweep_options.hpp"
#include "bench/runs/timing.hpp"
#include "bench/studies/refinement.hpp"
#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/analysis/order_fit.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"
#include "solver/base/statistics.hpp"

/// Moduli that relax (2.4.2): how well Maxwell elements keep a quality, what a strip loses in a cycle, which orders methods
/// have, what memory costs them.
namespace drape::bench {
namespace {

using model::Band;
using model::Spectrum;
using results::ColumnOf;
using results::field;
using results::Role;

// --- The fit of a constant quality -------------------------------------------------------------------------------------------

constexpr double quality_deviation = 0.07;  ///< that is allowed throughout the band

struct QualityFit {
  double wished = 0, first = 0, last = 0;
  std::int64_t elements = 0;
  double lowest = 0, highest = 0, relaxed = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(QualityFit, wished, first, last, elements, lowest, highest, relaxed)

constexpr ColumnOf<QualityFit> quality_columns[] = {
    {"wished", "Q", "1", "quality that is asked for", Role::key, field<&QualityFit::wished>},
    {"first", "from", "rad/s", "lowest frequency of the band", Role::key, field<&QualityFit::first>},
    {"last", "to", "rad/s", "highest frequency of the band", Role::key, field<&QualityFit::last>},
    {"elements", "elements", "1", "Maxwell elements of the fit", Role::counter, field<&QualityFit::elements>},
    {"lowest", "lowest Q", "1", "in the band", Role::quantity, field<&QualityFit::lowest>},
    {"highest", "highest Q", "1", "in the band", Role::quantity, field<&QualityFit::highest>},
    {"relaxed", "relaxed", "1", "modulus of rest over that of sudden strains", Role::quantity, field<&QualityFit::relaxed>},
    {"verdict", "verdict", "", "whether Q is within 7 % of what is asked for", Role::verdict,
     [](const QualityFit& fit) {
       const bool keeps = fit.elements > 0 && fit.lowest >= (1 - quality_deviation) * fit.wished &&
                          fit.highest <= (1 + quality_deviation) * fit.wished;
       return results::to_datum(results::check(keeps, "within 7 %", "not within 7 %"));
     }},
};

QualityFit quality_fit(double wished, const Band& band) {
  const Spectrum spectrum = model::constant_quality(wished, band);
  QualityFit fit{wished, band[0], band[1], std::ssize(spectrum)};
  fit.lowest = wished * 1e9;
  for (const double w : model::frequencies(band, 1999)) {
    fit.lowest = std::min(fit.lowest, model::quality(spectrum, w));
    fit.highest = std::max(fit.highest, model::quality(spectrum, w));
  }
  fit.relaxed = complex_modulus(spectrum, 0).real();
  return fit;
}

std::vector<QualityFit> quality_fits(Checkpoint& checkpoint) {
  std::vector<QualityFit> fits;
  for (const double wished : {5.0, 10.0, 20.0, 100.0})
    for (const Band& band : {Band{1, 10}, Band{1, 1000}, Band{1, 1e6}}) fits.push_back(quality_fit(wished, band));
  checkpoint.advance();
  return fits;
}

// --- Cycles of a strip -------------------------------------------------------------------------------------------------------

constexpr double cycle_quality = 10;
constexpr Band cycle_band = {1, 1000};
constexpr double cycle_amplitude = 0.03;  ///< strain
constexpr int cycle_judged = 200;         ///< steps a period at which the error is judged
constexpr double cycle_allowed = 1e-4;

struct Cycle {
  double frequency = 0;
  std::int64_t steps = 0;
  double area = 0, closed_form = 0;
  std::optional<double> order = {};
  std::optional<results::FittedCurve> curve = {};

  double error() const { return std::abs(area / closed_form - 1); }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Cycle, frequency, steps, area, closed_form, order)

/// One edge between two hands that pull it by ε sin ωt, for one period of many; the loss is ∮ σ dε/dt dt, for which the
/// rectangle rule is exact. So what is left is the error of internal variables on a path of straight lines.
Cycle cycle(double omega, int steps) {
  model::Scene scene;
  scene.sheet.grid = {.nu = 2, .nv = 1, .size_u = 0.2, .size_v = 0.05};
  model::Material& material = scene.sheet.material;
  material.tension = {300, 300};
  material.relaxation.quality = cycle_quality;
  material.relaxation.band = cycle_band;
  const Spectrum spectrum = material.relaxation.spectrum();
  const model::Cloth cloth = model::compile(scene);
  solver::State y = cloth.start;
  for (std::size_t l = 0; l < spectrum.size(); ++l)
    y.z[static_cast<Eigen::Index>(l)] =
        cycle_amplitude * (spectrum[l].rate / std::complex<double>(spectrum[l].rate, omega)).imag();
  constexpr int order = 2;
  cloth.ode.memory->begin(order, 0, y);
  solver::Vectors f;
  const double period = 2 * std::numbers::pi / omega, h = period / steps;
  Cycle result{omega, steps};
  for (int n = 1; n <= steps; ++n) {
    const double t = n * h;
    y.x(1, 0) = y.x(0, 0) + (1 + cycle_amplitude * std::sin(omega * t)) * scene.sheet.grid.size_u;
    cloth.ode.memory->carry(t, y);
    cloth.ode.memory->pass(t, y);
    cloth.ode.force(t, y.x, y.v, f);
    result.area += f(0, 0) / scene.sheet.grid.size_v * cycle_amplitude * omega * std::cos(omega * t) * h;
  }
  result.closed_form =
      std::numbers::pi * cycle_amplitude * cycle_amplitude * material.tension.weft * complex_modulus(spectrum, omega).imag();
  return result;
}

std::vector<Cycle> cycles(Checkpoint& checkpoint) {
  std::vector<Cycle> rows;
  for (const double omega : {1.0, 10.0, 100.0, 1000.0}) {
    std::vector<double> sizes, errors;
    const std::size_t first = rows.size();
    for (const int steps : {25, 50, 100, 200, 400}) {
      rows.push_back(cycle(omega, steps));
      sizes.push_back(1.0 / steps);
      errors.push_back(rows.back().error());
      if (errors.size() > 1) rows.back().order = std::log2(errors[errors.size() - 2] / errors.back());
    }
    const auto fit = results::fit_order(sizes, errors, 0);
    constexpr int order = 2;
    rows[first].curve = {fit, results::order_verdict(fit, order)};
  }
  checkpoint.advance();
  return rows;
}

constexpr ColumnOf<Cycle> cycle_columns[] = {
    {"frequency", "ω", "rad/s", "of the pull", Role::key, field<&Cycle::frequency>},
    {"pull", "", "", "of which frequency", Role::note,
     [](const Cycle& row) { return results::to_datum(fmt::format("{:g} rad/s", row.frequency)); }},
    {"steps", "steps", "1", "in a period", Role::key, field<&Cycle::steps>},
    {"area", "loss", "J/m²", "work of a period", Role::quantity, field<&Cycle::area>},
    {"closed_form", "closed form", "J/m²", "π ε² Im C(ω)", Role::quantity, field<&Cycle::closed_form>},
    {"error", "error", "1", "of the loss, relatively", Role::error,
     [](const Cycle& row) { return results::to_datum(row.error()); }},
    {"order", "order", "1", "between this number of steps and the one before", Role::note, field<&Cycle::order>},
    {"judged", "at 200 steps", "", "whether the error at 200 steps a period is below 1e-4", Role::verdict,
     [](const Cycle& row) {
       if (row.steps != cycle_judged) return results::Datum();
       return results::to_datum(results::check(row.error() < cycle_allowed, "below 1e-4", "not below 1e-4"));
     }},
};

results::Table cycle_table(const std::vector<Cycle>& rows) {
  results::Table table = results::make_table(
      "memory-cycles", "Loss of a strip that is pulled harmonically, Q = 10 from 1 to 1000 rad/s, against its closed form",
      cycle_columns, rows);
  results::add_columns(table, results::fit_columns, rows, std::mem_fn(&Cycle::curve));
  using results::Part;
  draw(table, results::Figure::convergence,
       {{Part::curve, "pull"}, {Part::x, "steps"}, {Part::y, "error"}, {Part::detail, "order"}});
  return table;
}

// --- Orders ------------------------------------------------------------------------------------------------------------------

/// The sheet on which all orders can be seen, with moduli that relax as fast as it moves, and faster.
model::Scene relaxing_scene() {
  model::Scene scene = smooth_scene();
  scene.name = "relaxing";
  scene.sheet.material.relaxation.maxwell = {{2, 0.2}, {20, 0.2}, {200, 0.1}};
  return scene;
}

/// The same sheet with friction between its yarns, and with curves that have a kink or a loop: slopes that jump.
model::Scene rubbing_scene(model::FrictionKind law) {
  model::Scene scene = smooth_scene();
  scene.name = law == model::FrictionKind::dahl ? "dahl" : "jenkin";
  scene.sheet.material.friction = {.law = law, .shear = 0.02, .shear_onset = 0.01, .bend = {1e-4, 1e-4}, .bend_onset = 0.5};
  return scene;
}

model::Scene curved_scene(bool loops) {
  model::Scene scene = smooth_scene();
  scene.name = loops ? "loop" : "kink";
  model::Material& m = scene.sheet.material;
  const double k = m.tension.weft;
  m.weft_curve.loading = model::Polyline({{0, 0}, {0.005, 0.005 * k}, {0.05, 0.14 * k}});
  if (loops) m.weft_curve.unloading = model::Polyline({{0, 0}, {0.5, 0.4}, {1, 1}});
  return scene;
}

// --- What it costs -----------------------------------------------------------------------------------------------------------

constexpr double cost_step = 0.01;  ///< [s]
constexpr Band cost_band = {1, 1e4};

struct MemoryCost {
  double quality = 0;
  std::string method;
  std::int64_t variables = 0, updates = 0, cg = 0, builds = 0, memory_updates = 0;
  std::optional<double> error = {}, uncertainty = {};
  std::string outcome = {};
  std::vector<double> times = {};
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MemoryCost, quality, method, variables, updates, cg, builds, memory_updates, error,
                                   uncertainty, outcome, times)

constexpr ColumnOf<MemoryCost> memory_cost_columns[] = {
    {"quality", "Q", "1", "of tension and shear from 1 to 10⁴ rad/s; 0: they do not relax", Role::key,
     field<&MemoryCost::quality>},
    {"method", "method", "", "time integrator, h = 0.01 s", Role::key, field<&MemoryCost::method>},
    {"variables", "variables", "1", "internal variables of all edges and cells", Role::counter, field<&MemoryCost::variables>},
    {"updates", "updates", "1", "linear systems solved", Role::counter, field<&MemoryCost::updates>},
    {"cg", "CG", "1", "CG iterations", Role::counter, field<&MemoryCost::cg>},
    {"builds", "matrices", "1", "constant matrices assembled and factored", Role::counter, field<&MemoryCost::builds>},
    {"memory_updates", "memory", "1", "updates of all internal variables", Role::counter, field<&MemoryCost::memory_updates>},
    {"error", "rms error", "1", "at the end, over the size", Role::error, field<&MemoryCost::error>},
    {"uncertainty", "", "1", "of the reference", Role::uncertainty, field<&MemoryCost::uncertainty>},
    {"outcome", "outcome", "", "how the run ended", Role::note, field<&MemoryCost::outcome>},
    {"ms", "time", "ms", "wall time, median of interleaved runs", Role::time,
     [](const MemoryCost& row) {
       return row.times.empty() ? results::Datum() : results::to_datum(base::quantile(row.times, 0.5));
     }},
};

std::vector<MemoryCost> costs_of(double quality, bool quick, Checkpoint& checkpoint) {
  std::vector<model::Override> changes{{"material.damping", "0.5"}};
  if (quality > 0) {
    changes.push_back({"material.quality", fmt::format("{:g}", quality)});
    changes.push_back({"material.band", fmt::format("[{:g}, {:g}]", cost_band[0], cost_band[1])});
  }
  if (quick) changes.insert(changes.end(), {{"grid.n", "6"}, {"end.time", "0.1"}});
  const model::Scene scene = model::load_scene("hung-corners", changes);
  const model::Cloth cloth = model::compile(scene);
  checkpoint.show(fmt::format("Q = {:g}", quality));
  References references(SweepOptions().agreement, {}, 1e-9);
  const reference::Reference reference = references(scene, cloth);
  std::vector<MemoryCost> rows;
  Group group;
  std::vector<std::size_t> most_steps;
  for (const solver::Method& method : solver::thesis_methods()) {
    group.push_back({scene, "", &method, cost_step, {}});
    const results::RunRecord run = record(group.back());
    MemoryCost row{.quality = quality, .method = std::string(method.name), .variables = cloth.plan.internal_variables};
    row.updates = results::work_count(run, "updates");
    row.cg = results::work_count(run, "cg_iterations");
    row.builds = results::work_count(run, "matrix_builds");
    row.memory_updates = results::work_count(run, "memory_updates");
    row.outcome = run.succeeded() ? "success" : fmt::format("{} at {:.2g} s", to_string(run.outcome), run.last_good_time);
    if (run.succeeded()) {
      const results::ErrorRecord error = distance(run, reference, scene, cloth);
      row.error = error.rms;
      row.uncertainty = error.reference_error;
    }
    rows.push_back(std::move(row));
    most_steps.push_back(steps_to_time(run));
  }
  constexpr int repetitions = 5;
  const auto times = time_group(group, most_steps, quick ? 1 : repetitions, [] {});
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k].times = times[k];
  return rows;
}

constexpr double cost_qualities[] = {0, 100, 20, 5};

std::vector<MemoryCost> costs(bool quick, Checkpoint& checkpoint) {
  std::vector<MemoryCost> all;
  checkpoint.each(cost_qualities, [&](const double quality) {
    const auto rows = checkpoint.timed(fmt::format("cost {:g}", quality), [&] { return costs_of(quality, quick, checkpoint); });
    all.insert(all.end(), rows.begin(), rows.end());
    checkpoint.advance();
  });
  return all;
}

}  // namespace

std::vector<Job> memory(const Question& question) {
  const double most_work = question.quick ? 1e6 : 4e6;
  std::vector<Job> jobs{
      job("memory-quality", 1, quality_fits,
          [](const std::vector<QualityFit>& fits) {
            return results::make_table("memory-quality", "Maxwell elements for a quality that is the same throughout a band",
                                       quality_columns, fits);
          }),
      job("memory-cycles", 1, cycles, cycle_table), orders_on(relaxing_scene(), most_work, converging_or(question.methods))};
  Methods few = question.methods;
  if (few.empty()) {
    for (const solver::Method& method : solver::thesis_methods()) few.push_back(&method);
    for (const char* method : {"bdf3", "esdirk3", "ros3p"}) few.push_back(&solver::method(method));
  }
  for (const model::Scene& scene : {rubbing_scene(model::FrictionKind::dahl), rubbing_scene(model::FrictionKind::jenkin),
                                    curved_scene(false), curved_scene(true)})
    jobs.push_back(orders_on(scene, most_work, few));
  jobs.push_back(job(
      "memory-cost", static_cast<int>(std::size(cost_qualities)),
      [quick = question.quick](Checkpoint& checkpoint) { return costs(quick, checkpoint); },
      [](const std::vector<MemoryCost>& rows) {
        return results::make_table("memory-cost", "What relaxing moduli cost on hung-corners, d = 0.5", memory_cost_columns,
                                   rows);
      }));
  return jobs;
}

}  // namespace drape::bench
