#include "results/analysis/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "results/table_builder.hpp"

namespace drape::results {

std::string shown(double value) { return fmt::format("{:.6g}", value); }

Judgement judge_error(double a, double b, double factor, double noise) {
  const auto grown = [&](double from, double to) { return !(to <= factor * from + noise) && !std::isnan(from); };
  return grown(a, b) ? Judgement::regression : grown(b, a) ? Judgement::better : Judgement::same;
}

Judged summary(const Findings& findings, const std::string& name) {
  constexpr std::size_t most = 10;
  std::vector<Finding> sorted = findings.all;
  std::ranges::stable_sort(sorted, std::ranges::greater(), &Finding::change);
  const auto count = [&](Judgement judgement) { return std::ranges::count(sorted, judgement, &Finding::judgement); };
  const auto regressions = count(Judgement::regression), unknown = count(Judgement::not_comparable),
             improvements = count(Judgement::better);
  Judged judged;
  judged.judgement = regressions > 0    ? Judgement::regression
                     : unknown > 0      ? Judgement::not_comparable
                     : improvements > 0 ? Judgement::better
                                        : Judgement::same;
  judged.reason =
      fmt::format("{} cells: {} worse, {} better, {} not comparable", findings.cells, regressions, improvements, unknown);
  TableBuilder table(name, fmt::format("the worst of {} differences in {}", sorted.size(), name));
  for (std::size_t k = 0; k < std::min(most, sorted.size()); ++k) {
    table.row();
    table.text("cell", "cell", "a run or a row of a table", sorted[k].cell);
    table.text("quantity", "quantity", "what differs", sorted[k].quantity);
    table.text("a", "a", "in the first file", sorted[k].a);
    table.text("b", "b", "in the second file", sorted[k].b);
    table.text("judgement", "judgement", "what that means", to_string(sorted[k].judgement));
  }
  judged.worst = table.finish();
  return judged;
}

}  // namespace drape::results
