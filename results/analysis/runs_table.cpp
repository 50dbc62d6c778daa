#include "results/analysis/runs_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "results/columns.hpp"
#include "solver/base/statistics.hpp"
#include "solver/outcome.hpp"

namespace drape::results {
namespace {

/// A quantile of the times of the repetitions.
Datum time_quantile(const RunRecord& run, double share) {
  return run.times_ms.empty() ? Datum() : Datum(base::quantile(run.times_ms, share));
}

/// A member of a record that a run may have.
template <auto record, auto member>
constexpr auto part = [](const RunRecord& run) { return run.*record ? to_datum((*(run.*record)).*member) : Datum(); };

template <auto member>
constexpr auto of_error = part<&RunRecord::error, member>;
template <auto member>
constexpr auto of_motion = part<&RunRecord::motion_error, member>;
template <auto member>
constexpr auto of_choice = part<&RunRecord::choice, member>;
template <auto member>
constexpr auto of_contact = part<&RunRecord::contact, member>;

using Run = const RunRecord&;

/// Why there is no error, and no digits of an error that the reference is too uncertain to resolve.
std::string shown_error(Run run) {
  if (run.outcome != solver::Outcome::success) return fmt::format("{} at {:.4g} s", to_string(run.outcome), run.last_good_time);
  if (!run.error) return {};
  if (run.error->growth > comparable_growth) return fmt::format("growth {:.1g}", run.error->growth);
  if (!comparable(*run.error)) return fmt::format("± {:.1g}", run.error->reference_error);
  if (!resolved(*run.error)) return fmt::format("< {:.1g}", resolution * run.error->reference_error);
  return fmt::format("{:.4g}", run.error->rms);
}

/// The error of the whole motion, as shown_error() has the error at the end.
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

constexpr ColumnOf<RunRecord> run_columns[] = {
    {"scene", "scene", "", "", Role::key, field<&RunRecord::scene>},
    {"method", "method", "", "", Role::key, field<&RunRecord::method>, shown_method},
    {"step", "step", "s", "", Role::key, field<&RunRecord::step>},
    {"outcome", "", "", "", Role::outcome, field<&RunRecord::outcome>},
    {"message", "", "", "", Role::note, field<&RunRecord::message>},
    {"steps", "steps", "1", "", Role::counter, [](Run run) -> Datum { return std::ssize(run.steps); }},
    {"starting_steps", "", "1", "", Role::counter, [](Run run) -> Datum { return work_count(run, "starting_steps"); }},
    {"updates", "updates", "1", "", Role::counter, [](Run run) -> Datum { return work_count(run, "updates"); }},
    {"cg_iterations", "CG", "1", "", Role::counter, [](Run run) -> Datum { return work_count(run, "cg_iterations"); }},
    {"wall_ms_min", "wall min", "ms", "", Role::time, [](Run run) { return time_quantile(run, 0); }},
    {"wall_ms_median", "median", "ms", "", Role::time, [](Run run) { return time_quantile(run, 0.5); }},
    {"wall_ms_max", "max", "ms", "", Role::time, [](Run run) { return time_quantile(run, 1); }},
    {"error_rms", "rms error", "1", "", Role::error, of_error<&ErrorRecord::rms>, shown_error},
    {"error_run", "over the run", "1", "", Role::error, of_motion<&MotionErrorRecord::position>,
     [](Run run) { return shown_in_motion(run, &MotionErrorRecord::position, 1); }},
    {"error_relative", "of its motion", "1", "", Role::error, of_motion<&MotionErrorRecord::relative>,
     [](Run run) {
       return shown_in_motion(run, &MotionErrorRecord::relative, run.motion_error ? 1 / run.motion_error->amplitude : 1);
     }},
    {"reference", "", "", "", Role::note, of_error<&ErrorRecord::reference>},
    {"reference_error", "reference error", "1", "", Role::uncertainty, of_error<&ErrorRecord::reference_error>},
    {"error_max", "", "1", "", Role::error, of_error<&ErrorRecord::maximum>},
    {"growth", "", "1", "", Role::quantity, of_error<&ErrorRecord::growth>},
    {"energy_error", "energy error", "1", "", Role::error, of_error<&ErrorRecord::energy>,
     [](Run run) { return shown_statistic(run, &ErrorRecord::energy, &ErrorRecord::energy_spread); }},
    {"centre_error", "centre error", "1", "", Role::error, of_error<&ErrorRecord::centre>,
     [](Run run) { return shown_statistic(run, &ErrorRecord::centre, &ErrorRecord::centre_spread); }},
    {"amplitude", "", "1", "", Role::quantity, of_motion<&MotionErrorRecord::amplitude>},
    {"velocity_error_run", "", "1", "", Role::error, of_motion<&MotionErrorRecord::velocity>},
    {"energy_error_run", "", "1", "", Role::error, of_motion<&MotionErrorRecord::energy>},
    {"momentum_error_run", "", "1", "", Role::error, of_motion<&MotionErrorRecord::momentum>},
    {"angular_momentum_error_run", "", "1", "", Role::error, of_motion<&MotionErrorRecord::angular_momentum>},
    {"clearance", "clearance", "m", "", Role::quantity, of_contact<&ContactRecord::clearance>},
    {"energy_rise", "energy rise", "1", "", Role::quantity, of_contact<&ContactRecord::energy_rise>},
    {"contact_area", "contact area", "1", "", Role::quantity, of_contact<&ContactRecord::area>, shown_area},
    {"numerical_stiffness", "ν_h", "1", "", Role::quantity, field<&RunRecord::numerical_stiffness>},
    {"stiffness_to_damping", "h k/d", "1", "", Role::quantity, field<&RunRecord::stiffness_to_damping>},
    {"last_good_time", "", "s", "", Role::quantity, field<&RunRecord::last_good_time>},
    {"accuracy", "", "1", "", Role::quantity, of_choice<&ChoiceRecord::accuracy>},
    {"reason", "", "", "", Role::note, of_choice<&ChoiceRecord::reason>},
    {"set", "set", "", "", Role::key, field<&RunRecord::overrides>},
};

}  // namespace

Table to_table(std::span<const RunRecord> runs) { return make_table("runs", "one row for each run", run_columns, runs); }

}  // namespace drape::results
