#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bench/runs/contact_observer.hpp"
#include "bench/runs/record.hpp"
#include "bench/runs/timing.hpp"
#include "bench/studies/step_means.hpp"
#include "bench/studies/studies.hpp"
#include "model/collision/body_faces.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"
#include "solver/base/statistics.hpp"

namespace drape::bench {
namespace {

constexpr double box_step = 0.01;  ///< [s]
constexpr std::size_t window = 5;  ///< steps of which users see the mean
constexpr double most_time = 1.3;

model::Scene swing(bool quick) {
  std::vector<model::Override> overrides;
  if (quick) overrides = {{"grid.n", "8"}};
  return model::load_scene("box_swing", overrides);
}

RunSpec spec(const model::Scene& scene, std::string_view method) {
  return {scene, "", &solver::method(method), box_step, solver::thesis_options()};
}

using results::field;
using results::Role;
using results::RunRecord;
using results::Standing;
using results::StepRecord;

/// A run against the box. The method is named alone: all runs have the thesis' solvers.
struct BoxRun {
  std::string method;
  RunRecord run;
  std::vector<int> face_pairs;  ///< of cloth and box that are near at the ends of the steps
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BoxRun, method, run, face_pairs)

/// Counts the pairs of faces of the sheet and of obstacles that are near at the end of each step, as in_contact() has it of
/// particles.
class FacePairs : public Observer {
 public:
  void begin(const model::Scene& scene, const model::Cloth& cloth, const solver::State& /*start*/) override {
    constexpr double no_plane = 0;
    surface_.emplace(*cloth.garment);
    for (const model::ObstacleRule& rule : scene.obstacles) bodies_.emplace_back(rule, no_plane);
    distance_ = contact_reach * scene.contact.distance;
  }
  void observe(const solver::StepReport& step) override {
    counts_.push_back(model::face_pairs(*surface_, bodies_, step.t, step.y.x, distance_));
  }
  const std::vector<int>& counts() const { return counts_; }

 private:
  std::optional<model::ClothSurface> surface_;
  std::vector<model::PosedObstacle> bodies_;
  double distance_ = 0;  ///< [m]
  std::vector<int> counts_;
};

BoxRun swing_run(const RunSpec& run) {
  FacePairs pairs;
  Observer* const observers[] = {&pairs};
  RunRecord recorded = record(run, observers);
  return {std::string(run.method->name), std::move(recorded), pairs.counts()};
}

/// Means of a run over some of its steps.
struct Means {
  double updates, cg_iterations, contacts, face_pairs;
};

/// Steps of the same time; of each run that lasts so long, its means.
struct Window {
  double until;  ///< end of the last step [s]
  std::vector<std::optional<Means>> runs;
};

constexpr results::ColumnOf<Window> time_column[] = {
    {"t", "until", "s", "end of the last of these steps", Role::key, field<&Window::until>},
};
constexpr results::ColumnOf<Means> curves[] = {
    {"{}_updates", "{}: updates", "1", "updates a step", Role::counter, field<&Means::updates>},
    {"{}_CG", "{}: CG", "1", "CG iterations a step", Role::counter, field<&Means::cg_iterations>},
    {"{}_contacts", "{}: contacts", "1", "particles in contact", Role::quantity, field<&Means::contacts>},
    {"{}_face_pairs", "{}: face pairs", "1", "pairs of faces of sheet and box that are near", Role::quantity,
     field<&Means::face_pairs>},
};

/// The means of `length` steps from one on, if the run has them.
std::optional<Means> means(const BoxRun& box, std::size_t first, std::size_t length) {
  if (first + length > box.run.steps.size()) return std::nullopt;
  const Steps steps = Steps(box.run.steps).subspan(first, length);
  const auto pairs = std::span(box.face_pairs).subspan(first, length);
  return Means{mean(steps, &StepRecord::updates), iterations(steps), mean(steps, &StepRecord::contacts),
               std::accumulate(pairs.begin(), pairs.end(), 0.0) / static_cast<double>(length)};
}

std::vector<Window> windows(const std::vector<BoxRun>& runs, std::size_t length) {
  std::size_t steps = 0;
  for (const BoxRun& box : runs) steps = std::max(steps, box.run.steps.size());
  std::vector<Window> all;
  for (std::size_t first = 0; first + length <= steps; first += length) {
    Window& next = all.emplace_back(Window{box_step * static_cast<double>(first + length), {}});
    for (const BoxRun& box : runs) next.runs.push_back(means(box, first, length));
  }
  return all;
}

/// Means of `length` steps a row. Single ones are for the file.
results::Table over_time(const char* name, const char* title, const std::vector<BoxRun>& runs, std::size_t length) {
  const std::vector<Window> rows = windows(runs, length);
  results::Table table = results::make_table(name, title, time_column, rows);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const std::string& method = runs[k].method;
    results::add_columns(table, curves, rows, [&](const Window& row) -> const auto& { return row.runs[k]; },
                         {method, method, ""});
  }
  table.for_file = length == 1;
  draw(table, results::Figure::over_time, {{results::Part::x, "t"}});
  for (results::Column& column : table.columns)
    if (!column.group.empty()) column.part = results::Part::y;
  return table;
}

/// A measured ratio beside what it may be at most.
struct Ratio {
  std::string method, what;
  double value, most;
  std::optional<double> motion;  ///< kinetic energy at the end over the largest one
  results::Verdict verdict;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Ratio, method, what, value, most, motion, verdict)

constexpr results::ColumnOf<Ratio> ratio_columns[] = {
    {"method", "method", "", "time integrator", Role::key, field<&Ratio::method>},
    {"ratio", "ratio", "", "of what", Role::key, field<&Ratio::what>},
    {"value", "value", "1", "measured", Role::time, field<&Ratio::value>},  // two of three are ratios of times
    {"bar", "bar", "1", "what it may be at most", Role::quantity, field<&Ratio::most>},
    {"motion", "motion", "1", "kinetic energy at the end over the largest one: whether it rests", Role::quantity,
     field<&Ratio::motion>},
    {"verdict", "verdict", "", "whether it keeps below the bar", Role::verdict, field<&Ratio::verdict>},
};

results::Verdict contact_verdict(const RunRecord& run, double value, double most) {
  if (!run.succeeded()) return {Standing::open, std::string(to_string(run.outcome))};
  const bool touched = before_contact(run).size() < run.steps.size();
  if (!touched) return results::Verdict{Standing::open, "no contact"};
  return results::check(value <= most, "below", "not below");
}

Ratio ratio(std::string_view method, const RunRecord& run, const char* what, double value, double most) {
  std::optional<double> motion;
  if (!run.steps.empty())
    motion = run.steps.back().kinetic_energy / std::ranges::max(run.steps, {}, &StepRecord::kinetic_energy).kinetic_energy;
  return {std::string(method), what, value, most, motion, contact_verdict(run, value, most)};
}

/// All ratios of a method, from its runs with and without box, whose repetitions are interleaved.
std::vector<Ratio> ratios(const Group& group, int repetitions) {
  const RunRecord with = record(group[0]), without = record(group[1]);
  const auto times = time_group(group, {steps_to_time(with), steps_to_time(without)}, repetitions, [] {});
  const double time = base::quantile(times[0], 0.5) / base::quantile(times[1], 0.5);
  const std::string_view method = group[0].method->name;
  return {ratio(method, with, "CG iterations a step, at rest over before the first contact", iterations_at_rest(with),
                most_iterations_at_rest),
          ratio(method, with, "time, with over without box", time, most_time),
          ratio(method, with, "time a CG iteration, with over without box",
                time * iterations(without.steps) / iterations(with.steps), most_time)};
}

std::vector<Ratio> contact_costs(bool quick, Checkpoint& checkpoint) {
  std::vector<Ratio> rows;
  const model::Scene scene = swing(quick);
  model::Scene without_box = scene;
  without_box.obstacles.clear();
  checkpoint.each(solver::thesis_methods(), [&](const solver::Method& method) {
    if (!method.implicit()) return;
    checkpoint.show(fmt::format("cost of contact, {}", method.name));
    const Group group{spec(scene, method.name), spec(without_box, method.name)};
    std::ranges::move(checkpoint.timed(std::string(method.name), [&] { return ratios(group, quick ? 1 : 5); }),
                      std::back_inserter(rows));
    checkpoint.advance();
  });
  return rows;
}

results::Table contact_costs_table(const std::vector<Ratio>& rows) {
  return results::make_table("figure-4.3-bars", "Figure 4.3: what contact costs; the sheet swings with and without the box",
                             ratio_columns, rows);
}

}  // namespace

std::vector<Job> figure_4_3(const Question& question) {
  const bool quick = question.quick;
  const auto implicit = std::ranges::count_if(solver::thesis_methods(), [](const solver::Method& m) { return m.implicit(); });
  const auto swing_runs = [=](Checkpoint& checkpoint) {
    std::vector<BoxRun> runs;
    checkpoint.each(std::array{"bdf2", "sbdf2"}, [&](const char* method) {
      checkpoint.show(fmt::format("{} against the box", method));
      runs.push_back(checkpoint.once(method, [&] { return swing_run(spec(swing(quick), method)); }));
      checkpoint.advance();
    });
    return runs;
  };
  const auto present = [](const std::vector<BoxRun>& runs) {
    return std::vector{over_time("figure-4.3", "Figure 4.3: a sheet swings against a box; means over five steps", runs, window),
                       over_time("figure-4.3-steps", "Figure 4.3: every step (in the file)", runs, 1)};
  };
  return {job("figure-4.3", 2, swing_runs, present),
          job(
              "figure-4.3-bars", static_cast<int>(implicit),
              [=](Checkpoint& checkpoint) { return contact_costs(quick, checkpoint); }, contact_costs_table)};
}

}  // namespace drape::bench
