#include "results/analysis/conclusion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string_view>

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
      text += fmt::format("{} {:g} %{} {}, h = {:g} s, in {:.3g} ms",
                          text.empty() ? "The quickest with an error of at most" : "; of at most", 100 * error,
                          text.empty() ? " of the size is" : ",", run.method, run.step, quartiles(run.times_ms).median);
    }
  return text.empty() ? "" : text + ".";
}

/// The first few of some phrases, and how many are left out.
std::string first_few(std::vector<std::string> phrases) {
  constexpr std::size_t most = 3;
  if (phrases.size() > most) {
    const std::size_t more = phrases.size() - most;
    phrases.resize(most);
    phrases.push_back(fmt::format("and {} more", more));
  }
  return fmt::format("{}", fmt::join(phrases, "; "));
}

/// The least accurate run of each method that did not fail, the worst first: what looks right to a program and is not.
std::string wrong_in_words(const Runs& runs) {
  constexpr double visible = 0.05;
  std::map<std::string, const RunRecord*> worst_of;
  for (const RunRecord* run : runs) {
    if (!has_error(*run) || run->error->rms < visible) continue;
    const RunRecord*& worst = worst_of[run->method];
    if (worst == nullptr || run->error->rms > worst->error->rms) worst = run;
  }
  std::vector<const RunRecord*> wrong;
  for (const auto& [method, run] : worst_of) wrong.push_back(run);
  std::ranges::stable_sort(wrong, std::greater(), [](const RunRecord* run) { return run->error->rms; });
  std::vector<std::string> phrases;
  for (const RunRecord* run : wrong)
    phrases.push_back(fmt::format("{}, h = {:g} s, {}{:.2g} %{}", run->method, run->step, phrases.empty() ? "ends " : "",
                                  100 * run->error->rms, phrases.empty() ? " of the size away" : ""));
  return phrases.empty() ? "" : fmt::format("Stable and wrong: {}.", first_few(phrases));
}

/// The methods that failed, outcome by outcome.
std::string failures_in_words(const Runs& runs) {
  std::map<std::string_view, std::set<std::string>> methods;
  for (const RunRecord* run : runs)
    if (!run->succeeded()) methods[to_string(run->outcome)].insert(run->method);
  std::vector<std::string> sentences;
  for (const auto& [outcome, failed] : methods)
    sentences.push_back(fmt::format("Ended {}: {}.", outcome, fmt::join(failed, ", ")));
  return fmt::format("{}", fmt::join(sentences, " "));
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
  return count.curves == 0 ? ""
                           : fmt::format("{} of {} methods converge with the order they declare{}{}.", count.as_declared,
                                         count.curves, count.others.empty() ? "" : "; ", first_few(count.others));
}

/// What a headline table says of its rows itself.
void add_captions(const Table& table, std::vector<Sentence>& sentences) {
  if (!table.headline) return;
  const auto caption = std::ranges::find(table.columns, Part::caption, &Column::part);
  for (std::size_t row = 0; caption != table.columns.end() && row < rows(table); ++row)
    sentences.push_back({text_in(find_column(table, Role::key), row), text_in(&*caption, row)});
}

}  // namespace

Table conclusion(std::span<const Recording> recordings) {
  std::vector<Sentence> sentences;
  for (const auto& [scene, runs] : by_scene(recordings))
    for (const std::string& sentence : {quickest_in_words(runs), wrong_in_words(runs), failures_in_words(runs)})
      sentences.push_back({scene, sentence});
  for (const Recording& recording : recordings)
    for (const Table& table : recording.tables) {
      sentences.push_back({table.name, orders_in_words(table)});
      add_captions(table, sentences);
    }
  std::erase_if(sentences, [](const Sentence& sentence) { return sentence.text.empty(); });
  return make_table("conclusion", "What it comes to", sentence_columns, sentences);
}

}  // namespace drape::results
