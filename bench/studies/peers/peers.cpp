#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "bench/studies/peers/runs.hpp"
#include "results/analysis/work_precision.hpp"
#include "results/columns.hpp"

/// Other simulators and PETSc, run here: how far off they are, of which order, and how long they take, beside our methods on
/// the same equation.
namespace drape::bench::peers {
namespace {

using results::ColumnOf;
using results::Datum;
using results::field;
using results::make_table;
using results::Role;
using results::Table;

/// What an independent driver measured on peer-edge 20, with the same springs and a reference of its own [m]; NaN: not told, or
/// below what its reference tells. Jolt with 100 sub-steps is left out: that is round-off of single precision.
struct PrintedFigure {
  const char* peer;
  double step;
  std::array<double, 3> errors;
};
constexpr PrintedFigure printed_figures[] = {
    {"bullet-explicit", 1e-3, {4.65e-4, 1.047e-3, 1.274e-3}},
    {"bullet-explicit", 5e-4, {2.33e-4, 5.23e-4, 6.340e-4}},
    {"bullet-explicit", 2.5e-4, {1.16e-4, 2.62e-4, 3.164e-4}},
    {"bullet-float-explicit", 2.5e-4, {1.16e-4, 2.61e-4, 3.157e-4}},
    {"bullet-implicit", 1e-2, {4.32e-3, 7.1e-3, 5.18e-2}},
    {"bullet-implicit", 5e-3, {2.19e-3, 3.7e-3, 3.20e-2}},
    {"bullet-implicit", 1e-3, {4.5e-4, 8.1e-4, 1.03e-2}},
    {"mujoco-euler", 1e-3, {NAN, NAN, 1.274e-3}},
    {"mujoco-euler", 5e-4, {NAN, NAN, 6.340e-4}},
    {"mujoco-euler", 2.5e-4, {NAN, NAN, 3.164e-4}},
    {"mujoco-rk4", 1e-3, {6.4e-9, 2.5e-8, 3.5e-6}},
    {"mujoco-rk4", 5e-4, {NAN, NAN, 2.3e-7}},
    {"mujoco-discrete", 2e-3, {9.4e-4, 2.1e-3, 2.6e-3}},
    {"mujoco-discrete", 1e-3, {4.7e-4, 1.05e-3, 1.4e-3}},
    {"mujoco-flex-discrete", 1e-2, {NAN, 7.4e-3, 4.4e-2}},
    {"mujoco-flex-discrete", 5e-3, {NAN, 3.9e-3, NAN}},
    {"mujoco-flex-discrete", 2e-3, {NAN, 1.7e-3, NAN}},
    {"mujoco-flex-discrete", 1e-3, {NAN, 8.7e-4, NAN}},
    {"mujoco-flex-discrete", 5e-4, {NAN, 4.5e-4, 4.5e-3}},
    {"jolt-5", 1e-2, {2.3e-3, 6.3e-3, 3.96e-2}},
    {"jolt-20", 1e-2, {2.4e-4, 6.2e-4, 7.52e-3}},
};

constexpr double largest_deviation = 0.05;

/// A run with what is printed of it.
struct Reproduced {
  const PeerRun* run;
  const PrintedFigure* printed;

  /// The largest of all times, over what is printed.
  double deviation() const {
    double largest = 0;
    for (std::size_t k = 0; k < printed->errors.size(); ++k)
      if (!std::isnan(printed->errors[k])) largest = std::max(largest, std::abs(run->errors[k] / printed->errors[k] - 1));
    return largest;
  }
};

/// A run in its sheet, with the quickest of ours that is at most as far off.
struct RunRow {
  const PeerResult* sheet;
  std::size_t place;
  const PeerRun* ours = nullptr;

  const PeerRun& run() const { return sheet->runs[place]; }
};

std::optional<results::Quartiles> times_of(const PeerRun& run) {
  return run.seconds.empty() ? std::nullopt : std::optional(results::quartiles(run.seconds));
}

template <double results::Quartiles::*which>
Datum time_cell(const RunRow& row) {
  const auto times = times_of(row.run());
  return times ? Datum((*times).*which) : Datum();
}

template <std::size_t k>
Datum error_cell(const RunRow& row) {
  return row.run().reason.empty() ? Datum(row.run().errors[k]) : Datum();
}

const PeerRun* quickest_of_ours(const PeerResult& sheet, const PeerRun& peer) {
  const PeerRun* best = nullptr;
  for (const PeerRun& run : sheet.runs) {
    if (run.who.is_peer || run.seconds.empty() || !(run.error() <= peer.error())) continue;
    if (best == nullptr || times_of(run)->median < times_of(*best)->median) best = &run;
  }
  return best;
}

/// Whether a run is a peer's with the equation of ours.
bool comparable(const PeerRun& run) {
  return run.who.is_peer && !run.seconds.empty() && peer(run.who.name).measured_by.empty();
}

constexpr ColumnOf<RunRow> run_columns[] = {
    {"sheet", "sheet", "", "scene and particles a side", Role::key,
     [](const RunRow& r) -> Datum { return r.sheet->sheet.name; }},
    {"who", "peer or method", "", "", Role::key, [](const RunRow& r) -> Datum { return r.run().who.name; }},
    {"step", "step", "s", "none where it follows from the stability limit", Role::key,
     [](const RunRow& r) { return r.run().who.divides_steps() ? Datum() : Datum(r.run().who.value); }},
    {"fraction", "of its limit", "1", "step over the stability limit, where it follows from that", Role::key,
     [](const RunRow& r) { return r.run().who.divides_steps() ? Datum(r.run().who.value) : Datum(); }},
    {"simulator", "", "", "with its version", Role::note, [](const RunRow& r) -> Datum { return r.run().simulator; }},
    {"error_1", "at 0.2", "m", "rms error at 0.2 of the end", Role::error, error_cell<0>},
    {"error_2", "at 0.5", "m", "the same at 0.5 of the end", Role::error, error_cell<1>},
    {"error_3", "at the end", "m", "the same at the end", Role::error, error_cell<2>},
    {"uncertainty", "", "m", "of the reference, the largest", Role::uncertainty,
     [](const RunRow& r) -> Datum { return r.sheet->uncertainty; }},
    {"order", "order", "1", "of the error at 0.2 of the end, from the next larger step", Role::note,
     [](const RunRow& r) {
       const double order = observed_order(r.sheet->runs, r.place);
       return std::isfinite(order) ? Datum(order) : Datum();
     }},
    {"time", "time", "s/s", "median wall time of the steps, over the simulated time", Role::time,
     time_cell<&results::Quartiles::median>},
    {"lower", "", "s/s", "lower quartile", Role::time, time_cell<&results::Quartiles::lower>},
    {"upper", "", "s/s", "upper quartile", Role::time, time_cell<&results::Quartiles::upper>},
    {"ours", "ours, as right", "", "the quickest of our methods that is at most as far off", Role::note,
     [](const RunRow& r) { return r.ours ? Datum(r.ours->who.setting()) : Datum(); }},
    {"ratio", "slower by", "1", "time over that of ours", Role::time,
     [](const RunRow& r) { return r.ours ? Datum(times_of(r.run())->median / times_of(*r.ours)->median) : Datum(); }},
    {"reason", "no motion", "", "why", Role::note, [](const RunRow& r) -> Datum { return r.run().reason; }},
};

constexpr ColumnOf<Reproduced> figure_columns[] = {
    {"peer", "peer", "", "", Role::key, [](const Reproduced& r) -> Datum { return r.run->who.name; }},
    {"step", "step", "s", "", Role::key, [](const Reproduced& r) -> Datum { return r.run->who.value; }},
    {"error_1", "at 0.1 s", "m", "rms error", Role::error, [](const Reproduced& r) -> Datum { return r.run->errors[0]; }},
    {"printed_1", "driver's", "m", "the same by an independent driver", Role::quantity,
     [](const Reproduced& r) -> Datum { return r.printed->errors[0]; }},
    {"error_2", "at 0.25 s", "m", "rms error", Role::error, [](const Reproduced& r) -> Datum { return r.run->errors[1]; }},
    {"printed_2", "driver's", "m", "the same by an independent driver", Role::quantity,
     [](const Reproduced& r) -> Datum { return r.printed->errors[1]; }},
    {"error_3", "at 0.5 s", "m", "rms error", Role::error, [](const Reproduced& r) -> Datum { return r.run->errors[2]; }},
    {"printed_3", "driver's", "m", "the same by an independent driver", Role::quantity,
     [](const Reproduced& r) -> Datum { return r.printed->errors[2]; }},
    {"verdict", "verdict", "", "whether all are within 5 %", Role::verdict,
     [](const Reproduced& r) -> Datum {
       return results::check(r.deviation() <= largest_deviation, "within 5 %", fmt::format("off by {:.2g}", r.deviation()));
     }},
};

/// A simulator that is not there.
struct Absent {
  std::string_view name;
  std::string what;
};
constexpr ColumnOf<Absent> absent_columns[] = {
    {"simulator", "simulator", "", "", Role::key, field<&Absent::name>},
    {"missing", "missing", "", "what is to be installed", Role::note, field<&Absent::what>},
};

Table absent_table() {
  std::vector<Absent> rows;
  for (const Simulator& simulator : simulators())
    if (std::string what = missing(simulator); !what.empty()) rows.push_back({simulator.name, std::move(what)});
  return make_table("peers-missing", "Simulators that are not there", absent_columns, rows);
}

Table figures_table(const std::vector<PeerResult>& sheets) {
  std::vector<Reproduced> rows;
  for (const PeerResult& sheet : sheets) {
    if (sheet.sheet.name != "peer-edge 20") continue;
    for (const PeerRun& run : sheet.runs)
      for (const PrintedFigure& figure : printed_figures)
        if (run.who.name == figure.peer && run.who.value == figure.step && run.reason.empty()) rows.push_back({&run, &figure});
  }
  return make_table("peers-figures", "Errors of peers beside those that an independent driver measured of them", figure_columns,
                    rows);
}

}  // namespace

std::vector<double> printed_steps(std::string_view peer) {
  std::vector<double> steps;
  for (const PrintedFigure& figure : printed_figures)
    if (figure.peer == peer) steps.push_back(figure.step);
  return steps;
}

Table peer_table(const std::vector<PeerResult>& sheets) {
  std::vector<RunRow> rows;
  for (const PeerResult& sheet : sheets)
    for (std::size_t k = 0; k < sheet.runs.size(); ++k) {
      RunRow row{&sheet, k};
      if (comparable(row.run())) row.ours = quickest_of_ours(sheet, row.run());
      rows.push_back(row);
    }
  return make_table("peers", "Other simulators and PETSc on our springs, beside our methods: errors, orders, times",
                    run_columns, rows);
}

std::vector<Table> peer_tables(const std::vector<PeerResult>& sheets) {
  return {peer_table(sheets), figures_table(sheets), absent_table()};
}

}  // namespace drape::bench::peers

namespace drape::bench {

std::vector<Job> peer_study(const Question& question) {
  int parts = 0;
  std::vector<peers::PeerSheet> sheets = peers::peer_sheets(question.quick);
  for (const peers::PeerSheet& sheet : sheets) parts += static_cast<int>(sheet.entrants.size()) * sheet.repetitions;
  const auto compute = [sheets = std::move(sheets)](Checkpoint& checkpoint) {
    std::vector<peers::PeerResult> all;
    checkpoint.each(sheets, [&](const peers::PeerSheet& sheet) { all.push_back(peers::run_peers(sheet, checkpoint)); });
    return all;
  };
  return {job("peers", parts, compute, peers::peer_tables)};
}

}  // namespace drape::bench
