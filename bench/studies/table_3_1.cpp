#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>

#include "bench/runs/record.hpp"
#include "bench/studies/draping.hpp"
#include "bench/studies/studies.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/verdict.hpp"

namespace drape::bench {
namespace {

using results::Datum;
using results::field;
using results::Role;

constexpr double draping_step = 0.01;  ///< [s]

/// Two values of the stiffness and two of the damping: what grows with k and falls with d is seen in these four.
struct Block {
  std::string name;
  std::array<double, 2> k, d;  ///< ascending [N/m], [N s/m]
  PublishedBlock as_published;
};

/// The exponent of the larger k is lost: 10⁵, or 10⁴, which is that of table 3.2.
std::vector<Block> blocks() {
  const double d = model::load_scene("tablecloth").sheet.material.damping.weft;  // such that it drapes
  return {{"thesis", {1e3, 1e5}, {160, 1600}, published_table_3_1},
          {"thesis, k = 1e4", {1e3, 1e4}, {160, 1600}, published_table_3_1},
          {"drapes", {1e3, 1e5}, {d, 10 * d}, {}}};
}

model::Scene scene(double k, double d, bool quick) {
  std::vector<model::Override> overrides{{"material.tension", fmt::format("{}", k)},
                                         {"material.damping", fmt::format("{}", d)}};
  if (quick) overrides.insert(overrides.end(), {{"grid.n", "8"}, {"end.time", "0.1"}});
  return model::load_scene("tablecloth", overrides);
}

results::RunRecord run_bdf2(const model::Scene& scene) {
  solver::Options options = solver::thesis_options();
  options.max_updates = 20'000;  // k = 1e5 needs some thousands a step where it drapes
  return record({scene, "", &solver::method("bdf2"), draping_step, options});
}

/// What a run cost; a run that stalls costs more than any other.
double cost(const results::RunRecord& run, const char* work) {
  if (run.outcome != solver::Outcome::success) return std::numeric_limits<double>::infinity();
  return static_cast<double>(work_count(run, work));
}

using RunsOfBlock = std::array<std::array<results::RunRecord, 2>, 2>;  ///< by k, then by d

/// The thesis: "increasing Young's modulus leads to a larger number of iterations … a larger damping coefficient smoothes the
/// trajectories and fewer iterations are necessary".
results::Verdict verdict(const RunsOfBlock& runs) {
  bool grows = true, falls = true;
  for (const char* work : {"updates", "cg_iterations"})
    for (const int i : {0, 1}) {
      grows = grows && cost(runs[1][i], work) > cost(runs[0][i], work);
      falls = falls && cost(runs[i][1], work) < cost(runs[i][0], work);
    }
  const bool as_told = grows && falls;
  return {
      as_told ? results::Standing::met : results::Standing::missed,
      fmt::format("{} with k, {} with d", grows ? "grows" : "does not always grow", falls ? "falls" : "does not always fall")};
}

/// One of the runs of a block.
struct BlockRun {
  std::string block;
  double k, d;
  Draping run;
  std::optional<results::Verdict> verdict;  ///< in the last row of a block
};

constexpr results::ColumnOf<BlockRun> block_columns[] = {
    {"rows", "rows", "", "the thesis' parameters, or such that the cloth drapes within the time", Role::key,
     field<&BlockRun::block>},
    {"tension", "k", "N/m", "tension modulus", Role::key, field<&BlockRun::k>},
    {"damping", "d", "N s/m", "linear damping", Role::key, field<&BlockRun::d>},
    {"stiffness_to_damping", "h k/d", "1", "what the fixed-point loop's contraction depends on", Role::quantity,
     [](const BlockRun& row) -> Datum { return draping_step * row.k / row.d; }},
    {"verdict", "work", "", "of the four runs: whether updates and CG iterations do as the thesis says", Role::verdict,
     field<&BlockRun::verdict>},
};

std::vector<BlockRun> rows_of(const Block& block, bool quick, Checkpoint& checkpoint) {
  RunsOfBlock runs;
  std::vector<BlockRun> rows;
  for (const int i : {0, 1})
    for (const int j : {0, 1}) {
      checkpoint.show(fmt::format("tablecloth, k = {}, d = {}", block.k[i], block.d[j]));
      const model::Scene cloth = scene(block.k[i], block.d[j], quick);
      runs[i][j] = checkpoint.once(fmt::format("{} {} {}", block.name, i, j), [&] { return run_bdf2(cloth); });
      rows.push_back({block.name, block.k[i], block.d[j], draping(cloth, runs[i][j], block.as_published[i][j]), {}});
      checkpoint.advance();
    }
  rows.back().verdict = verdict(runs);
  return rows;
}

std::vector<BlockRun> run_blocks(bool quick, Checkpoint& checkpoint) {
  std::vector<BlockRun> rows;
  checkpoint.each(blocks(),
                  [&](const Block& block) { std::ranges::move(rows_of(block, quick, checkpoint), std::back_inserter(rows)); });
  return rows;
}

results::Table block_table(const std::vector<BlockRun>& rows) {
  results::Table table = results::make_table(
      "table-3.1", "Table 3.1: the work of BDF(2) on the tablecloth against stiffness k and damping d", block_columns, rows);
  results::add_columns(table, draping_columns, rows, [](const BlockRun& row) { return &row.run; });
  return table;
}

}  // namespace

std::vector<Job> table_3_1(const Question& question) {
  const auto compute = [quick = question.quick](Checkpoint& checkpoint) { return run_blocks(quick, checkpoint); };
  return {job("table-3.1", static_cast<int>(4 * blocks().size()), compute, block_table)};
}

}  // namespace drape::bench
