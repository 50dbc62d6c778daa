#include "bench/studies/scaling/scaling.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "model/scene_file/scene_file.hpp"
#include "results/columns.hpp"
#include "solver/base/process.hpp"
#include "solver/base/statistics.hpp"
#include "solver/base/threads.hpp"

namespace drape::bench {
namespace scaling_study {

std::vector<int> sizes(bool quick) {
  if (quick) return {20, 40};
  return {20, 50, 100, 200, 316, 500, 1000};
}

namespace {

model::Scene hung_scene(int n) {
  const model::Override size[] = {{"grid.n", std::to_string(n)}};
  return model::load_scene("hung-edge", size);
}

}  // namespace

model::Cloth hung_sheet(int n) { return model::compile(hung_scene(n)); }

void with_threads(int n, const std::function<void(int threads)>& f) {
  for (const int threads : {1, 2}) {
    if (threads > 1 && n < 200) continue;
    base::use_threads(threads);
    f(threads);
  }
  base::use_threads(1);
}

void StepClock::observe(const solver::StepReport&) {
  times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count());
  if (between_) between_(static_cast<int>(times.size()));
  start();
}

void run_steps(int n, const std::string& method, const model::Cloth& cloth, int steps, StepClock& clock) {
  const RunSpec spec{hung_scene(n), "", &solver::method(method), step, {}};
  Observer* const observers[] = {&clock};
  const RunEnd end = run(spec, cloth, observers, {.steps = static_cast<std::size_t>(steps)});
  if (!end.succeeded()) throw std::runtime_error(fmt::format("a step of {} failed: {}", method, end.result.message));
}

namespace {

const std::vector<std::string> methods{"bdf2", "sbdf2"};

std::string_view linear_solver_of(const solver::Counters& work) {
  std::string_view used;
  for (const solver::LinearSolver& kind : solver::linear_solvers())
    if (work.count(fmt::format("linear_solver/{}", kind.name)) > 0) used = kind.name;
  return used;
}

/// What some steps cost on average, and what the run did in all.
struct StepCost {
  double seconds = 0, updates = 0, iterations = 0;  ///< a step
  int particles = 0;
  std::string linear_solver = {};
  std::int64_t escalations = 0;
  double memory = 0;  ///< [MB]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StepCost, seconds, updates, iterations, particles, linear_solver, escalations, memory)

StepCost time_steps(int n, const std::string& method) {
  constexpr int timed = 3;
  const model::Cloth cloth = hung_sheet(n);
  const solver::Counters& work = *cloth.ode.work;
  std::int64_t updates_before = 0, iterations_before = 0;
  StepClock clock([&](int steps) {
    if (steps != first_steps) return;
    updates_before = work.count("updates");
    iterations_before = work.count("cg_iterations");
  });
  run_steps(n, method, cloth, first_steps + timed, clock);
  return {.seconds = std::accumulate(clock.times.begin() + first_steps, clock.times.end(), 0.0) / timed,
          .updates = static_cast<double>(work.count("updates") - updates_before) / timed,
          .iterations = static_cast<double>(work.count("cg_iterations") - iterations_before) / timed,
          .particles = cloth.ode.particles(),
          .linear_solver = std::string(linear_solver_of(work)),
          .escalations = work.count("escalations"),
          .memory = base::peak_memory()};
}

/// Steps of a method on a size; or, without one, how their time grows with the size.
struct StepRow {
  std::string method;
  std::optional<int> n = {}, threads = {};
  std::optional<StepCost> cost = {};
  std::optional<double> exponent = {};
};

double nanoseconds_per_particle(const StepCost& cost) { return 1e9 * cost.seconds / cost.particles; }

using results::ColumnOf;
using results::Datum;
using results::field;
using results::Role;

constexpr ColumnOf<StepRow> run_columns[] = {
    {"n", "n", "1", "particles a side", Role::key, field<&StepRow::n>},
    {"threads", "threads", "1", "that the step may use", Role::key, field<&StepRow::threads>},
    {"method", "method", "", "time integrator", Role::key, field<&StepRow::method>},
};

constexpr ColumnOf<StepCost> cost_columns[] = {
    {"linear_solver", "chosen", "", "the linear solver that auto chose", Role::note, field<&StepCost::linear_solver>},
    {"step", "step", "ms", "mean wall time of a step", Role::time,
     [](const StepCost& cost) -> Datum { return 1e3 * cost.seconds; }},
    {"per_particle", "/particle", "ns", "the same, over the number of particles", Role::time,
     [](const StepCost& cost) -> Datum { return nanoseconds_per_particle(cost); }},
    {"updates", "updates", "1", "linear systems a step", Role::counter, field<&StepCost::updates>},
    {"per_update", "/update", "ns", "time over the number of particles and updates", Role::time,
     [](const StepCost& cost) -> Datum { return nanoseconds_per_particle(cost) / cost.updates; }},
    {"cg_iterations", "CG", "1", "iterations of conjugate gradients a step", Role::counter, field<&StepCost::iterations>},
    {"escalations", "to Newton", "1", "stages that auto gave to Newton's matrix", Role::counter, field<&StepCost::escalations>},
    {"memory", "memory", "MB", "most memory that the process had until then", Role::time, field<&StepCost::memory>},
};

constexpr ColumnOf<StepRow> exponent_columns[] = {
    {"exponent", "exponent", "1", "p in time ~ particles^p, one thread", Role::time, field<&StepRow::exponent>},
};

/// How the time of a method's steps grows, by its rows with one thread.
StepRow growth_of(const std::vector<StepRow>& rows, const std::string& method) {
  std::vector<double> particles, times;
  for (const StepRow& row : rows)
    if (row.method == method && row.threads == 1) {
      particles.push_back(row.cost->particles);
      times.push_back(row.cost->seconds);
    }
  return {.method = method, .exponent = base::exponent(particles, times)};
}

std::vector<StepRow> all_steps(bool quick, Checkpoint& checkpoint) {
  std::vector<StepRow> rows;
  checkpoint.each(sizes(quick), [&](const int n) {
    checkpoint.each(methods, [&](const std::string& method) {
      checkpoint.show(fmt::format("{} x {}, {}", n, n, method));
      with_threads(n, [&](int threads) {
        const std::string id = fmt::format("{} {} {}", n, method, threads);
        rows.push_back({method, n, threads, checkpoint.timed(id, [&] { return time_steps(n, method); })});
      });
      checkpoint.advance();
    });
  });
  for (const std::string& method : methods) rows.push_back(growth_of(rows, method));
  return rows;
}

results::Table steps_table(const std::vector<StepRow>& rows) {
  results::Table table = results::make_table(
      "scaling", fmt::format("A step of {:g} s of the sheet hung by its edge, by size; all solvers: auto", step), run_columns,
      rows);
  results::add_columns(table, cost_columns, rows, [](const StepRow& row) { return row.cost; });
  results::add_columns(table, exponent_columns, rows);
  return table;
}

}  // namespace

Job steps(bool quick) {
  return job(
      "scaling", static_cast<int>(sizes(quick).size() * std::size(methods)),
      [quick](Checkpoint& checkpoint) { return all_steps(quick, checkpoint); }, steps_table);
}

}  // namespace scaling_study

std::vector<Job> scaling(const Question& question) {
  return {scaling_study::steps(question.quick), scaling_study::iterations(question.quick), scaling_study::bars(question.quick)};
}

}  // namespace drape::bench
