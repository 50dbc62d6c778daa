#include "results/analysis/runs_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "solver/base/statistics.hpp"
#include "solver/outcome.hpp"

namespace drape::results {
namespace {

/// A column and where a run has its value.
struct RunColumn {
  std::string_view name;
  std::string_view title;
  std::string_view unit;
  Cell (*cell)(const RunRecord&);
  std::string (*shown)(const RunRecord&) = nullptr;  ///< if people see something else
};

/// Of the times of the repetitions.
Cell time_quantile(const RunRecord& run, double share) {
  return run.times_ms.empty() ? Cell() : Cell(base::quantile(run.times_ms, share));
}

template <class Value>
Cell of_error(const RunRecord& run, Value ErrorRecord::*member) {
  return run.error ? Cell((*run.error).*member) : Cell();
}

Cell of_motion(const RunRecord& run, double MotionErrorRecord::*member) {
  return run.motion_error ? Cell((*run.motion_error).*member) : Cell();
}

Cell of_contact(const RunRecord& run, double ContactRecord::*member) {
  return run.contact ? Cell((*run.contact).*member) : Cell();
}

using Run = const RunRecord&;

/// Why there is no error, and no digits of an error that the reference is too uncertain to resolve.
std::string shown_error(Run run) {
  if (run.outcome != to_string(solver::Outcome::success)) return fmt::format("{} at {:.4g} s", run.outcome, run.last_good_time);
  if (!run.error) return {};
  if (run.error->growth > comparable_growth) return fmt::format("growth {:.1g}", run.error->growth);
  if (!comparable(*run.error)) return fmt::format("± {:.1g}", run.error->reference_error);
  if (!resolved(*run.error)) return fmt::format("< {:.1g}", resolution * run.error->reference_error);
  return fmt::format("{:.4g}", run.error->rms);
}

/// Of the whole motion, as shown_error() has the error at the end.
std::string shown_in_motion(Run run, double MotionErrorRecord::*value, double unit) {
  if (!run.motion_error || !run.error || !comparable(*run.error)) return {};
  const double least = resolution * run.error->reference_error * unit, error = (*run.motion_error).*value;
  return error < least ? fmt::format("< {:.1g}", least) : fmt::format("{:.4g}", error);
}

/// The method, and how little of the run was its own where most was not.
std::string shown_method(Run run) {
  const std::int64_t starting = work_count(run, "starting_steps");
  if (2 * starting <= std::ssize(run.steps)) return run.method;
  return fmt::format("{} (starting: {} of {} steps)", run.method, starting, run.steps.size());
}

/// A statistic with its uncertainty, for runs whose positions are not comparable.
std::string shown_statistic(Run run, double ErrorRecord::*value, double ErrorRecord::*spread) {
  if (!run.error || comparable(*run.error)) return {};
  return fmt::format("{:.2g} ± {:.1g}", (*run.error).*value, (*run.error).*spread);
}

/// The area in contact, and that of the reference.
std::string shown_area(Run run) {
  if (!run.contact) return {};
  if (std::isnan(run.contact->reference_area)) return fmt::format("{:.3g}", run.contact->area);
  return fmt::format("{:.3g} ({:.3g})", run.contact->area, run.contact->reference_area);
}

constexpr RunColumn columns[] = {
    {"scene", "scene", "", [](Run run) -> Cell { return run.scene; }},
    {"method", "method", "", [](Run run) -> Cell { return run.method; }, shown_method},
    {"step", "step", "s", [](Run run) -> Cell { return run.step; }},
    {"outcome", "", "", [](Run run) -> Cell { return run.outcome; }},
    {"message", "", "", [](Run run) -> Cell { return run.message; }},
    {"steps", "steps", "1", [](Run run) -> Cell { return std::ssize(run.steps); }},
    {"starting_steps", "", "1", [](Run run) -> Cell { return work_count(run, "starting_steps"); }},
    {"updates", "updates", "1", [](Run run) -> Cell { return work_count(run, "updates"); }},
    {"cg_iterations", "CG", "1", [](Run run) -> Cell { return work_count(run, "cg_iterations"); }},
    {"wall_ms_min", "wall min", "ms", [](Run run) { return time_quantile(run, 0); }},
    {"wall_ms_median", "median", "ms", [](Run run) { return time_quantile(run, 0.5); }},
    {"wall_ms_max", "max", "ms", [](Run run) { return time_quantile(run, 1); }},
    {"error_rms", "rms error", "1", [](Run run) { return of_error(run, &ErrorRecord::rms); }, shown_error},
    {"error_run", "over the run", "1", [](Run run) { return of_motion(run, &MotionErrorRecord::position); },
     [](Run run) { return shown_in_motion(run, &MotionErrorRecord::position, 1); }},
    {"error_relative", "of its motion", "1", [](Run run) { return of_motion(run, &MotionErrorRecord::relative); },
     [](Run run) {
       return shown_in_motion(run, &MotionErrorRecord::relative, run.motion_error ? 1 / run.motion_error->amplitude : 1);
     }},
    {"reference", "", "", [](Run run) { return of_error(run, &ErrorRecord::reference); }},
    {"reference_error", "reference error", "1", [](Run run) { return of_error(run, &ErrorRecord::reference_error); }},
    {"error_max", "", "1", [](Run run) { return of_error(run, &ErrorRecord::maximum); }},
    {"growth", "", "1", [](Run run) { return of_error(run, &ErrorRecord::growth); }},
    {"energy_error", "energy error", "1", [](Run run) { return of_error(run, &ErrorRecord::energy); },
     [](Run run) { return shown_statistic(run, &ErrorRecord::energy, &ErrorRecord::energy_spread); }},
    {"centre_error", "centre error", "1", [](Run run) { return of_error(run, &ErrorRecord::centre); },
     [](Run run) { return shown_statistic(run, &ErrorRecord::centre, &ErrorRecord::centre_spread); }},
    {"amplitude", "", "1", [](Run run) { return of_motion(run, &MotionErrorRecord::amplitude); }},
    {"velocity_error_run", "", "1", [](Run run) { return of_motion(run, &MotionErrorRecord::velocity); }},
    {"energy_error_run", "", "1", [](Run run) { return of_motion(run, &MotionErrorRecord::energy); }},
    {"momentum_error_run", "", "1", [](Run run) { return of_motion(run, &MotionErrorRecord::momentum); }},
    {"angular_momentum_error_run", "", "1", [](Run run) { return of_motion(run, &MotionErrorRecord::angular_momentum); }},
    {"clearance", "clearance", "m", [](Run run) { return of_contact(run, &ContactRecord::clearance); }},
    {"energy_rise", "energy rise", "1", [](Run run) { return of_contact(run, &ContactRecord::energy_rise); }},
    {"contact_area", "contact area", "1", [](Run run) { return of_contact(run, &ContactRecord::area); }, shown_area},
    {"numerical_stiffness", "ν_h", "1", [](Run run) -> Cell { return run.numerical_stiffness; }},
    {"stiffness_to_damping", "h k/d", "1", [](Run run) -> Cell { return run.stiffness_to_damping; }},
    {"last_good_time", "", "s", [](Run run) -> Cell { return run.last_good_time; }},
    {"set", "set", "", [](Run run) -> Cell { return run.overrides; }},
};

}  // namespace

Table to_table(std::span<const RunRecord> runs) {
  Table table{"runs", "one row for each run", {}};
  for (const RunColumn& column : columns) {
    Column& c = table.columns.emplace_back(
        Column{std::string(column.name), std::string(column.title), std::string(column.unit), "", {}, {}});
    for (const RunRecord& run : runs) {
      c.cells.push_back(column.cell(run));
      if (column.shown) c.shown.push_back(column.shown(run));
    }
  }
  return table;
}

}  // namespace drape::results
