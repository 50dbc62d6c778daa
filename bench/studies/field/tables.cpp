#include "bench/studies/field/tables.hpp"

#include <fmt/format.h>

#include "results/columns.hpp"

namespace drape::bench {
namespace {

using results::ColumnOf;
using results::Datum;
using results::field;
using results::Part;
using results::Role;
using results::to_datum;

Datum number_or_none(double value) { return std::isnan(value) ? Datum() : Datum(value); }

// --- Which sheet it is of --------------------------------------------------------------------------------------------------

constexpr ColumnOf<SheetResult> field_sheet_columns[] = {
    {"scene", "scene", "", "its name, and its fabric", Role::key,
     [](const SheetResult& s) { return to_datum(s.sheet.label()); }},
    {"damping", "d", "N s/m", "linear damping", Role::key, field<&SheetResult::damping>},
    {"n", "n", "1", "particles a side", Role::key, [](const SheetResult& s) { return to_datum(s.sheet.n); }},
};

constexpr ColumnOf<FieldRun> setting_columns[] = {
    {"setting", "setting", "", "a method with its step or fraction of its stability limit", Role::key,
     [](const FieldRun& run) { return to_datum(run.setting()); }},
    {"family", "family", "", "kind of method by what a step solves", Role::note,
     [](const FieldRun& run) { return to_datum(run.family()); }},
};

// --- Runs --------------------------------------------------------------------------------------------------------------------

constexpr ColumnOf<FieldRun> field_run_columns[] = {
    {"method", "", "", "time integrator", Role::key, field<&FieldRun::method>},
    {"value", "", "1", "step [s], or fraction of the stability limit", Role::key, field<&FieldRun::value>},
    {"family", "", "", "kind of method by what a step solves", Role::note,
     [](const FieldRun& run) { return to_datum(run.family()); }},
    {"side", "", "", "all that were tried", Role::note, [](const FieldRun&) { return to_datum("all methods"); }},
    {"settings", "", "", "whether it is recommended to all", Role::note,
     [](const FieldRun& run) { return to_datum(run.recommended ? "recommended" : ""); }},
    {"outcome", "", "", "how the run ended", Role::outcome, field<&FieldRun::outcome>},
    {"reason", "", "", "why it did not succeed", Role::note, field<&FieldRun::reason>},
    {"error", "", "1", "largest distance from the reference at all tenths of the end, over the scene's size", Role::error,
     [](const FieldRun& run) { return number_or_none(run.error); }},
    {"lag", "", "s", "by which it is late, where that makes it come nearest to the reference", Role::quantity,
     [](const FieldRun& run) { return number_or_none(run.lag); }},
    {"lag_uncertainty", "", "s", "uncertainty of the lag", Role::quantity,
     [](const FieldRun& run) { return number_or_none(run.lag_uncertainty); }},
    {"energy", "", "1", "largest difference of the total energy, over the reference's largest change", Role::quantity,
     [](const FieldRun& run) { return number_or_none(run.energy); }},
    {"energy_at_end", "", "1", "the same at the end; negative: too little", Role::quantity,
     [](const FieldRun& run) { return number_or_none(run.energy_at_end); }},
    {"momentum", "", "1", "largest difference of the momentum, over the mass times the reference's largest velocity",
     Role::quantity, [](const FieldRun& run) { return number_or_none(run.momentum); }},
    {"angular_momentum", "", "1", "the same about the centre of the start, over that times the size", Role::quantity,
     [](const FieldRun& run) { return number_or_none(run.angular_momentum); }},
    {"steps", "", "1", "accepted steps", Role::counter, field<&FieldRun::steps>},
    {"systems", "", "1", "linear systems solved", Role::counter, field<&FieldRun::systems>},
    {"evaluations", "", "1", "of forces, and of Newton matrices", Role::counter, field<&FieldRun::evaluations>},
    {"repetitions", "", "1", "times it was run for the median", Role::time,
     [](const FieldRun& run) { return to_datum(run.times.size()); }},
};

using FieldTimes = const results::Quartiles&;
constexpr ColumnOf<results::Quartiles> field_time_columns[] = {
    {"time", "time", "ms", "median CPU time", Role::time, [](FieldTimes t) -> Datum { return t.median; }},
    {"lower", "", "ms", "lower quartile", Role::time, [](FieldTimes t) -> Datum { return t.lower; }},
    {"upper", "", "ms", "upper quartile", Role::time, [](FieldTimes t) -> Datum { return t.upper; }},
};

std::optional<results::Quartiles> times_of_run(const FieldRun* run) {
  if (run == nullptr || run->times.empty()) return std::nullopt;
  return results::quartiles(run->times);
}

results::Table field_runs_table(const SheetResult& sheet) {
  const std::string without = sheet.missing.empty() ? "" : "; no reference: " + sheet.missing;
  results::Table table =
      results::make_table("field: " + sheet.sheet.name(), fmt::format("All methods on {}{}", sheet.sheet.name(), without),
                          field_run_columns, sheet.runs);
  results::add_columns(table, field_time_columns, sheet.runs, [](const FieldRun& run) { return times_of_run(&run); });
  table.columns.push_back({"uncertainty",
                           "",
                           "1",
                           "of the reference, as the error",
                           Role::uncertainty,
                           std::vector<Datum>(sheet.runs.size(), number_or_none(sheet.uncertainty)),
                           {}});
  table.timed_rows = table.for_file = true;
  draw(table, results::Figure::work_precision,
       {{Part::side, "side"},
        {Part::curve, "family"},
        {Part::x, "error"},
        {Part::y, "time"},
        {Part::lower, "lower"},
        {Part::upper, "upper"},
        {Part::detail, "method"},
        {Part::detail, "value"},
        {Part::detail, "lag"},
        {Part::detail, "energy"},
        {Part::detail, "systems"},
        {Part::detail, "evaluations"}});
  return table;
}

// --- Fronts ------------------------------------------------------------------------------------------------------------------

struct FrontRow {
  const SheetResult* sheet;
  const FieldRun* run;
};

constexpr ColumnOf<FrontRow> front_columns[] = {
    {"error", "error", "1", "largest distance from the reference, over the scene's size", Role::time,
     [](const FrontRow& row) -> Datum { return row.run->error; }},
    {"lag", "lag", "s", "by which it is late", Role::time, [](const FrontRow& row) { return number_or_none(row.run->lag); }},
    {"energy", "energy", "1", "largest difference of the total energy", Role::time,
     [](const FrontRow& row) { return number_or_none(row.run->energy); }},
};

results::Table fronts_table(const std::vector<SheetResult>& sheets) {
  std::vector<FrontRow> rows;
  for (const SheetResult& sheet : sheets)
    for (const FieldRun* run : front_of(sheet)) rows.push_back({&sheet, run});
  results::Table table{"field-fronts", "What no other setting beats in both error and time, the quickest first", {}};
  results::add_columns(table, field_sheet_columns, rows, [](const FrontRow& row) { return row.sheet; });
  results::add_columns(table, setting_columns, rows, [](const FrontRow& row) { return row.run; });
  results::add_columns(table, front_columns, rows);
  results::add_columns(table, field_time_columns, rows, [](const FrontRow& row) { return times_of_run(row.run); });
  table.timed_rows = true;
  return table;
}

// --- Winners -----------------------------------------------------------------------------------------------------------------

constexpr ColumnOf<FieldWinner> field_winner_columns[] = {
    {"settings", "settings", "", "recommended: one for all; tuned: any, with hindsight", Role::key,
     [](const FieldWinner& row) { return to_datum(to_string(row.settings)); }},
    {"error", "error <=", "1", "largest at all tenths of the end, over the scene's size", Role::key,
     field<&FieldWinner::error>},
    {"family", "family", "", "of the quickest", Role::note, [](const FieldWinner& row) { return to_datum(row.family()); }},
    {"best", "quickest", "", "of all methods", Role::note,
     [](const FieldWinner& row) { return row.best == nullptr ? Datum() : to_datum(row.best->setting()); }},
};

constexpr ColumnOf<FieldWinner> margin_columns[] = {
    {"next", "next family", "", "the quickest of the other families", Role::note,
     [](const FieldWinner& row) { return row.next == nullptr ? Datum() : to_datum(row.next->setting()); }},
    {"margin", "slower by", "1", "its time over that of the quickest", Role::time,
     [](const FieldWinner& row) { return to_datum(row.margin()); }},
    {"lead", "lead", "", "clear, or a tie: the middle halves of the times overlap", Role::note,
     [](const FieldWinner& row) { return to_datum(lead_names[static_cast<std::size_t>(row.lead())]); }, nullptr, lead_names},
};

constexpr ColumnOf<results::Interval> margin_interval_columns[] = {
    {"margin_lower", "from", "1", "its 95 % interval, by bootstrap", Role::time, field<&results::Interval::lower>},
    {"margin_upper", "to", "1", "its 95 % interval, by bootstrap", Role::time, field<&results::Interval::upper>},
};

std::optional<results::Interval> margin_interval(const FieldWinner& row) {
  if (row.best == nullptr || row.next == nullptr) return std::nullopt;
  return results::ratio_of_medians(row.next->measured(), row.best->measured());
}

results::Table field_winners_table(const std::vector<SheetResult>& sheets) {
  std::vector<FieldWinner> rows;
  for (const Settings settings : both_settings)
    for (const FieldWinner& row : field_winners(sheets, settings)) rows.push_back(row);
  results::Table table{"field-winners", "The quickest of all methods, and by how much the next family is slower", {}};
  results::add_columns(table, field_sheet_columns, rows, [](const FieldWinner& row) { return row.sheet; });
  results::add_columns(table, field_winner_columns, rows);
  results::add_columns(table, field_time_columns, rows, [](const FieldWinner& row) { return times_of_run(row.best); });
  results::add_columns(table, margin_columns, rows);
  results::add_columns(table, margin_interval_columns, rows, margin_interval);
  find_column(table, "family")->classes = family_names();
  draw(table, results::Figure::map,
       {{Part::figure, "settings"},
        {Part::figure, "n"},
        {Part::curve, "scene"},
        {Part::x, "damping"},
        {Part::y, "error"},
        {Part::colour, "family"},
        {Part::outline, "lead"},
        {Part::detail, "best"},
        {Part::detail, "time"},
        {Part::detail, "next"},
        {Part::detail, "margin"}});
  return table;
}

// --- Settings on other sheets ---------------------------------------------------------------------------------------

constexpr ColumnOf<Transfer> transfer_columns[] = {
    {"error", "error <=", "1", "for which the setting was chosen", Role::key, field<&Transfer::error>},
    {"chosen_on", "chosen on", "", "sheet on which it was the quickest", Role::note,
     [](const Transfer& row) { return to_datum(row.training->sheet.name()); }},
    {"setting", "setting", "", "a method with its step or fraction of its stability limit", Role::note,
     field<&Transfer::setting>},
    {"found", "error", "1", "that it has here", Role::time,
     [](const Transfer& row) { return row.chosen == nullptr ? Datum() : number_or_none(row.chosen->error); }},
    {"ratio", "over the best", "1", "its time over that of the quickest with hindsight", Role::time,
     [](const Transfer& row) { return to_datum(row.ratio()); }},
    {"verdict", "verdict", "", "whether the error is as small here", Role::verdict,
     [](const Transfer& row) { return to_datum(row.verdict()); }},
};

results::Table transfer_table(const std::vector<SheetResult>& sheets) {
  const std::vector<Transfer> rows = transfers(sheets);
  results::Table table{"field-transfer", "Settings chosen on the sheet hung by its edge, on other sheets", {}};
  results::add_columns(table, field_sheet_columns, rows, [](const Transfer& row) { return row.sheet; });
  results::add_columns(table, transfer_columns, rows);
  table.timed_rows = true;
  return table;
}

// --- The answer --------------------------------------------------------------------------------------------------------------

constexpr ColumnOf<FieldAnswer> answer_columns[] = {
    {"settings", "settings", "", "recommended: one for all; tuned: any, with hindsight", Role::key,
     [](const FieldAnswer& row) { return to_datum(to_string(row.settings)); }},
    {"damping", "damping", "", "h k/d at h = 0.01 s", Role::key, field<&FieldAnswer::damping>},
    {"error", "error <=", "1", "largest at all tenths of the end, over the scene's size", Role::key,
     field<&FieldAnswer::error>},
    {"sheets", "sheets", "1", "on which some method reaches the error", Role::time, field<&FieldAnswer::sheets>},
    {"family", "use", "", "family that is the quickest most often", Role::note, field<&FieldAnswer::family>},
    {"method", "by", "", "its method that is the quickest most often", Role::note, field<&FieldAnswer::method>},
    {"won", "won", "1", "sheets on which that family is the quickest", Role::time, field<&FieldAnswer::won>},
    {"margin", "next slower by", "1", "geometric mean on these sheets of the next family's time over its", Role::time,
     field<&FieldAnswer::margin>},
};

results::Table answer_table(const std::vector<SheetResult>& sheets) {
  results::Table table = results::make_table("field-answer", "Which integrator to use, over damping and error, all sheets",
                                             answer_columns, field_answers(sheets));
  table.headline = table.timed_rows = true;
  return table;
}

}  // namespace

std::vector<results::Table> field_tables(const std::vector<SheetResult>& sheets) {
  std::vector<results::Table> tables;
  for (const SheetResult& sheet : sheets) tables.push_back(field_runs_table(sheet));
  for (auto* table : {fronts_table, field_winners_table, transfer_table, answer_table}) tables.push_back(table(sheets));
  return tables;
}

}  // namespace drape::bench
