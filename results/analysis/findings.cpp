#include "results/analysis/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "results/columns.hpp"

namespace drape::results {
namespace {

constexpr ColumnOf<Finding> finding_columns[] = {
    {"cell", "cell", "", "a run or a row of a table", Role::key, field<&Finding::cell>},
    {"quantity", "quantity", "", "what differs", Role::key, field<&Finding::quantity>},
    {"a", "a", "", "in the first file", Role::note, field<&Finding::a>},
    {"b", "b", "", "in the second file", Role::note, field<&Finding::b>},
    {"judgement", "judgement", "", "what that means", Role::note,
     [](const Finding& finding) { return to_cell(to_string(finding.judgement)); }},
};

}  // namespace

std::string shown(double value) { return fmt::format("{:.6g}", value); }

Judgement judge_error(double a, double b, double factor, double noise) {
  const auto grown = [&](double from, double to) { return !(to <= factor * from + noise) && !std::isnan(from); };
  return grown(a, b) ? Judgement::regression : grown(b, a) ? Judgement::better : Judgement::same;
}

Judged summary(const Findings& findings, const std::string& name) {
  constexpr std::ptrdiff_t most = 10;
  std::vector<Finding> sorted = findings.all;
  std::ranges::stable_sort(sorted, std::ranges::greater(), &Finding::change);
  const auto count = [&](Judgement judgement) { return std::ranges::count(sorted, judgement, &Finding::judgement); };
  const auto regressions = count(Judgement::regression), unknown = count(Judgement::not_comparable),
             changes = count(Judgement::changed), improvements = count(Judgement::better);
  Judged judged;
  judged.judgement = regressions > 0    ? Judgement::regression
                     : unknown > 0      ? Judgement::not_comparable
                     : changes > 0      ? Judgement::changed
                     : improvements > 0 ? Judgement::better
                                        : Judgement::same;
  judged.reason = fmt::format("{} cells: {} worse, {} better, {} changed, {} not comparable", findings.cells, regressions,
                              improvements, changes, unknown);
  std::string description = fmt::format("the worst of {} differences in {}", sorted.size(), name);
  judged.worst = make_table(name, std::move(description), finding_columns,
                            std::span(sorted).first(std::min<std::size_t>(most, sorted.size())));
  return judged;
}

}  // namespace drape::results
