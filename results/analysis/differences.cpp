#include "results/analysis/differences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "results/columns.hpp"

namespace drape::results {
namespace {

constexpr ColumnOf<Difference> difference_columns[] = {
    {"cell", "cell", "", "a run or a row of a table", Role::key, field<&Difference::cell>},
    {"quantity", "quantity", "", "what differs", Role::key, field<&Difference::quantity>},
    {"a", "a", "", "in the first file", Role::note, field<&Difference::a>},
    {"b", "b", "", "in the second file", Role::note, field<&Difference::b>},
    {"change", "change", "", "what that means", Role::note,
     [](const Difference& difference) { return to_datum(to_string(difference.change)); }},
};

}  // namespace

std::string shown(double value) { return fmt::format("{:.6g}", value); }

Change judge_error(double a, double b, double factor, double noise) {
  const auto grown = [&](double from, double to) { return !(to <= factor * from + noise) && !std::isnan(from); };
  return grown(a, b) ? Change::regression : grown(b, a) ? Change::better : Change::same;
}

Aspect summary(const Differences& differences, const std::string& name) {
  constexpr std::ptrdiff_t most = 10;
  std::vector<Difference> sorted = differences.all;
  std::ranges::stable_sort(sorted, std::ranges::greater(), &Difference::severity);
  const auto count = [&](Change change) { return std::ranges::count(sorted, change, &Difference::change); };
  const auto regressions = count(Change::regression), unknown = count(Change::not_comparable), changes = count(Change::changed),
             improvements = count(Change::better);
  Aspect aspect;
  aspect.change = regressions > 0    ? Change::regression
                  : unknown > 0      ? Change::not_comparable
                  : changes > 0      ? Change::changed
                  : improvements > 0 ? Change::better
                                     : Change::same;
  aspect.reason = fmt::format("{} cells: {} worse, {} better, {} changed, {} not comparable", differences.cells, regressions,
                              improvements, changes, unknown);
  std::string description = fmt::format("the worst of {} differences in {}", sorted.size(), name);
  aspect.worst = make_table(name, std::move(description), difference_columns,
                            std::span(sorted).first(std::min<std::size_t>(most, sorted.size())));
  return aspect;
}

}  // namespace drape::results
