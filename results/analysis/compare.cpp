#include "results/analysis/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "results/analysis/differences.hpp"
#include "solver/base/statistics.hpp"
#include "solver/outcome.hpp"

namespace drape::results {
namespace {

// --- Which cells belong together -----------------------------------------------------------------------------------------

/// All that makes a run what it is: names and values.
std::map<std::string, std::string> identity(const RunRecord& run) {
  std::map<std::string, std::string> facts{{"method", run.method},
                                           {"stage solver", run.stage_solver},
                                           {"linear solver", run.linear_solver},
                                           {"step", fmt::format("{}", run.step)},
                                           {"until", fmt::format("{}", run.until)}};
  for (const Parameter& parameter : run.parameters) facts["parameter " + parameter.name] = fmt::format("{}", parameter.value);
  for (const auto& [key, value, unit] : run.scene_keys) {
    std::string& fact = facts["scene: " + key];
    fact += (fact.empty() ? "" : ", ") + value;  // a list has a row for each of its entries
  }
  return facts;
}

std::string title(const RunRecord& run) {
  return fmt::format("{} {} h = {:g} {}", run.scene, run.method, run.step, run.overrides);
}

/// What makes two runs different cells, as many as there are.
std::vector<std::string> differences(const RunRecord& a, const RunRecord& b) {
  const auto p = identity(a), q = identity(b);
  const auto value = [](const auto& facts, const std::string& name) {
    const auto fact = facts.find(name);
    return fact == facts.end() ? std::string("nothing") : fact->second;
  };
  std::set<std::string> names;
  for (const auto& facts : {p, q})
    for (const auto& [name, fact] : facts) names.insert(name);
  std::vector<std::string> different;
  for (const std::string& name : names)
    if (value(p, name) != value(q, name))
      different.push_back(fmt::format("{} ({} and {})", name, value(p, name), value(q, name)));
  return different;
}

/// What tells a run from the one most like it.
std::string what_differs(const RunRecord& run, const std::vector<RunRecord>& others) {
  constexpr std::size_t most = 3;
  std::vector<std::string> least;
  for (const RunRecord& other : others)
    if (const auto different = differences(run, other); least.empty() || different.size() < least.size()) least = different;
  if (least.size() > most) least.resize(most), least.emplace_back("…");
  return least.empty() ? "the other file has no more of it" : fmt::format("differs in {}", fmt::join(least, ", "));
}

struct Pair {
  const RunRecord *a, *b;
};

struct Matching {
  std::vector<Pair> pairs;
  std::vector<const RunRecord*> lost;  ///< of a
};

/// The k-th of equal cells belongs to the k-th of them.
Matching match(const std::vector<RunRecord>& a, const std::vector<RunRecord>& b) {
  std::multimap<std::map<std::string, std::string>, const RunRecord*> cells;
  for (const RunRecord& run : b) cells.emplace(identity(run), &run);
  Matching matching;
  for (const RunRecord& run : a) {
    const auto found = cells.find(identity(run));
    if (found == cells.end()) {
      matching.lost.push_back(&run);
      continue;
    }
    matching.pairs.push_back({&run, found->second});
    cells.erase(found);
  }
  return matching;
}

// --- Accuracy ------------------------------------------------------------------------------------------------------------

void compare_error(const Pair& pair, const std::string& quantity, double ErrorRecord::*error, double ErrorRecord::*uncertainty,
                   const CompareOptions& options, Differences& differences) {
  const double a = (*pair.a->error).*error, b = (*pair.b->error).*error;
  const double noise = (*pair.a->error).*uncertainty + (*pair.b->error).*uncertainty;
  const Change change = judge_error(a, b, options.error_factor, noise);
  if (change == Change::same) return;
  differences.add({title(*pair.a), quantity, fmt::format("{} ± {:.1g}", shown(a), (*pair.a->error).*uncertainty),
                   fmt::format("{} ± {:.1g}", shown(b), (*pair.b->error).*uncertainty),
                   std::isnan(b) ? INFINITY : std::log(b / a), change});
}

/// How far runs came of which at least one failed.
void compare_outcomes(const Pair& pair, const CompareOptions& options, Differences& differences) {
  const double a = pair.a->succeeded() ? INFINITY : pair.a->last_good_time,
               b = pair.b->succeeded() ? INFINITY : pair.b->last_good_time;
  const Change change = b * options.error_factor < a   ? Change::regression
                        : a * options.error_factor < b ? Change::better
                                                       : Change::same;
  if (change == Change::same) return;
  const auto text = [](const RunRecord& run) {
    const std::string_view outcome = to_string(run.outcome);
    return run.succeeded() ? std::string(outcome) : fmt::format("{} at {} s", outcome, shown(run.last_good_time));
  };
  differences.add(
      {title(*pair.a), "outcome", text(*pair.a), text(*pair.b), change == Change::better ? -INFINITY : INFINITY, change});
}

void compare_accuracy(const Pair& pair, const CompareOptions& options, Differences& differences) {
  ++differences.cells;
  if (!pair.a->succeeded() || !pair.b->succeeded()) return compare_outcomes(pair, options, differences);
  if (pair.a->error.has_value() != pair.b->error.has_value()) {
    const auto text = [](const RunRecord& run) { return run.error ? "measured" : "not measured"; };
    return differences.add({title(*pair.a), "error", text(*pair.a), text(*pair.b), 0, Change::not_comparable});
  }
  if (!pair.a->error) return;
  if (comparable(*pair.a->error) && comparable(*pair.b->error))
    return compare_error(pair, "rms error", &ErrorRecord::rms, &ErrorRecord::reference_error, options, differences);
  compare_error(pair, "energy error", &ErrorRecord::energy, &ErrorRecord::energy_spread, options, differences);
  compare_error(pair, "centre error", &ErrorRecord::centre, &ErrorRecord::centre_spread, options, differences);
}

// --- Work ----------------------------------------------------------------------------------------------------------------

void compare_work(const Pair& pair, Differences& differences) {
  ++differences.cells;
  std::set<std::string> names;
  for (const WorkCount& work : pair.a->work)
    if (std::ranges::count(pair.b->work, work.name, &WorkCount::name) > 0)
      names.insert(work.name);  // else one has not counted it
  for (const std::string& name : names) {
    const std::int64_t a = work_count(*pair.a, name), b = work_count(*pair.b, name);
    if (a == b) continue;
    const double severity = std::log((static_cast<double>(b) + 0.5) / (static_cast<double>(a) + 0.5));
    differences.add(
        {title(*pair.a), name, std::to_string(a), std::to_string(b), severity, b > a ? Change::regression : Change::better});
  }
}

// --- Time ----------------------------------------------------------------------------------------------------------------

/// Why times of two files say nothing about the program; empty if they do.
std::string other_machine(const Provenance& a, const Provenance& b) {
  for (const char* name : {"cpu", "cores", "compile_flags", "sanitizers"})
    if (const std::string in_a = value_of(a, name), in_b = value_of(b, name); in_a != in_b)
      return fmt::format("{} differ: {} and {}", name, in_a, in_b);
  return {};
}

struct Timed {
  std::string cell;
  base::Samples times;
  base::RankTest test;
};

/// The cells of both files that have times.
std::vector<Timed> timed_cells(const Matching& matching) {
  std::vector<Timed> cells;
  for (const Pair& pair : matching.pairs)
    if (!pair.a->times_ms.empty() && !pair.b->times_ms.empty())
      cells.push_back(
          {title(*pair.a), {pair.a->times_ms, pair.b->times_ms}, base::rank_test(pair.a->times_ms, pair.b->times_ms)});
  return cells;
}

double shared_ratio(const std::vector<Timed>& cells) {
  std::vector<double> ratios;
  for (const Timed& cell : cells) ratios.push_back(cell.test.ratio);
  return base::quantile(std::move(ratios), 0.5);
}

void divide_out(double ratio, std::vector<Timed>& cells) {
  for (Timed& cell : cells) {
    for (double& time : cell.times.b) time /= ratio;
    cell.test = base::rank_test(cell.times.a, cell.times.b);
  }
}

std::string times_text(const std::vector<double>& times) {
  return fmt::format("{:.4g} ms ({:.4g} … {:.4g})", base::quantile(times, 0.5), base::quantile(times, 0),
                     base::quantile(times, 1));
}

/// The level of the tests of single cells: with another test of all together each has its half.
double cell_level(const CompareOptions& options) { return options.quiet ? options.level / 2 : options.level; }

/// The cells whose times differ in one direction.
void judge_cells(const std::vector<Timed>& cells, bool slower, const CompareOptions& options, Differences& differences) {
  std::vector<double> probabilities;
  for (const Timed& cell : cells) probabilities.push_back(slower ? cell.test.slower : cell.test.faster);
  const std::vector<bool> significant = base::holm(probabilities, cell_level(options));
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const auto& [name, times, test] = cells[k];
    if (!significant[k] || !((slower ? test.ratio : 1 / test.ratio) > options.time_factor)) continue;
    differences.add(
        {name, fmt::format("time, ratio {:.3g}, A12 {:.2g}, p {:.1g}", test.ratio, test.superiority, probabilities[k]),
         times_text(times.a), times_text(times.b), std::log(test.ratio), slower ? Change::regression : Change::better});
  }
}

double together(const std::vector<Timed>& cells, bool slower) {
  std::vector<base::Samples> pairs;
  for (const Timed& cell : cells) pairs.push_back(slower ? cell.times : base::Samples{cell.times.b, cell.times.a});
  return base::slower_together(pairs);
}

/// What all cells share.
void judge_shared(const std::vector<Timed>& cells, bool slower, const CompareOptions& options, Differences& differences) {
  const double ratio = shared_ratio(cells), probability = together(cells, slower);
  if (!(probability <= options.level / 2) || !((slower ? ratio : 1 / ratio) > options.time_factor)) return;
  differences.add({"all together", fmt::format("time, ratio {:.3g}, p {:.1g}", ratio, probability), "", "", std::log(ratio),
                   slower ? Change::regression : Change::better});
}

/// Whether the tests could find anything with such samples, however different they are.
bool can_tell(std::vector<Timed> cells, const CompareOptions& options) {
  double least = 1;
  for (Timed& cell : cells) {
    std::ranges::fill(cell.times.a, 1);
    std::ranges::fill(cell.times.b, 2);
    least = std::min(least, base::rank_test(cell.times.a, cell.times.b).slower);
  }
  return least <= cell_level(options) / static_cast<double>(cells.size()) ||
         (options.quiet && together(cells, true) <= options.level / 2);
}

Aspect without_differences(Change change, const std::string& reason) { return {change, reason, {"time", "", {}}}; }

Aspect compare_times(const Recording& a, const Recording& b, const Matching& matching, const CompareOptions& options) {
  constexpr std::size_t fewest = 5;
  if (!options.times) return without_differences(Change::same, "not compared, as asked");
  std::vector<Timed> cells = timed_cells(matching);
  if (cells.empty()) return without_differences(Change::same, "no cell of both files has times");
  const auto unknown = [](const std::string& reason) { return without_differences(Change::not_comparable, reason); };
  if (const std::string reason = other_machine(a.provenance, b.provenance); !reason.empty()) return unknown(reason);
  if (!options.quiet && cells.size() < fewest)
    return unknown(fmt::format("{} cells with times: fewer than {} do not tell a slower program from a slower machine",
                               cells.size(), fewest));
  if (!can_tell(cells, options)) return unknown("too few repetitions to tell a slowdown from noise; try --repeat 10");
  const double shared = shared_ratio(cells);
  if (!options.quiet) divide_out(shared, cells);
  Differences differences{{}, static_cast<int>(cells.size())};
  for (const bool slower : {true, false}) {
    judge_cells(cells, slower, options, differences);
    if (options.quiet) judge_shared(cells, slower, options, differences);
  }
  Aspect aspect = summary(differences, "time");
  aspect.reason += fmt::format("; all share the ratio {:.3g}{}", shared,
                               options.quiet ? "" : ", which may be the machine's and is divided out");
  return aspect;
}

}  // namespace

Comparison compare(const Recording& a, const Recording& b, const CompareOptions& options) {
  const Matching matching = match(a.runs, b.runs);
  Differences accuracy, work;
  for (const Pair& pair : matching.pairs) {
    compare_accuracy(pair, options, accuracy);
    compare_work(pair, work);
  }
  for (const RunRecord* run : matching.lost)
    accuracy.add({title(*run), "cell", "recorded", what_differs(*run, b.runs), 0, Change::not_comparable});
  compare_tables(a.tables, b.tables, options, accuracy, work);
  if (accuracy.cells == 0 && accuracy.all.empty())
    accuracy.add({"all", "cells", "nothing", "nothing in common", 0, Change::not_comparable});
  return {summary(accuracy, "accuracy"), summary(work, "work"), compare_times(a, b, matching, options)};
}

int exit_code(const Comparison& comparison) {
  const auto any = [&](Change change) {
    return comparison.accuracy.change == change || comparison.work.change == change || comparison.time.change == change;
  };
  return any(Change::regression) ? 1 : any(Change::not_comparable) ? 2 : 0;
}

std::string to_string(Change change) {
  switch (change) {
    case Change::same: return "same";
    case Change::better: return "better";
    case Change::changed: return "changed";
    case Change::regression: return "REGRESSION";
    case Change::not_comparable: return "not comparable";
  }
  return "unknown";
}

}  // namespace drape::results
