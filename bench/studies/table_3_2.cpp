#include <fmt/format.h>

#include "bench/runs/record.hpp"
#include "bench/runs/timing.hpp"
#include "bench/studies/draping.hpp"
#include "bench/studies/garments.hpp"
#include "bench/studies/studies.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/statistics.hpp"

namespace drape::bench {
namespace {

using results::field;
using results::Role;

/// All methods with the same cloth and the same tolerances.
struct TableclothBlock {
  std::string name;
  bool of_thesis;  ///< k and d as printed
  double loop_tolerance = solver::Options().loop_tolerance;
  double cg_tolerance = solver::Options().cg_tolerance;

  bool loose() const { return cg_tolerance > solver::Options().cg_tolerance; }
};

/// Loose: so that BDF(2) takes 138 updates, near the thesis' 122. Its 857 CG iterations, against 362, tell of tighter solves.
std::vector<TableclothBlock> tablecloth_blocks() {
  return {{"thesis' d", true}, {"thesis' d, loose", true, 1e-1, 1e-2}, {"drapes", false}, {"drapes, loose", false, 1e-1, 1e-2}};
}

Group cells(const TableclothBlock& block, bool quick) {
  std::vector<model::Override> overrides;
  if (block.of_thesis) overrides = {{"material.tension", "1e4"}, {"material.damping", "50"}};
  if (quick) overrides.insert(overrides.end(), {{"grid.n", "8"}, {"end.time", "0.1"}});
  const model::Scene scene = model::load_scene("tablecloth", overrides);
  Group group;
  for (const solver::Method& method : solver::thesis_methods()) {
    if (block.loose() && !method.implicit()) continue;  // it has no tolerances
    RunSpec cell{scene, "", &method, 0.01, solver::thesis_options()};
    cell.options.loop_tolerance = block.loop_tolerance;
    cell.options.cg_tolerance = block.cg_tolerance;
    group.push_back(cell);
  }
  return group;
}

int repetitions(bool quick) { return quick ? 1 : 3; }

/// A method on a cloth.
struct MethodRun {
  std::string cloth, method;
  double damping, loop_tolerance, cg_tolerance;
  Draping run;
  std::optional<double> solver_ms, thesis_seconds;
};

constexpr results::ColumnOf<MethodRun> method_columns[] = {
    {"cloth", "cloth", "", "k and d as in the thesis, or those of the scene", Role::key, field<&MethodRun::cloth>},
    {"damping", "d", "N s/m", "linear damping", Role::key, field<&MethodRun::damping>},
    {"loop_tolerance", "loop tol.", "1", "of the fixed-point loop, over |b|", Role::key, field<&MethodRun::loop_tolerance>},
    {"cg_tolerance", "CG tol.", "1", "of a linear solve, over |b|; in the loop at most half of its", Role::key,
     field<&MethodRun::cg_tolerance>},
    {"method", "method", "", "time integrator", Role::key, field<&MethodRun::method>},
};
constexpr results::ColumnOf<MethodRun> time_columns[] = {
    {"solver_ms", "solver", "ms", "wall time of the solver, median of interleaved runs", Role::time,
     field<&MethodRun::solver_ms>},
    {"thesis_seconds", "thesis: solver", "s", "printed in the thesis: Pentium III, 660 MHz", Role::note,
     field<&MethodRun::thesis_seconds>},
};

MethodRun row_of(const TableclothBlock& block, const RunSpec& cell, const results::RunRecord& run) {
  MethodRun row{block.name,
                std::string(cell.method->name),
                cell.scene.sheet.material.damping.weft,
                cell.options.loop_tolerance,
                cell.options.cg_tolerance,
                {},
                {},
                {}};
  const auto published = published_table_3_2.find(cell.method->name);
  const bool known = block.of_thesis && published != published_table_3_2.end();
  row.run = draping(cell.scene, run, known ? std::optional(published->second.work) : std::nullopt);
  if (known) row.thesis_seconds = published->second.seconds;
  if (!run.times_ms.empty()) row.solver_ms = base::quantile(run.times_ms, 0.5);
  return row;
}

/// Each run is a checkpoint, and so are their repetitions together, which must be interleaved.
std::vector<results::RunRecord> timed_runs(const std::string& block, const Group& group, int count, Checkpoint& checkpoint) {
  std::vector<results::RunRecord> runs;
  std::vector<std::size_t> steps;
  checkpoint.each(group, [&](const RunSpec& spec) {
    runs.push_back(checkpoint.once(fmt::format("{} {}", block, spec.method->name), [&] { return record(spec); }));
    steps.push_back(steps_to_time(runs.back()));
  });
  const auto times = checkpoint.timed("times " + block, [&] { return time_group(group, steps, count, [] {}); });
  for (std::size_t k = 0; k < runs.size(); ++k) runs[k].times_ms = times[k];
  return runs;
}

std::vector<MethodRun> run_tablecloths(bool quick, Checkpoint& checkpoint) {
  std::vector<MethodRun> rows;
  checkpoint.each(tablecloth_blocks(), [&](const TableclothBlock& block) {
    checkpoint.show("tablecloth, " + block.name);
    const Group group = cells(block, quick);
    const auto runs = timed_runs(block.name, group, repetitions(quick), checkpoint);
    for (std::size_t k = 0; k < group.size(); ++k) {
      rows.push_back(row_of(block, group[k], runs[k]));
      checkpoint.advance();
    }
  });
  return rows;
}

results::Table tablecloth_table(const std::vector<MethodRun>& rows) {
  results::Table table =
      results::make_table("table-3.2", "Table 3.2: the methods on the tablecloth; the thesis' figures are from a Pentium III",
                          method_columns, rows);
  results::add_columns(table, draping_columns, rows, [](const MethodRun& row) { return &row.run; });
  results::add_columns(table, time_columns, rows);
  return table;
}

}  // namespace

std::vector<Job> table_3_2(const Question& question) {
  const bool quick = question.quick;
  int parts = 0;
  for (const TableclothBlock& block : tablecloth_blocks()) parts += static_cast<int>(cells(block, quick).size());
  const auto compute = [quick](Checkpoint& checkpoint) { return run_tablecloths(quick, checkpoint); };
  return {job("table-3.2", parts, compute, tablecloth_table), dress_block(quick)};
}

}  // namespace drape::bench
