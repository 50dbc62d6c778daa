#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "bench/runs/energy_guard.hpp"
#include "bench/studies/stability/stability.hpp"
#include "reference/theory/linear_prediction.hpp"
#include "results/verdict.hpp"

namespace drape::bench {
namespace {

using solver::Method;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double visible_growth = 10;  ///< of an amplitude in a run: its energy is then out of bounds

/// A part of the atlas: one mesh and one time step.
struct Sheet {
  int n;
  double step;  ///< [s]
  std::vector<double> stiffnesses, ratios;
  double effort = 1;        ///< part of the usual limits
  bool spot_check = false;  ///< only what the bar is about
};

std::vector<double> decades(int from, int to, int stride = 1) {
  std::vector<double> all;
  for (int k = from; k <= to; k += stride) all.push_back(std::pow(10, k));
  return all;
}

/// h k/d, without damping at the end.
std::vector<double> ratios(int from, int to, int stride = 1) {
  std::vector<double> all = decades(from, to, stride);
  all.push_back(infinity);
  return all;
}

std::vector<Sheet> sheets(bool quick) {
  if (quick) return {{6, 0.02, {1, 1e5}, {1, 1e4}}};
  return {{10, 0.01, decades(0, 7), ratios(-2, 6)},
          {20, 0.01, decades(1, 7, 2), ratios(-2, 6, 2), 0.5},
          {10, 0.04, decades(1, 7, 3), ratios(-2, 6, 2)},
          {10, 0.0025, decades(1, 7, 3), ratios(-2, 6, 2)},
          {40, 0.01, {1e3, 1e7}, {1, 1e3, infinity}, 1, true}};
}

/// A method with its stage solver as it stands in the atlas.
struct Row {
  std::string name;
  const Method* method;
  solver::Options options;
  std::int64_t evaluations;  ///< that a run may take
};

constexpr const char* bar_methods[] = {"implicit-euler", "bdf2", "midpoint"};

bool is_bar_method(std::string_view name) { return std::ranges::find(bar_methods, name) != std::end(bar_methods); }

bool tries(const Sheet& sheet, const Row& row) { return !sheet.spot_check || is_bar_method(row.name); }

/// What a run may cost.
std::int64_t evaluations(const Method& method) { return is_bar_method(method.name) ? 20'000 : usual_evaluations(method); }

/// All methods, and the thesis' loop where a method has one.
std::vector<Row> rows(const Methods& methods) {
  std::vector<Row> all;
  for (const Method* method : methods) all.push_back({std::string(method->name), method, {}, evaluations(*method)});
  for (const Method* method : methods)
    if (is_bar_method(method->name))
      all.push_back({fmt::format("{}/fixed-point", method->name), method, solver::thesis_options(), evaluations(*method)});
  return all;
}

/// What linear theory leads one to expect of a run.
struct Expected {
  double growth;  ///< of the fastest growing mode in the run
  double loop;    ///< contraction of the thesis' loop; 0: there is none
  bool stable, converges;

  bool good() const { return stable && converges; }
};

struct AtlasCell {
  const Sheet* sheet;
  const Row* row;
  double stiffness, ratio;
  std::optional<Expected> expected;  ///< nothing where there is no theory
  ClassifiedRun run;

  bool is_as_predicted() const { return expected && expected->good() == run.stable(); }
};

/// All runs; they point into sheets and rows.
struct Atlas {
  std::vector<Sheet> sheets;
  std::vector<Row> rows;
  std::vector<AtlasCell> cells;
};

class Predictions {
 public:
  std::optional<Expected> of(const Row& row, const Sheet& sheet, double nu, double ratio) {
    const auto key = std::tuple(row.method, nu, ratio);
    auto known = known_.find(key);
    if (known == known_.end()) known = known_.emplace(key, reference::predict(*row.method, nu, ratio)).first;
    if (!known->second) return std::nullopt;
    const reference::LinearPrediction& linear = *known->second;
    const double growth = std::pow(linear.radius, std::round(horizon / sheet.step));
    const bool thesis_loop = !row.options.stage->accelerated && row.method->nonlinear();
    const double loop = thesis_loop ? linear.loop : 0;
    return Expected{growth, loop, growth < visible_growth,
                    std::pow(loop, row.options.max_updates) < row.options.loop_tolerance};
  }

 private:
  std::map<std::tuple<const Method*, double, double>, std::optional<reference::LinearPrediction>> known_;
};

constexpr std::string_view expectations[] = {"stable", "unstable", "loop too slow"};

std::string_view describe(const std::optional<Expected>& expected) {
  if (!expected) return "no theory known";
  return expectations[!expected->stable ? 1 : expected->converges ? 0 : 2];
}

using results::Part;
using results::Role;
using results::to_datum;

constexpr results::ColumnOf<AtlasCell> cell_columns[] = {
    {"n", "n", "1", "particles a side", Role::key, [](const AtlasCell& cell) { return to_datum(cell.sheet->n); }},
    {"step", "h", "s", "time step", Role::key, [](const AtlasCell& cell) { return to_datum(cell.sheet->step); }},
    {"method", "method", "", "time integrator, with its stage solver if that is not auto", Role::key,
     [](const AtlasCell& cell) { return to_datum(cell.row->name); }},
    {"nu", "ν_h", "1", "numerical stiffness h² k/(ρ l²)", Role::key, results::field<&AtlasCell::stiffness>},
    {"to_damping", "h k/d", "1", "infinite without damping", Role::key, results::field<&AtlasCell::ratio>},
    {"predicted", "predicted", "", "by the amplification of linear modes and the contraction of the thesis' loop", Role::note,
     [](const AtlasCell& cell) { return to_datum(describe(cell.expected)); }, nullptr, expectations},
};

constexpr results::ColumnOf<Expected> expected_columns[] = {
    {"growth", "", "1", "of the fastest growing linear mode in the run", Role::quantity, results::field<&Expected::growth>},
    {"loop", "", "1", "contraction of the thesis' loop, 0 if there is none", Role::quantity, results::field<&Expected::loop>},
};

results::Table cells_table(std::string name, std::string description, const std::vector<AtlasCell>& cells) {
  results::Table table = results::make_table(std::move(name), std::move(description), cell_columns, cells);
  results::add_columns(table, expected_columns, cells, std::mem_fn(&AtlasCell::expected));
  results::add_columns(table, classified_columns, cells, [](const AtlasCell& cell) { return &cell.run; });
  return table;
}

/// A sheet of one stiffness and one damping with its reference, for all methods that are tried on it.
struct TestedSheet {
  CompiledScene hung;
  CrossCheckedReference reference;

  TestedSheet(const Sheet& sheet, double k, double d) : hung(hung_by_corners(sheet.n, k, d)), reference(hung, sheet.effort) {}
};

/// Tries all methods on a sheet of one stiffness and one damping.
void explore(Atlas& atlas, const Sheet& sheet, double nu, double ratio, Predictions& predictions, Checkpoint& checkpoint) {
  const double l = 0.8 / (sheet.n - 1), h = sheet.step, k = nu * l * l / (h * h);
  std::optional<TestedSheet> tested;  // made for the first run that no process before this one has made
  checkpoint.each(atlas.rows, [&](const Row& row) {
    if (!tries(sheet, row)) return;
    const Limits limits{.evaluations = static_cast<std::int64_t>(sheet.effort * static_cast<double>(row.evaluations))};
    const ClassifiedRun run = checkpoint.once(fmt::format("{} {} {} {} {}", sheet.n, h, nu, ratio, row.name), [&] {
      if (!tested) tested.emplace(sheet, k, h * k / ratio);
      const RunSpec spec{tested->hung.scene, "", row.method, h, row.options};
      // A cloth of its own: one keeps the stability limit, whose search would count for the first run that needs it.
      return classified(run_guarded(spec, model::compile(spec.scene), limits), tested->reference);
    });
    atlas.cells.push_back({&sheet, &row, nu, ratio, predictions.of(row, sheet, nu, ratio), run});
  });
}

Atlas explored(bool quick, const Methods& methods, Checkpoint& checkpoint) {
  Atlas atlas{sheets(quick), rows(all_or(methods)), {}};
  Predictions predictions;
  checkpoint.each(atlas.sheets, [&](const Sheet& sheet) {
    checkpoint.each(sheet.stiffnesses, [&](const double nu) {
      checkpoint.each(sheet.ratios, [&](const double ratio) {
        checkpoint.show(fmt::format("{0} x {0}, h = {1}, ν = {2:g}, h k/d = {3:g}", sheet.n, sheet.step, nu, ratio));
        explore(atlas, sheet, nu, ratio, predictions, checkpoint);
        checkpoint.advance();
      });
    });
  });
  return atlas;
}

/// All runs: for the file, so without titles.
results::Table runs_of_atlas(const Atlas& atlas) {
  results::Table table = cells_table("stability-atlas", "Every run of the atlas", atlas.cells);
  table.for_file = true;
  draw(table, results::Figure::stability,
       {{Part::figure, "n"},
        {Part::figure, "step"},
        {Part::curve, "method"},
        {Part::x, "to_damping"},
        {Part::y, "nu"},
        {Part::colour, "verdict"},
        {Part::outline, "predicted"},
        {Part::detail, "error"},
        {Part::detail, "uncertainty"},
        {Part::detail, "reason"}});
  return table;
}

/// How many runs of a method on a sheet end how.
struct Endings {
  const Sheet* sheet;
  const Row* row;
  std::array<int, classifications> counts;
  int total;
  std::optional<int> as_predicted;
};

template <Classification classification>
constexpr results::ColumnOf<Endings> count_column(const char* name) {
  return {name, to_string(classification).data(), "1", "runs", Role::quantity, [](const Endings& row) {
            return to_datum(row.counts[static_cast<std::size_t>(classification)]);
          }};
}

constexpr results::ColumnOf<Endings> endings_columns[] = {
    {"n", "n", "1", "particles a side", Role::key, [](const Endings& row) { return to_datum(row.sheet->n); }},
    {"step", "h", "s", "time step", Role::key, [](const Endings& row) { return to_datum(row.sheet->step); }},
    {"method", "method", "", "time integrator, with its stage solver if that is not auto", Role::key,
     [](const Endings& row) { return to_datum(row.row->name); }},
    count_column<Classification::accurate>("accurate"),
    count_column<Classification::wrong>("wrong"),
    count_column<Classification::bounded>("bounded"),
    count_column<Classification::unstable>("unstable"),
    count_column<Classification::not_converged>("not_converged"),
    count_column<Classification::not_finished>("not_finished"),
    {"total", "of", "1", "runs", Role::quantity, results::field<&Endings::total>},
    {"as_predicted", "as predicted", "1", "runs that are stable and converge just where linear theory says so", Role::quantity,
     results::field<&Endings::as_predicted>},
};

results::Table count_verdicts(const Atlas& atlas) {
  std::vector<Endings> all;
  for (const Sheet& sheet : atlas.sheets)
    for (const Row& row : atlas.rows) {
      if (!tries(sheet, row)) continue;
      Endings endings{&sheet, &row, {}, 0, {}};
      for (const AtlasCell& cell : atlas.cells) {
        if (cell.sheet != &sheet || cell.row != &row) continue;
        ++endings.total;
        ++endings.counts[static_cast<std::size_t>(cell.run.classification)];
        if (cell.expected) endings.as_predicted = endings.as_predicted.value_or(0) + (cell.is_as_predicted() ? 1 : 0);
      }
      all.push_back(endings);
    }
  return results::make_table("stability-verdicts", "How many runs of the atlas end how, method by method", endings_columns,
                             all);
}

/// Runs of a method that are predicted stable.
struct Converging {
  std::string method;
  int stable = 0, converge = 0, rise = 0;
};

constexpr results::ColumnOf<Converging> converging_columns[] = {
    {"method", "method", "", "time integrator", Role::key, results::field<&Converging::method>},
    {"stable", "predicted stable", "1", "runs", Role::quantity, results::field<&Converging::stable>},
    {"converge", "converge", "1", "of these: the equations of every step were solved", Role::quantity,
     results::field<&Converging::converge>},
    {"rise", "energy rises", "1", "of these: the solution of the method's equations gains energy", Role::quantity,
     results::field<&Converging::rise>},
    {"verdict", "verdict", "", "whether all of them do", Role::verdict,
     [](const Converging& row) -> results::Datum {
       return results::check(row.converge == row.stable, "all converge", "not all converge");
     }},
};

/// The bar: what is predicted stable converges with the default solvers. A run that ends since its energy rose has converged in
/// every step: the midpoint rule doubles what an edge turns by, so that a chord that turns by φ in half a step is stretched
/// by φ², and linear theory knows nothing of turning.
results::Table check_bar(const Atlas& atlas) {
  std::vector<Converging> all;
  for (const Row& row : atlas.rows) {
    if (!is_bar_method(row.name)) continue;
    Converging& counts = all.emplace_back(Converging{row.name});
    for (const AtlasCell& cell : atlas.cells) {
      if (cell.row != &row || !cell.expected->good()) continue;
      ++counts.stable;
      const bool rises = cell.run.end.result.outcome == solver::Outcome::unstable;
      if (rises) ++counts.rise;
      if (rises || cell.run.end.succeeded()) ++counts.converge;
    }
  }
  return results::make_table("stability-bar", "Runs that are predicted stable and do converge, with the default solvers",
                             converging_columns, all);
}

/// Runs that are not what linear theory says.
results::Table list_surprises(const Atlas& atlas) {
  std::vector<AtlasCell> surprises;
  std::ranges::copy_if(atlas.cells, std::back_inserter(surprises),
                       [](const AtlasCell& cell) { return cell.expected && !cell.is_as_predicted(); });
  return cells_table("stability-surprises",
                     "Runs of the atlas that are stable and converge where linear theory does not expect it, or not where it "
                     "does",
                     surprises);
}

}  // namespace

Job stability_atlas(bool quick, const Methods& methods) {
  int parts = 0;
  for (const Sheet& sheet : sheets(quick)) parts += static_cast<int>(sheet.stiffnesses.size() * sheet.ratios.size());
  const auto compute = [=](Checkpoint& checkpoint) { return explored(quick, methods, checkpoint); };
  const auto present = [](const Atlas& atlas) {
    return std::vector{runs_of_atlas(atlas), count_verdicts(atlas), check_bar(atlas), list_surprises(atlas)};
  };
  return job("stability-atlas", parts, compute, present);
}

}  // namespace drape::bench
