#include "results/analysis/conclusion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "results/analysis/scene_runs.hpp"
#include "results/table_builder.hpp"

namespace drape::results {
namespace {

using Runs = RunsOfScene::mapped_type;

bool has_error(const RunRecord& run) { return ended_well(run) && run.error && comparable(*run.error); }

/// The quickest of a scene's runs at a coarse and a fine error.
std::string quickest_in_words(const Runs& runs) {
  std::vector<Measured> candidates;
  for (const RunRecord* run : runs) candidates.push_back(measured(*run));
  std::string text;
  for (const double error : {1e-2, 1e-4})
    if (const auto best = quickest(candidates, error)) {
      const RunRecord& run = *runs[*best];
      text += fmt::format("{}error <= {:g} in {:.3g} ms by {}, h = {:g} s", text.empty() ? "" : "; ", error,
                          quartiles(run.times_ms).median, run.method, run.step);
    }
  return text;
}

/// The least accurate of the runs that did not fail: what looks right to a program and is not.
std::string worst_in_words(const Runs& runs) {
  constexpr double visible = 0.05;
  const RunRecord* worst = nullptr;
  for (const RunRecord* run : runs)
    if (has_error(*run) && (worst == nullptr || run->error->rms > worst->error->rms)) worst = run;
  if (worst == nullptr || worst->error->rms < visible) return "";
  return fmt::format("stable and wrong: {}, h = {:g} s, ends {:.2g} % of the size away", worst->method, worst->step,
                     100 * worst->error->rms);
}

std::string failures_in_words(const Runs& runs) {
  std::set<std::string> outcomes;
  for (const RunRecord* run : runs)
    if (!ended_well(*run)) outcomes.insert(fmt::format("{} {}", run->method, to_string(run->outcome)));
  return outcomes.empty() ? "" : fmt::format("fails: {}", fmt::join(outcomes, ", "));
}

void add(TableBuilder& words, const std::string& subject, const std::string& sentence) {
  if (sentence.empty()) return;
  words.row();
  words.text("subject", "about", "scene and what is set in it, or table", subject);
  words.text("conclusion", "conclusion", "what its runs or rows come to", sentence);
}

void add_orders(TableBuilder& words, const Table& table) {
  const OrderCount count = count_orders(table);
  if (count.curves == 0) return;
  add(words, table.name, fmt::format("{} of {} methods converge with the order they declare", count.as_declared, count.curves));
}

}  // namespace

Table conclusion(std::span<const Recording> recordings) {
  TableBuilder words("conclusion", "What it comes to");
  for (const auto& [scene, runs] : by_scene(recordings))
    for (const std::string& sentence : {quickest_in_words(runs), worst_in_words(runs), failures_in_words(runs)})
      add(words, scene, sentence);
  for (const Recording& recording : recordings)
    for (const Table& table : recording.tables)
      if (find_column(table, "fitted_order") != nullptr) add_orders(words, table);
  return words.finish();
}

}  // namespace drape::results
