#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/runs/checkpoint_json.hpp"
#include "bench/runs/record.hpp"
#include "bench/studies/contact/contact_watch.hpp"
#include "bench/studies/draping.hpp"
#include "bench/studies/step_means.hpp"
#include "bench/studies/studies.hpp"
#include "model/obstacles/mesh_shape.hpp"
#include "model/obstacles/obstacle_at_time.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/columns.hpp"
#include "solver/base/statistics.hpp"
#include "solver/base/stopwatch.hpp"

namespace drape::bench {
namespace {

using results::ColumnOf;
using results::Datum;
using results::field;
using results::Role;

constexpr double detection_step = 0.01;  // [s]
constexpr std::string_view detection_scenes[] = {"round_table_100", "square_table_400", "ball_100"};

/// What keeps cloth out of obstacles between particles, with the distance at which it does [m]: faces as coarse as those of
/// these scenes gain energy at corners that they meet within 1 mm.
struct Between {
  std::string_view name;
  bool adaptive, faces;
  std::string_view distance;
};
constexpr Between betweens[] = {{"virtual particles", true, false, "0.001"}, {"faces", false, true, "0.005"}};

/// A detection on a scene.
struct Detection {
  std::string scene, between, detection, outcome;
  double constrained = 0, found = 0, distances = 0, cg_iterations = 0;  ///< a step
  std::optional<double> penetration = {}, distance = {};                ///< [m]
  int inside = 0;
  std::optional<int> through = {};
  double time = 0, spread = 0;  ///< a step [µs]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Detection, scene, between, detection, outcome, constrained, found, distances, cg_iterations,
                                   penetration, distance, inside, through, time, spread)

constexpr ColumnOf<Detection> detection_columns[] = {
    {"scene", "scene", "", "built-in, implicit Euler, h = 0.01 s", Role::key, field<&Detection::scene>},
    {"between", "between particles", "", "what keeps cloth out of the obstacle between its particles", Role::key,
     field<&Detection::between>},
    {"detection", "detection", "", "contact.detection", Role::key, field<&Detection::detection>},
    {"found", "possible", "1", "contacts found a step, in the motion by half-spaces", Role::counter, field<&Detection::found>},
    {"distances", "distances", "1", "computed a step, from points to the obstacle, in that motion", Role::counter,
     field<&Detection::distances>},
    {"constrained", "constrained", "1", "particles, a step of its own motion", Role::counter, field<&Detection::constrained>},
    {"cg_iterations", "CG", "1", "iterations a step", Role::counter, field<&Detection::cg_iterations>},
    {"penetration", "penetration", "m", "of particles into the drawn mesh: the deepest at the end of a step", Role::quantity,
     field<&Detection::penetration>},
    {"inside", "inside", "1", "frames with a particle inside the drawn mesh", Role::counter, field<&Detection::inside>},
    {"through", "through", "1", "frames in which a face of the sheet intersects the drawn mesh, by exact predicates",
     Role::counter, field<&Detection::through>},
    {"distance", "distance", "m", "of particles from those of the motion by half-spaces at the end, root mean square",
     Role::quantity, field<&Detection::distance>},
    {"time", "time", "µs", "to find the contacts of a step of that motion, median of interleaved repetitions", Role::time,
     field<&Detection::time>},
    {"spread", "±", "µs", "half their range", Role::time, field<&Detection::spread>},
    {"outcome", "outcome", "", "how the run ended", Role::outcome, field<&Detection::outcome>},
};

model::Scene detection_scene(std::string_view name, const Between& between, std::string_view detection, bool quick) {
  std::vector<model::Override> changes{{"contact.adaptive", between.adaptive ? "true" : "false"},
                                       {"contact.faces", between.faces ? "true" : "false"},
                                       {"contact.distance", std::string(between.distance)},
                                       {"contact.detection", std::string(detection)}};
  if (quick) changes.push_back({"end.time", "0.2"});
  return model::load_scene(std::string(name), changes);
}

/// The motion of a run: the start and the ends of its steps.
struct Motion {
  std::vector<double> times;  ///< [s]
  std::vector<solver::State> states;
};

/// Distance of the nearest particle from the drawn obstacles [m], negative inside.
double clearance_of(std::vector<model::ObstacleAtTime>& meshes, double t, const solver::Vectors& x) {
  double least = std::numeric_limits<double>::infinity();
  for (model::ObstacleAtTime& mesh : meshes) {
    mesh.set_time(t);
    for (const auto& row : x.rowwise()) least = std::min(least, mesh.nearest(row).distance);
  }
  return least;
}

/// Runs a scene; sets all of a row that is known without the other detection.
Motion detect(const model::Scene& scene, Detection& row) {
  Motion motion;
  FunctionObserver moments([&](const solver::StepReport& step) {
    motion.times.push_back(step.t);
    motion.states.push_back(step.y);
  });
  ContactWatch watch;
  Observer* const observers[] = {&moments, &watch};
  const results::RunRecord run = record({scene, "", &solver::method("implicit-euler"), detection_step, {}}, observers);
  row.outcome = ending(run.outcome, run.last_good_time);
  row.constrained = mean(run.steps, &results::StepRecord::contacts);
  row.cg_iterations = iterations(run.steps);
  if (scene.contact.faces) row.through = watch.findings().through_bodies;
  std::vector<model::ObstacleAtTime> meshes;
  for (const model::ObstacleRule& rule : scene.obstacles)
    for (const model::Obstacle& part : model::mesh_parts_of(rule)) meshes.emplace_back(part, 0);
  double deepest = 0;
  for (std::size_t k = 0; k < motion.times.size(); ++k) {
    const double clearance = clearance_of(meshes, motion.times[k], motion.states[k].x);
    deepest = std::max(deepest, -clearance);
    row.inside += clearance < 0 ? 1 : 0;
  }
  row.penetration = deepest;
  return motion;
}

/// Finds the contacts of all steps of a motion. Returns the time of a step [µs].
double find_again(const model::Scene& scene, const Motion& motion, Detection& row) {
  solver::Counters work;
  model::Contacts contacts = model::contacts(scene, work);
  std::vector<solver::Contact> found;
  double milliseconds = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < motion.times.size(); ++k) {
    found.clear();
    {
      const base::Stopwatch stopwatch(&milliseconds);
      contacts.find(motion.times[k], detection_step, motion.states[k], found);
    }
    count += found.size();
  }
  const auto steps = static_cast<double>(motion.times.size());
  row.found = static_cast<double>(count) / steps;
  row.distances = static_cast<double>(work.count("obstacle_queries")) / steps;
  return 1e3 * milliseconds / steps;
}

/// A row for each detection, the first being that of half-spaces.
std::vector<Detection> detections_on(std::string_view name, const Between& between, bool quick) {
  std::vector<Detection> rows;
  std::vector<model::Scene> scenes;
  std::vector<Motion> motions;
  for (const std::string_view detection : {"half-spaces", "ray"}) {
    scenes.push_back(detection_scene(name, between, detection, quick));
    Detection& row = rows.emplace_back();
    row.scene = name, row.between = between.name, row.detection = detection;
    motions.push_back(detect(scenes.back(), row));
  }
  std::vector<std::vector<double>> times(rows.size());
  for (int repetition = 0; repetition < (quick ? 1 : 15); ++repetition)
    for (std::size_t k = 0; k < rows.size(); ++k) times[k].push_back(find_again(scenes[k], motions.front(), rows[k]));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].time = base::quantile(times[k], 0.5);
    rows[k].spread = (base::quantile(times[k], 1) - base::quantile(times[k], 0)) / 2;
  }
  if (motions[0].times.size() == motions[1].times.size()) {
    const solver::Vectors apart = motions[1].states.back().x - motions[0].states.back().x;
    rows[1].distance = apart.norm() / std::sqrt(static_cast<double>(apart.rows()));
  }
  return rows;
}

}  // namespace

std::vector<Job> detection(const Question& question) {
  const bool quick = question.quick;
  const auto scenes = std::span(detection_scenes).first(quick ? 1 : std::size(detection_scenes));
  const int runs = static_cast<int>(scenes.size() * std::size(betweens));
  return {job(
      "detection", runs,
      [=](Checkpoint& checkpoint) {
        std::vector<Detection> rows;
        checkpoint.each(scenes, [&](const std::string_view scene) {
          checkpoint.each(betweens, [&](const Between& between) {
            const std::string id = fmt::format("{} with {}", scene, between.name);
            checkpoint.show(id);
            std::ranges::move(checkpoint.timed(id, [&] { return detections_on(scene, between, quick); }),
                              std::back_inserter(rows));
            checkpoint.advance();
          });
        });
        return rows;
      },
      [](const std::vector<Detection>& rows) {
        return results::make_table("detection", "Detection of collisions by half-spaces and by rays", detection_columns, rows);
      })};
}

}  // namespace drape::bench
