#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "bench/strips/launch.hpp"
#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/sundials/cvode.hpp"
#include "results/columns.hpp"
#include "solver/integrator.hpp"

/// One huge sheet in strips, a process each: whether it moves as in one process, and how its time grows.
namespace drape::bench::strips {
namespace {

using results::ColumnOf;
using results::Datum;
using results::field;
using results::Role;
using solver::State;

constexpr double limit = 7200;  ///< for a run [s]

/// nu × nv particles of the sheet hung by its corners, whose cells are square.
model::Scene sheet(int nu, int nv, double damping) {
  const model::Override overrides[] = {{"grid.n", fmt::format("[{}, {}]", nu, nv)},
                                       {"grid.size", fmt::format("[0.8, {}]", 0.8 * (nv - 1) / (nu - 1))},
                                       {"material.damping", fmt::format("{}", damping)}};
  return model::load_scene("hung-corners", overrides);
}

/// The largest distance of a coordinate; absent if there is nothing to compare with [m].
std::optional<double> distance(const State& a, const State& b) {
  if (a.x.rows() != b.x.rows()) return {};
  return (a.x - b.x).cwiseAbs().maxCoeff();
}

// --- Whether it is the same motion ---------------------------------------------------------------------------------------

/// A method in a number of processes, compared at the end.
struct EqualityRow {
  std::string method;
  int processes;
  std::optional<double> from_one, from_here, from_reference;  ///< largest distances of coordinates [m]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EqualityRow, method, processes, from_one, from_here, from_reference)

/// The end by this program, with its own factor instead of hypre; empty for methods of SUNDIALS.
State end_here(const model::Scene& scene, const Problem& problem) {
  if (is_of_sundials(problem.method)) return {};
  const model::Cloth cloth = model::compile(scene);
  solver::Options options;
  options.stage = &solver::stage_kind(problem.stage_solver);
  options.linear_solver = &solver::linear_solver("cholesky");
  solver::Integrator integrator(cloth.ode, solver::method(problem.method), options, cloth.start);
  for (int k = 0; k < problem.steps; ++k) integrator.step(problem.step);
  return integrator.state();
}

std::vector<EqualityRow> equality(bool quick, Checkpoint& checkpoint) {
  const int n = quick ? 12 : 40;
  const model::Scene scene = sheet(n, n, 5);
  const model::Cloth cloth = model::compile(scene);
  Problem problem{.scene = model::to_toml(scene), .step = 1e-3, .steps = quick ? 20 : 100, .writes_state = true};
  const std::vector<double> times{problem.step * problem.steps};
  std::optional<State> reference;  // for the first method that no process before this one has compared
  std::vector<EqualityRow> rows;
  for (const std::string_view method : methods()) {
    problem.method = method;
    checkpoint.show(fmt::format("equality: {}", method));
    const auto compare = [&] {
      std::vector<EqualityRow> all;
      const State here = end_here(scene, problem);
      if (!reference)
        reference = reference::cvode(cloth.ode, cloth.start, 0, times, {.rtol = 1e-10, .size = 0.8}).states.back();
      State one;
      for (const int processes : {1, 2, 3}) {
        const State end = run_strips(problem, processes, limit).end;
        if (processes == 1) one = end;
        all.push_back({problem.method, processes, processes == 1 ? std::nullopt : distance(end, one), distance(end, here),
                       distance(end, *reference)});
      }
      return all;
    };
    const auto compared = checkpoint.once(problem.method, compare);
    rows.insert(rows.end(), compared.begin(), compared.end());
    checkpoint.advance();
  }
  return rows;
}

/// To round-off, which grows while the sheet moves; methods of SUNDIALS choose other steps where norms differ by that.
results::Verdict same_motion(const EqualityRow& row) {
  constexpr double round_off = 1e-10;
  const double largest = std::max(row.from_one.value_or(0), row.from_here.value_or(0));
  const double allowed = is_of_sundials(row.method) ? 1e-6 : round_off;
  return results::check(largest <= allowed, fmt::format("within {:g}", allowed), fmt::format("off by {:.2g}", largest));
}

constexpr ColumnOf<EqualityRow> equality_columns[] = {
    {"method", "method", "", "", Role::key, field<&EqualityRow::method>},
    {"processes", "processes", "1", "", Role::key, field<&EqualityRow::processes>},
    {"from_one", "from one process", "m", "largest distance of coordinates at the end from those in one process", Role::error,
     field<&EqualityRow::from_one>},
    {"from_here", "from this program", "m", "the same from the ordinary program, which factors its matrices", Role::error,
     field<&EqualityRow::from_here>},
    {"from_reference", "from CVODE", "m", "the same from serial CVODE with a relative tolerance of 1e-10", Role::error,
     field<&EqualityRow::from_reference>},
    {"verdict", "verdict", "", "whether it is the same motion", Role::verdict,
     [](const EqualityRow& row) -> Datum { return same_motion(row); }},
};

results::Table equality_table(const std::vector<EqualityRow>& rows) {
  return results::make_table("strips", "A sheet in strips, a process each: the same motion as in one", equality_columns, rows);
}

// --- How its time grows --------------------------------------------------------------------------------------------------

/// A method with its step, and the damping with which it makes sense.
struct Timed {
  std::string_view method;
  double damping, step;
};
constexpr Timed all_timed[] = {
    {"verlet", 0, 4e-5}, {"rkl2", 0.5, 4e-5}, {"sbdf2", 0.5, 0.01}, {"bdf2", 0.5, 1e-3}, {"cvode-bdf", 0.5, 1e-4}};

/// "strong": the same sheet in more processes; "weak": as many more lines.
struct ScalingRow {
  std::string kind, method;
  int nu, nv, processes;
  Solved solved;
  std::optional<double> speedup = {}, efficiency = {};

  double particles() const { return static_cast<double>(nu) * nv; }
  double steps() const { return static_cast<double>(solved.seconds.size()); }
  auto later() const { return std::span(solved.seconds).subspan(1); }
  /// Mean of the later steps [s]: CVODE takes steps of its own, so that many of ours take it no time.
  double seconds() const { return std::accumulate(later().begin(), later().end(), 0.0) / static_cast<double>(later().size()); }
};

template <std::int64_t Traffic::*kind>
Datum traffic_cell(const ScalingRow& row) {
  std::int64_t most = 0;
  for (const Rank& rank : row.solved.ranks) most = std::max(most, rank.later.*kind);
  return static_cast<double>(most) / (row.steps() - 1);
}

Datum work_cell(const ScalingRow& row, const std::string& name) {
  const auto found = row.solved.work.find(name);
  return found == row.solved.work.end() ? Datum() : Datum(static_cast<double>(found->second) / row.steps());
}

constexpr ColumnOf<ScalingRow> scaling_columns[] = {
    {"kind", "kind", "", "strong: the same sheet; weak: as many lines for each process", Role::key, field<&ScalingRow::kind>},
    {"method", "method", "", "", Role::key, field<&ScalingRow::method>},
    {"nu", "columns", "1", "particles of a line", Role::key, field<&ScalingRow::nu>},
    {"nv", "lines", "1", "", Role::key, field<&ScalingRow::nv>},
    {"processes", "processes", "1", "", Role::key, field<&ScalingRow::processes>},
    {"forces", "forces", "1", "evaluations of the whole force a step, those that estimate limits included", Role::counter,
     [](const ScalingRow& row) { return work_cell(row, "forces"); }},
    {"iterations", "PFMG", "1", "iterations of hypre's conjugate gradients a step, of one coordinate", Role::counter,
     [](const ScalingRow& row) { return work_cell(row, "pfmg_iterations"); }},
    {"time", "step", "ms", "mean wall time of a step after the first, of the slowest process", Role::time,
     [](const ScalingRow& row) -> Datum { return 1e3 * row.seconds(); }},
    {"lower", "from", "ms", "of the shortest of these steps", Role::time,
     [](const ScalingRow& row) -> Datum { return 1e3 * std::ranges::min(row.later()); }},
    {"upper", "to", "ms", "of the longest", Role::time,
     [](const ScalingRow& row) -> Datum { return 1e3 * std::ranges::max(row.later()); }},
    {"speedup", "speed-up", "1", "particles a second over those of one process", Role::time, field<&ScalingRow::speedup>},
    {"efficiency", "efficiency", "1", "the same over the number of processes", Role::time, field<&ScalingRow::efficiency>},
    {"messages", "messages", "1", "sent a step after the first, by the process that sends most", Role::counter,
     traffic_cell<&Traffic::messages>},
    {"bytes", "sent", "B", "in these", Role::counter, traffic_cell<&Traffic::bytes>},
    {"reductions", "reductions", "1", "in which all processes take part, a step after the first", Role::counter,
     traffic_cell<&Traffic::reductions>},
    {"memory", "memory", "MB", "the most that a process took", Role::time,
     [](const ScalingRow& row) -> Datum { return std::ranges::max(row.solved.ranks, {}, &Rank::memory).memory; }},
};

std::vector<int> process_counts(bool quick) {
  std::vector<int> counts;
  const int most = quick ? 2 : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  for (int count = 1; count < most; count *= 2) counts.push_back(count);
  counts.push_back(most);
  return counts;
}

/// Sheets by their particles a side: a small one shows what messages cost, the large one what particles cost.
std::vector<int> sides(bool quick) { return quick ? std::vector{16} : std::vector{50, 1000}; }

ScalingRow run_one(const std::string& kind, const Timed& timed, int nu, int nv, int processes, Checkpoint& checkpoint) {
  constexpr int steps = 6;
  const Problem problem{.scene = model::to_toml(sheet(nu, nv, timed.damping)),
                        .method = std::string(timed.method),
                        .step = timed.step,
                        .steps = steps,
                        .tolerance = 1e-4};
  const std::string id = fmt::format("{} {} {} x {} in {}", kind, timed.method, nu, nv, processes);
  checkpoint.show(id);
  const Solved solved = checkpoint.timed(id, [&] { return run_strips(problem, processes, limit).solved; });
  checkpoint.advance();
  return {kind, problem.method, nu, nv, processes, solved};
}

std::vector<ScalingRow> scaling(bool quick, Checkpoint& checkpoint) {
  std::vector<ScalingRow> rows;
  for (const std::string kind : {"strong", "weak"})
    for (const int n : sides(quick))
      for (const Timed& timed : all_timed) {
        const std::size_t first = rows.size();
        for (const int processes : process_counts(quick)) {
          const int nv = kind == "strong" ? n : n / 2 * processes;
          rows.push_back(run_one(kind, timed, n, nv, processes, checkpoint));
          const ScalingRow& one = rows[first];
          ScalingRow& now = rows.back();
          now.speedup = now.particles() / one.particles() * one.seconds() / now.seconds();
          now.efficiency = *now.speedup / processes;
        }
      }
  return rows;
}

results::Table scaling_table(const std::vector<ScalingRow>& rows) {
  return results::make_table(
      "strips-scaling",
      fmt::format("Time and traffic of a step of a sheet in strips, on {} cores", std::thread::hardware_concurrency()),
      scaling_columns, rows);
}

/// In the place of tables where the program is not there.
struct Absent {
  std::string what;
};
constexpr ColumnOf<Absent> absent_columns[] = {
    {"missing", "missing", "", "what is to be installed", Role::note, field<&Absent::what>},
};

Job absent_job(const std::string& what) {
  return job(
      "strips-missing", 0, [what](Checkpoint&) { return std::vector<Absent>{{what}}; },
      [](const std::vector<Absent>& rows) {
        return results::make_table("strips-missing", "The program that is not there", absent_columns, rows);
      });
}

}  // namespace
}  // namespace drape::bench::strips

namespace drape::bench {

std::vector<Job> strips_study(const Question& question) {
  if (const std::string what = strips::missing(); !what.empty()) return {strips::absent_job(what)};
  const bool quick = question.quick;
  const auto runs =
      static_cast<int>(2 * strips::sides(quick).size() * std::size(strips::all_timed) * strips::process_counts(quick).size());
  return {job(
              "strips", static_cast<int>(strips::methods().size()),
              [quick](Checkpoint& checkpoint) { return strips::equality(quick, checkpoint); }, strips::equality_table),
          job(
              "strips-scaling", runs, [quick](Checkpoint& checkpoint) { return strips::scaling(quick, checkpoint); },
              strips::scaling_table)};
}

}  // namespace drape::bench
