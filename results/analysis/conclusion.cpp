#include "results/analysis/conclusion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "results/analysis/scene_runs.hpp"
#include "results/columns.hpp"

namespace drape::results {
namespace {

using Runs = RunsOfScene::mapped_type;

bool has_error(const RunRecord& run) { return run.succeeded() && run.error && comparable(*run.error); }

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
    if (!run->succeeded()) outcomes.insert(fmt::format("{} {}", run->method, to_string(run->outcome)));
  return outcomes.empty() ? "" : fmt::format("fails: {}", fmt::join(outcomes, ", "));
}

struct Sentence {
  std::string subject, text;
};

constexpr ColumnOf<Sentence> sentence_columns[] = {
    {"subject", "about", "", "scene and what is set in it, or table", Role::key, field<&Sentence::subject>},
    {"conclusion", "conclusion", "", "what its runs or rows come to", Role::note, field<&Sentence::text>},
};

std::string orders_in_words(const Table& table) {
  if (find_column(table, Role::order) == nullptr) return "";
  const OrderCount count = count_orders(table);
  return count.curves == 0
             ? ""
             : fmt::format("{} of {} methods converge with the order they declare", count.as_declared, count.curves);
}

}  // namespace

Table conclusion(std::span<const Recording> recordings) {
  std::vector<Sentence> sentences;
  for (const auto& [scene, runs] : by_scene(recordings))
    for (const std::string& sentence : {quickest_in_words(runs), worst_in_words(runs), failures_in_words(runs)})
      sentences.push_back({scene, sentence});
  for (const Recording& recording : recordings)
    for (const Table& table : recording.tables) sentences.push_back({table.name, orders_in_words(table)});
  std::erase_if(sentences, [](const Sentence& sentence) { return sentence.text.empty(); });
  return make_table("conclusion", "What it comes to", sentence_columns, sentences);
}

}  // namespace drape::results
