#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/costs.hpp"
#include "bench/runs/timing.hpp"
#include "bench/studies/contact/contact_runs.hpp"
#include "bench/studies/contact/responses.hpp"
#include "bench/studies/draping.hpp"
#include "bench/studies/step_means.hpp"
#include "bench/studies/studies.hpp"
#include "model/phases.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"

namespace drape::bench {
namespace {

using results::ColumnOf;
using results::Datum;
using results::field;
using results::Role;
using results::RunRecord;
using results::Standing;
using results::StepRecord;
using results::Verdict;

constexpr double contact_steps[] = {0.04, 0.02, 0.01, 0.005, 0.0025};  // [s], of which the largest usable one is sought

constexpr const char* contact_scenes[] = {"stack",         "sphere_drop", "cloth_stack", "twist",
                                          "curtain_drawn", "box_swing",   "tablecloth",  "ball"};
constexpr const char* contact_methods[] = {"sbdf2", "verlet", "imex-euler", "implicit-euler", "bdf2", "midpoint"};

constexpr const char* self_contact_methods[] = {"sbdf2", "imex-euler"};
constexpr double slowest_dress = 2000;  // wall time a simulated second [ms/s]

/// A method on a scene.
struct ContactRun {
  std::string scene, method, outcome;
  double pairs = 0, contacts = 0;  ///< means
  int most_pairs = 0;
  std::int64_t systems = 0, changes = 0, cg_iterations = 0;
  std::optional<double> flight = {}, impact = {}, rest = {};  ///< CG iterations a step
  double motion = 0;
  ContactFindings found = {};
  std::optional<double> largest_step = {};  ///< [s]
  std::optional<results::ErrorRecord> error = {};
  double forces = 0, detection = 0, response = 0, others = 0, spread = 0;  ///< [ms/s]

  double time() const { return forces + detection + response + others; }
};

/// A value of the error, if the scene has a reference.
template <double results::ErrorRecord::*value>
Datum of_error(const ContactRun& row) {
  return row.error ? results::to_datum((*row.error).*value) : Datum();
}

constexpr ColumnOf<ContactRun> contact_columns[] = {
    {"scene", "scene", "", "built-in, or stack: three sheets that fall on each other", Role::key, field<&ContactRun::scene>},
    {"method", "method", "", "time integrator, h = 0.01 s, with the thesis' solvers", Role::key, field<&ContactRun::method>},
    {"pairs", "pairs", "1", "of the cloth with itself that are near, mean over steps", Role::quantity,
     field<&ContactRun::pairs>},
    {"most_pairs", "most", "1", "the most of them", Role::quantity, field<&ContactRun::most_pairs>},
    {"contacts", "contacts", "1", "particles constrained by obstacles, mean over steps", Role::quantity,
     field<&ContactRun::contacts>},
    {"systems", "systems", "1", "linear systems: updates of the stage solver, and those that contacts add", Role::counter,
     field<&ContactRun::systems>},
    {"changes", "changes", "1", "of what is constrained, obstacles' and pairs'", Role::counter, field<&ContactRun::changes>},
    {"cg_iterations", "CG", "1", "iterations of conjugate gradients", Role::counter, field<&ContactRun::cg_iterations>},
    {"flight", "flight", "1", "CG iterations a step before the first contact", Role::counter, field<&ContactRun::flight>},
    {"impact", "impact", "1", "CG iterations a step between flight and rest", Role::counter, field<&ContactRun::impact>},
    {"rest", "rest", "1", "CG iterations a step in the last 20, if the cloth rests then", Role::counter,
     field<&ContactRun::rest>},
    {"motion", "motion", "1", "kinetic energy at the end over the largest one: the cloth rests below 0.01", Role::quantity,
     field<&ContactRun::motion>},
    {"forces", "forces", "ms/s", "wall time a simulated second: forces, their parts and derivatives", Role::time,
     field<&ContactRun::forces>},
    {"detection", "detection", "ms/s", "of contacts and pairs", Role::time, field<&ContactRun::detection>},
    {"response", "response", "ms/s", "to contacts and pairs", Role::time, field<&ContactRun::response>},
    {"others", "others", "ms/s", "linear systems and what the method does besides", Role::time, field<&ContactRun::others>},
    {"spread", "±", "ms/s", "half the range of the sum in interleaved repetitions", Role::time, field<&ContactRun::spread>},
    {"energy_rise", "energy rise", "1", "largest rise of the total energy while pins rest, over the energies", Role::quantity,
     [](const ContactRun& row) { return results::to_datum(row.found.energy_rise); }},
    {"momentum", "momentum", "1", "what its balance with forces and impulses is off, over the impulse of forces",
     Role::quantity, [](const ContactRun& row) { return results::to_datum(row.found.momentum); }},
    {"least", "least", "1", "least distance of the cloth from itself over its thickness, if it comes near", Role::quantity,
     [](const ContactRun& row) { return results::to_datum(row.found.least); }},
    {"intersecting", "intersecting", "1", "frames in which cloth intersects itself, by exact predicates", Role::quantity,
     [](const ContactRun& row) { return results::to_datum(row.found.intersecting); }},
    {"through_bodies", "bodies", "1", "frames in which it intersects obstacles, by exact predicates", Role::quantity,
     [](const ContactRun& row) { return results::to_datum(row.found.through_bodies); }},
    {"largest_step", "largest h", "s",
     "of 0.04, 0.02, …, 0.0025: the run lasts to its end, cloth is never through itself or an obstacle", Role::quantity,
     field<&ContactRun::largest_step>},
    {"error", "error", "1", "of positions at the end over the size of the scene, where growth and ± ref allow to compare them",
     Role::quantity,
     [](const ContactRun& row) {
       return row.error && comparable(*row.error) ? of_error<&results::ErrorRecord::rms>(row) : Datum();
     }},
    {"uncertainty", "± ref", "1",
     "by which two responses disagree, and by which doubling their steps changes them, the largest", Role::quantity,
     of_error<&results::ErrorRecord::reference_error>},
    {"growth", "growth", "1", "of a small perturbation of the start: above 100, compare centres in place of positions",
     Role::quantity, of_error<&results::ErrorRecord::growth>},
    {"centre", "centre", "1", "distance of the centre of mass from the reference's, over the size of the scene", Role::quantity,
     of_error<&results::ErrorRecord::centre>},
    {"centre_spread", "± pert", "1", "the same of the perturbed motion", Role::quantity,
     of_error<&results::ErrorRecord::centre_spread>},
    {"outcome", "outcome", "", "how the run ended", Role::outcome, field<&ContactRun::outcome>},
};

ContactRun contact_row(const std::string& scene, std::string_view method, const WatchedRun& one) {
  const RunRecord& run = one.run;
  ContactRun row{scene, std::string(method), ending(run.outcome, run.last_good_time)};
  const ContactParts parts = parts_of(one);
  row.found = one.found;
  if (!run.steps.empty()) {
    const std::vector<int>& pairs = one.found.pairs;
    row.pairs = std::accumulate(pairs.begin(), pairs.end(), 0.0) / static_cast<double>(pairs.size());
    row.most_pairs = std::ranges::max(pairs);
    row.contacts = mean(run.steps, &StepRecord::contacts);
  }
  row.systems = work_count(run, "updates"), row.cg_iterations = work_count(run, "cg_iterations");
  row.changes = work_count(run, "contact_changes") + work_count(run, "pair_changes");
  row.flight = iterations_of(parts.flight), row.impact = iterations_of(parts.impact), row.rest = iterations_of(parts.rest);
  row.motion = motion_at_end(run.steps);
  return row;
}

// --- Verdicts ----------------------------------------------------------------------------------------------------------------

/// What a run comes to beside what it may be at most.
struct ContactVerdict {
  std::string scene, method, what;
  std::optional<double> value;
  double most;
  Verdict verdict;
};

constexpr ColumnOf<ContactVerdict> verdict_columns[] = {
    {"scene", "scene", "", "as above", Role::key, field<&ContactVerdict::scene>},
    {"method", "method", "", "time integrator", Role::key, field<&ContactVerdict::method>},
    {"what", "what", "", "is judged", Role::key, field<&ContactVerdict::what>},
    {"value", "value", "1", "measured", Role::quantity, field<&ContactVerdict::value>},
    {"bar", "bar", "1", "what it may be at most", Role::quantity, field<&ContactVerdict::most>},
    {"verdict", "verdict", "", "whether it is", Role::verdict, field<&ContactVerdict::verdict>},
};

ContactVerdict intersections_of(const ContactRun& row) {
  const int frames = intersections(row.found);
  Verdict verdict = results::check(frames == 0, "no intersection", "intersections");
  if (frames == 0 && row.outcome != "success") verdict = {Standing::open, row.outcome};
  return {row.scene, row.method, "frames in which cloth is through itself or an obstacle", frames, 0, verdict};
}

/// Resting against free flight, of a run in which there are both.
ContactVerdict resting_cost(const ContactRun& row) {
  ContactVerdict found{row.scene, row.method, "CG iterations a step, at rest over in flight", {}, most_iterations_at_rest, {}};
  const auto open = [&](std::string why) {
    found.verdict = {Standing::open, std::move(why)};
    return found;
  };
  if (row.outcome != "success") return open(row.outcome);
  if (!row.flight) return open("never free");
  if (!row.rest) return open("does not rest");
  if (*row.flight < 1) return open("flight needs no iterations");
  found.value = *row.rest / *row.flight;
  found.verdict = results::check(*found.value <= found.most, "below", "not below");
  return found;
}

ContactVerdict time_of_dress(const ContactRun& row) {
  ContactVerdict found{row.scene,         row.method,           "wall time of a simulated second [s]",
                       row.time() / 1000, slowest_dress / 1000, {Standing::open, row.outcome}};
  if (row.outcome == "success") found.verdict = results::check(*found.value <= found.most, "below", "not below");
  return found;
}

std::vector<ContactVerdict> judged(const std::vector<ContactRun>& rows) {
  std::vector<ContactVerdict> all;
  for (const ContactRun& row : rows) all.push_back(intersections_of(row));
  for (const ContactRun& row : rows)
    if (solver::method(row.method).implicit() && !is_garment(row.scene)) all.push_back(resting_cost(row));
  for (const ContactRun& row : rows)
    if (row.scene.ends_with("dress")) all.push_back(time_of_dress(row));
  return all;
}

// --- All scenes --------------------------------------------------------------------------------------------------------------

/// A step of a run at 0.01 s.
struct ContactMoment {
  std::string run;
  double t;  ///< [s]
  int pairs, contacts, cg_iterations;
};

constexpr ColumnOf<ContactMoment> contact_moment_columns[] = {
    {"run", "run", "", "scene and method", Role::key, field<&ContactMoment::run>},
    {"t", "t", "s", "end of the step", Role::key, field<&ContactMoment::t>},
    {"pairs", "pairs", "1", "of the cloth with itself that are near", Role::quantity, field<&ContactMoment::pairs>},
    {"contacts", "contacts", "1", "particles constrained by obstacles", Role::quantity, field<&ContactMoment::contacts>},
    {"cg_iterations", "CG", "1", "iterations of the step", Role::counter, field<&ContactMoment::cg_iterations>},
};

struct ContactStudy {
  std::vector<ContactRun> rows;
  std::vector<ContactMoment> moments;
};

/// Errors of runs of a scene. Scenes whose pins follow paths have no reference; those of garments are in their own study.
std::vector<std::optional<results::ErrorRecord>> contact_errors(const model::Scene& scene, std::span<const WatchedRun> runs) {
  std::vector<std::optional<results::ErrorRecord>> errors(runs.size());
  if (model::phases(scene).size() > 1 || is_garment(scene.name)) return errors;
  constexpr double agreement = 1;  // that of contacts is not asked for
  const model::Cloth cloth = model::compile(scene);
  const reference::Reference reference = References(agreement)(scene, cloth);
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (runs[k].run.succeeded()) errors[k] = distance(runs[k].run, reference, scene, cloth);
  return errors;
}

void study_contact(const std::string& name, std::span<const char* const> methods, bool quick, Checkpoint& checkpoint,
                   ContactStudy& study) {
  const model::Scene scene = contact_scene(name, quick);
  const auto kept = [&](std::string_view method, double h) {
    const std::string id = fmt::format("{} {} h = {}", name, method, h);
    return checkpoint.once(id, [&] {
      checkpoint.show(id);
      return watched(contact_spec(scene, method, h));
    });
  };
  std::vector<ContactRun> rows;
  std::vector<WatchedRun> usual_runs;
  Group group;
  std::vector<std::size_t> counts;
  checkpoint.each(methods, [&](const std::string_view method) {
    const WatchedRun& usual = usual_runs.emplace_back(kept(method, contact_step));
    ContactRun& row = rows.emplace_back(contact_row(name, method, usual));
    const auto largest = std::ranges::find_if(
        contact_steps, [&](double h) { return h == contact_step ? usual.usable() : kept(method, h).usable(); });
    if (largest != std::end(contact_steps)) row.largest_step = *largest;
    const std::vector<StepRecord>& steps = usual.run.steps;
    for (std::size_t k = 0; k < steps.size(); ++k)
      study.moments.push_back(
          {fmt::format("{}, {}", name, method), steps[k].t, usual.found.pairs[k], steps[k].contacts, steps[k].cg_iterations});
    group.push_back(contact_spec(scene, method));
    counts.push_back(std::max<std::size_t>(1, steps_to_time(usual.run)));
    checkpoint.advance();
  });
  checkpoint.show("reference of " + name);
  const auto errors = checkpoint.once("errors " + name, [&] { return contact_errors(scene, usual_runs); });
  checkpoint.show("timing " + name);
  const auto times = checkpoint.timed("times " + name, [&] {
    std::vector<std::array<double, 5>> found;
    for (const auto& [median, spread] : median_costs(group, counts, quick ? 1 : 3))
      found.push_back({median.forces, median.detection, median.response, median.rest, spread});
    return found;
  });
  for (std::size_t k = 0; k < rows.size(); ++k) {
    ContactRun& row = rows[k];
    row.forces = times[k][0], row.detection = times[k][1], row.response = times[k][2];
    row.others = times[k][3], row.spread = times[k][4];
    row.error = errors[k];
  }
  std::ranges::move(rows, std::back_inserter(study.rows));
}

std::vector<results::Table> present_contact(const ContactStudy& study) {
  results::Table moments =
      results::make_table("contact-steps", "Contact: every step (in the file)", contact_moment_columns, study.moments);
  moments.for_file = true;
  draw(moments, results::Figure::curves, {{results::Part::curve, "run"}, {results::Part::x, "t"}, {results::Part::y, "pairs"}});
  return {results::make_table("contact", "Contact of cloth with itself and with bodies", contact_columns, study.rows),
          results::make_table("contact-verdicts", "What contact is judged by", verdict_columns, judged(study.rows)),
          std::move(moments)};
}

}  // namespace

std::vector<Job> contact(const Question& question) {
  const bool quick = question.quick;
  const auto scenes = some_of(contact_scenes, quick, 1), methods = some_of(contact_methods, quick, 2);
  const auto garments = some_of(self_contact_garments, quick, 0), garment_methods = some_of(self_contact_methods, quick, 0);
  return {job(
              "contact", static_cast<int>(scenes.size() * methods.size() + garments.size() * garment_methods.size()),
              [=](Checkpoint& checkpoint) {
                ContactStudy study;
                const std::array groups{std::pair(scenes, methods), std::pair(garments, garment_methods)};
                checkpoint.each(groups, [&](const auto& group) {
                  checkpoint.each(group.first,
                                  [&](const char* name) { study_contact(name, group.second, quick, checkpoint, study); });
                });
                return study;
              },
              present_contact),
          compare_responses(quick)};
}

}  // namespace drape::bench
