#include "bench/studies/field/winners.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "solver/base/statistics.hpp"

namespace drape::bench {
namespace {

using results::Standing;

/// Classes of h k/d at a step of 0.01 s: 2, 20 and 200 on the hung sheets with d = 50, 5 and 0.5 N s/m.
struct DampingClass {
  std::string_view name;
  double below;  ///< of h k/d
};
constexpr DampingClass damping_classes[] = {{"h k/d < 6", 6}, {"6 to 60", 60}, {"60 on", INFINITY}, {"no damping", NAN}};

std::string_view damping_class(double to_damping) {
  for (const DampingClass& one : damping_classes)
    if (to_damping < one.below) return one.name;
  return std::end(damping_classes)[-1].name;
}

/// Whether a method may be advised: an error that does not vanish with the step is small by chance.
bool may_be_chosen(const FieldRun& run) { return solver::method(run.method).converges; }

bool may_win(const FieldRun& run, Settings settings) {
  return may_be_chosen(run) && (settings == Settings::tuned || run.recommended);
}

/// log10 of h k/d; without damping as if that were 10⁶.
double decade_of(const SheetResult& sheet) {
  constexpr double undamped = 1e6;
  return std::log10(std::min(sheet.to_damping, undamped));
}

/// How far apart two sheets are: h k/d by decades, and another number of particles is farther than any of these.
double distance_of_sheets(const SheetResult& a, const SheetResult& b) {
  constexpr double another_size = 10;
  return std::abs(decade_of(a) - decade_of(b)) + (a.sheet.n == b.sheet.n ? 0 : another_size);
}

constexpr std::string_view training_scene = "hung-edge";

const SheetResult* training_of(const SheetResult& sheet, const std::vector<SheetResult>& all) {
  const SheetResult* nearest = nullptr;
  for (const SheetResult& one : all)
    if (one.sheet.scene == training_scene &&
        (nearest == nullptr || distance_of_sheets(one, sheet) < distance_of_sheets(*nearest, sheet)))
      nearest = &one;
  return nearest;
}

const FieldRun* run_with(const SheetResult& sheet, const FieldRun& setting) {
  for (const FieldRun& run : sheet.runs)
    if (run.method == setting.method && run.value == setting.value) return &run;
  return nullptr;
}

void transfer(const SheetResult& sheet, const SheetResult& training, std::vector<Transfer>& all) {
  for (const double error : field_levels(sheet)) {
    const auto was_run = [&](const FieldRun& run) { return may_be_chosen(run) && run_with(sheet, run) != nullptr; };
    const FieldRun* chosen = quickest_run(training, error, was_run);
    if (chosen == nullptr) continue;
    all.push_back(
        {&training, &sheet, error, run_with(sheet, *chosen), chosen->setting(), quickest_run(sheet, error, may_be_chosen)});
  }
}

/// The key that most of the winners have, and how many.
template <class KeyOf>
std::pair<std::string, std::size_t> most_frequent(const std::vector<const FieldWinner*>& winners, const KeyOf& key_of) {
  std::map<std::string, std::size_t> counts;
  for (const FieldWinner* winner : winners) ++counts[std::string(key_of(*winner))];
  const auto most = std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; });
  return *most;
}

/// `winners`: of sheets with like damping at one error, each with a best one.
void answer(const std::vector<const FieldWinner*>& winners, FieldAnswer& row) {
  row.sheets = winners.size();
  if (winners.empty()) return;
  const auto [name, won] = most_frequent(winners, [](const FieldWinner& one) { return one.family(); });
  std::vector<const FieldWinner*> of_family;
  std::vector<double> margins;
  for (const FieldWinner* winner : winners) {
    if (winner->family() != name) continue;
    of_family.push_back(winner);
    if (const auto margin = winner->margin()) margins.push_back(*margin);
  }
  row.family = of_family.front()->family();
  row.won = won;
  row.method = most_frequent(of_family, [](const FieldWinner& one) { return one.best->method; }).first;
  if (!margins.empty()) row.margin = base::geometric_mean(margins);
}

}  // namespace

double median_time(const FieldRun& run) { return results::quartiles(run.times).median; }

const FieldRun* quickest_run(const SheetResult& sheet, double error, const std::function<bool(const FieldRun&)>& allowed) {
  const FieldRun* best = nullptr;
  for (const FieldRun& run : sheet.runs)
    if (run.counts() && run.timed() && run.error <= error && allowed(run) &&
        (best == nullptr || median_time(run) < median_time(*best)))
      best = &run;
  return best;
}

Lead FieldWinner::lead() const {
  if (best == nullptr) return Lead::none;
  if (next == nullptr) return Lead::alone;
  return results::tied(best->measured(), next->measured()) ? Lead::tie : Lead::clear;
}

std::optional<double> FieldWinner::margin() const {
  if (best == nullptr || next == nullptr) return std::nullopt;
  return median_time(*next) / median_time(*best);
}

std::vector<FieldWinner> field_winners(const std::vector<SheetResult>& sheets, Settings settings) {
  std::vector<FieldWinner> all;
  for (const SheetResult& sheet : sheets)
    for (const double error : field_levels(sheet)) {
      FieldWinner& row = all.emplace_back(FieldWinner{&sheet, settings, error, nullptr, nullptr});
      row.best = quickest_run(sheet, error, [&](const FieldRun& run) { return may_win(run, settings); });
      if (row.best == nullptr) continue;
      row.next = quickest_run(
          sheet, error, [&](const FieldRun& run) { return may_win(run, settings) && run.family() != row.best->family(); });
    }
  return all;
}

std::vector<std::string> family_names() {
  std::vector<std::string> names;
  for (const solver::Method& method : solver::methods())
    if (std::ranges::find(names, method.family()) == names.end()) names.emplace_back(method.family());
  names.emplace_back("none");
  return names;
}

results::Verdict Transfer::verdict() const {
  if (chosen == nullptr || chosen->outcome != solver::Outcome::success)
    return {Standing::missed, chosen == nullptr ? "not run" : std::string(to_string(chosen->outcome))};
  if (!(chosen->error <= error)) return {Standing::missed, fmt::format("error {:.2g}", chosen->error)};
  return {Standing::met, "holds"};
}

std::optional<double> Transfer::ratio() const {
  if (best == nullptr || chosen == nullptr || chosen->times.empty()) return std::nullopt;
  return median_time(*chosen) / median_time(*best);
}

std::vector<Transfer> transfers(const std::vector<SheetResult>& sheets) {
  std::vector<Transfer> all;
  for (const SheetResult& sheet : sheets) {
    if (sheet.sheet.scene == training_scene) continue;
    if (const SheetResult* training = training_of(sheet, sheets)) transfer(sheet, *training, all);
  }
  return all;
}

std::vector<FieldAnswer> field_answers(const std::vector<SheetResult>& sheets) {
  std::vector<FieldAnswer> rows;
  for (const Settings settings : both_settings) {
    const std::vector<FieldWinner> all = field_winners(sheets, settings);
    for (const DampingClass& one : damping_classes)
      for (const double error : field_errors) {
        std::vector<const FieldWinner*> winners;
        for (const FieldWinner& winner : all)
          if (winner.best != nullptr && winner.error == error && damping_class(winner.sheet->to_damping) == one.name)
            winners.push_back(&winner);
        answer(winners, rows.emplace_back(FieldAnswer{settings, one.name, error}));
      }
  }
  std::erase_if(rows, [](const FieldAnswer& row) { return row.sheets == 0; });
  return rows;
}

std::vector<const FieldRun*> front_of(const SheetResult& sheet) {
  std::vector<const FieldRun*> runs, front;
  for (const FieldRun& run : sheet.runs)
    if (run.counts() && run.timed()) runs.push_back(&run);
  std::ranges::sort(runs, {}, [](const FieldRun* run) { return std::pair(median_time(*run), run->error); });
  for (const FieldRun* run : runs)
    if (front.empty() || run->error < front.back()->error) front.push_back(run);
  return front;
}

}  // namespace drape::bench
