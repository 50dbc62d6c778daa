#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <span>
#include <tuple>

#include "bench/runs/record.hpp"
#include "bench/runs/timing.hpp"
#include "bench/studies/draping.hpp"
#include "bench/studies/studies.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/analysis/runs_table.hpp"
#include "solver/base/statistics.hpp"

namespace drape::bench {
namespace {

constexpr double box_step = 0.01;    ///< [s]
constexpr std::size_t window = 5;    ///< steps of which people see the mean
constexpr std::size_t at_rest = 20;  ///< the last steps
constexpr double most_iterations = 1.5, most_time = 1.3;

model::Scene swing(bool quick) {
  std::vector<model::Override> overrides;
  if (quick) overrides = {{"grid.n", "8"}};
  return model::load_scene("box_swing", overrides);
}

RunSpec cell(const model::Scene& scene, std::string_view method) {
  return {scene, "", &solver::method(method), box_step, solver::thesis_options()};
}

/// The method alone: all runs have the thesis' solvers.
std::string method_of(const results::RunRecord& run) { return run.method.substr(0, run.method.find('/')); }

using results::RunRecord;
using results::StepRecord;
using Steps = std::span<const StepRecord>;

/// The steps before the first contact.
Steps before_contact(const RunRecord& run) {
  return {run.steps.begin(), std::ranges::find_if(run.steps, [](const StepRecord& s) { return s.contacts > 0; })};
}

/// NaN if there are none.
double mean(Steps steps, int StepRecord::*value) {
  double sum = 0;
  for (const StepRecord& s : steps) sum += s.*value;
  return sum / static_cast<double>(steps.size());
}

double iterations(Steps steps) { return mean(steps, &StepRecord::cg_iterations); }

/// Means of `length` steps a row. Single ones are for the file: without titles people do not see them.
results::Table over_time(const char* name, const char* title, const std::vector<RunRecord>& runs, std::size_t length) {
  constexpr std::tuple<const char*, const char*, int StepRecord::*> curves[] = {
      {"updates", "of the fixed-point loop a step", &StepRecord::updates},
      {"CG", "iterations a step", &StepRecord::cg_iterations},
      {"contacts", "constrained particles", &StepRecord::contacts}};
  const bool seen = length > 1;
  std::size_t steps = 0;
  for (const RunRecord& run : runs) steps = std::max(steps, run.steps.size());
  results::TableBuilder table(name, title);
  for (std::size_t first = 0; first + length <= steps; first += length) {
    table.row();
    table.number("t", seen ? "until" : "", "s", "end of the last of these steps",
                 box_step * static_cast<double>(first + length));
    for (const RunRecord& run : runs) {
      if (first + length > run.steps.size()) continue;
      for (const auto& [curve, description, value] : curves)
        table.number(fmt::format("{}_{}", method_of(run), curve).c_str(),
                     seen ? fmt::format("{}: {}", method_of(run), curve).c_str() : "", "1", description,
                     mean(Steps(run.steps).subspan(first, length), value));
    }
  }
  return table.finish();
}

/// A measured ratio beside what it may be at most.
void add_bar(results::TableBuilder& table, const RunRecord& run, const char* what, double value, double bar) {
  table.row();
  table.text("method", "method", "time integrator", method_of(run));
  table.text("ratio", "ratio", "of what", what);
  table.number("value", "value", "1", "measured", value);
  table.number("bar", "bar", "1", "what it may be at most", bar);
  if (!run.steps.empty())
    table.number("motion", "motion", "1", "kinetic energy at the end over the largest one: whether it rests",
                 run.steps.back().kinetic_energy / std::ranges::max(run.steps, {}, &StepRecord::kinetic_energy).kinetic_energy);
  const bool touched = before_contact(run).size() < run.steps.size();
  std::string verdict = value <= bar ? "below" : "NOT below";
  if (!touched) verdict = "no contact";
  if (run.outcome != solver::Outcome::success) verdict = to_string(run.outcome);
  table.text("verdict", "verdict", "whether it keeps below the bar", verdict);
}

/// All bars of a method, from its cells with and without box.
void add_bars(results::TableBuilder& table, const Group& group, int repetitions) {
  const RunRecord with = record(group[0]), without = record(group[1]);
  const auto times = time_group(group, {steps_to_time(with), steps_to_time(without)}, repetitions, [] {});
  const double time = base::quantile(times[0], 0.5) / base::quantile(times[1], 0.5);
  const Steps all = with.steps, rest = all.last(std::min(all.size(), at_rest));
  add_bar(table, with, "CG iterations a step, at rest over before the first contact",
          iterations(rest) / iterations(before_contact(with)), most_iterations);
  add_bar(table, with, "time, with over without box", time, most_time);
  add_bar(table, with, "time a CG iteration, with over without box", time * iterations(without.steps) / iterations(all),
          most_time);
}

results::Table bars(bool quick, Checkpoint& checkpoint) {
  results::TableBuilder table("figure-4.3-bars", "Figure 4.3: what contact costs; the sheet swings with and without the box");
  const model::Scene scene = swing(quick);
  model::Scene without_box = scene;
  without_box.obstacles.clear();
  for (const solver::Method& method : solver::thesis_methods()) {
    if (!method.implicit()) continue;
    checkpoint.show(fmt::format("cost of contact, {}", method.name));
    const Group group{cell(scene, method.name), cell(without_box, method.name)};
    checkpoint.rows(table, std::string(method.name),
                    [&](results::TableBuilder& rows) { add_bars(rows, group, quick ? 1 : 5); });
    checkpoint.advance();
  }
  return table.finish();
}

}  // namespace

std::vector<TableJob> figure_4_3(bool quick) {
  const auto runs = std::make_shared<std::vector<RunRecord>>();  // of the first table, for the last
  const auto implicit = std::ranges::count_if(solver::thesis_methods(), [](const solver::Method& m) { return m.implicit(); });
  return {{2,
           [=](Checkpoint& checkpoint) {
             for (const char* method : {"bdf2", "sbdf2"}) {
               checkpoint.show(fmt::format("{} against the box", method));
               runs->push_back(checkpoint.once(method, [&] { return record(cell(swing(quick), method)); }));
               checkpoint.advance();
             }
             return over_time("figure-4.3", "Figure 4.3: a sheet swings against a box; means over five steps", *runs, window);
           }},
          {static_cast<int>(implicit), [=](Checkpoint& checkpoint) { return bars(quick, checkpoint); }},
          {0, [=](Checkpoint&) { return over_time("figure-4.3-steps", "Figure 4.3: every step (in the file)", *runs, 1); }}};
}

}  // namespace drape::bench
