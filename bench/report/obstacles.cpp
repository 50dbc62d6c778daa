#include "bench/report/obstacles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/report/base64.hpp"
#include "model/adaptive/sheet_refinement.hpp"
#include "model/obstacles/contacts.hpp"
#include "model/obstacles/surface.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::bench {
namespace {

using Json = nlohmann::ordered_json;

/// A recorded scene with those of its obstacles that can still be read.
struct Readable {
  model::Scene scene;
  std::vector<std::string> missing;  ///< why not, of each of the others
};

/// The keys of a recorded scene.
struct SceneRows {
  std::vector<model::Override> rest, obstacles;
};

SceneRows scene_rows(const results::RunRecord& run) {
  SceneRows rows;
  for (const results::SceneValue& row : run.scene_keys)
    (row.key == "obstacles" ? rows.obstacles : rows.rest).push_back({row.key, row.value});
  return rows;
}

/// Obstacles are read one by one, as if each were the only one of its scene.
Readable read_obstacles(const results::RunRecord& run) {
  auto [rest, obstacles] = scene_rows(run);
  rest = model::without_trim(rest);
  Readable read{model::scene_of(rest, run.scene), {}};
  for (const model::Override& obstacle : obstacles) {
    std::vector<model::Override> rows = rest;
    rows.push_back(obstacle);
    try {
      read.scene.obstacles.push_back(model::scene_of(rows, run.scene).obstacles.front());
    } catch (const model::SceneError& error) {
      read.missing.emplace_back(error.what());
    }
  }
  return read;
}

/// Corners of triangles.
std::vector<int> triangles(const model::Polygons& polygons) {
  std::vector<int> corners;
  for (const auto& [a, b, c] : model::fan_triangles(polygons)) corners.insert(corners.end(), {a, b, c});
  return corners;
}

template <class Number>
std::string packed(const std::vector<Number>& numbers) {
  return base64(std::as_bytes(std::span(numbers)));
}

/// Vertices at each of the times, or once if it does not deform.
Json page_surface(const model::Polygons& polygons, const model::Obstacle& obstacle, std::span<const double> times,
                  bool smooth) {
  constexpr double any = 0;
  std::vector<float> places;
  for (const double t : obstacle.deforming() != nullptr ? times : std::span(&any, 1))
    for (const Eigen::Vector3d& vertex : vertices_at(obstacle, polygons, t))
      for (const double x : vertex) places.push_back(static_cast<float>(x));
  return {{"count", polygons.vertices.size()},
          {"vertices", packed(places)},
          {"triangles", packed(triangles(polygons))},
          {"smooth", smooth}};
}

std::size_t index_of(Json surface, Json& surfaces) {
  const auto at = std::ranges::find(surfaces, surface);
  const auto index = static_cast<std::size_t>(at - surfaces.begin());
  if (at == surfaces.end()) surfaces.push_back(std::move(surface));
  return index;
}

std::string packed_poses(const model::ObstacleRule& rule, const model::Obstacle& obstacle, const std::vector<double>& times) {
  std::vector<float> numbers;
  for (std::size_t k = 0; k < (moves(rule) ? times.size() : 1); ++k) {
    const model::Pose pose = obstacle.pose(times[k]);
    for (const double x : pose.position) numbers.push_back(static_cast<float>(x));
    for (const double q : pose.rotation.coeffs()) numbers.push_back(static_cast<float>(q));
  }
  return packed(numbers);
}

/// Least distance of a particle from an obstacle, frame by frame.
std::vector<double> clearances(const model::Contacts& contacts, const results::TrajectoryRecord& trajectory) {
  std::vector<double> least;
  for (std::size_t k = 0; k < trajectory.times.size(); ++k)
    least.push_back(contacts.distances(trajectory.times[k], trajectory.states[k].x).minCoeff());
  return least;
}

Json drawn_obstacles(const Readable& read, const results::TrajectoryRecord& trajectory, Json& surfaces) {
  Json drawn = Json::array();
  for (std::size_t k = 0; k < read.scene.obstacles.size(); ++k) {
    const model::ObstacleRule& rule = read.scene.obstacles[k];
    const double plane_side = 4 * model::size(read.scene);
    const auto draw = [&](const model::Polygons& surface, const model::Obstacle& obstacle) {
      drawn.push_back({{"surface", index_of(page_surface(surface, obstacle, trajectory.times, rule.kind->smooth), surfaces)},
                       {"poses", packed_poses(rule, obstacle, trajectory.times)}});
    };
    if (!rule.shape->moves()) {
      draw(rule.shape->surface(plane_side), model::Obstacle(rule));
      continue;
    }
    const std::vector<model::Obstacle> parts = parts_of(rule);
    for (std::size_t part = 0; part < parts.size(); ++part) draw(rule.shape->surface_of_part(part, plane_side), parts[part]);
  }
  return drawn;
}

/// All of a recorded scene that says what its cloth looks like.
model::Scene read_cloth(const results::RunRecord& run) { return model::scene_of(scene_rows(run).rest, run.scene); }

}  // namespace

Json page_trim(const results::RunRecord& run) try {
  const std::optional<model::TrimmedSurface> surface = model::trimmed_surface(read_cloth(run));
  if (!surface) return nullptr;
  std::vector<int> particles;
  std::vector<float> weights;
  for (const model::TrimmedSurface::Vertex& vertex : surface->vertices())
    for (int k = 0; k < 3; ++k) {
      particles.push_back(vertex.particles[k]);
      weights.push_back(static_cast<float>(vertex.weights[k]));
    }
  return {{"particles", packed(particles)},
          {"weights", packed(weights)},
          {"triangles", packed(triangles(surface->at(run.trajectory->states.front().x)))}};
} catch (const std::exception& error) {  // its file is gone, or the record is of a program whose scenes were others
  return {{"missing", error.what()}};
}

Json page_refined(const results::RunRecord& run) try {
  const Readable read = read_obstacles(run);
  if (!read.scene.contact.adaptive || !read.missing.empty()) return nullptr;
  model::SheetRefinement refinement(model::Garment(read.scene), read.scene.obstacles);
  const results::TrajectoryRecord& trajectory = *run.trajectory;
  Json frames = Json::array();
  for (std::size_t k = 0; k < trajectory.times.size(); ++k) {
    const solver::Vectors& x = trajectory.states[k].x;
    const model::Polygons refined = refinement.polygons(trajectory.times[k], x);
    std::vector<float> places;
    std::vector<int> nearest;
    for (const Eigen::Vector3d& vertex : std::span(refined.vertices).subspan(static_cast<std::size_t>(x.rows()))) {
      for (const double c : vertex) places.push_back(static_cast<float>(c));
      Eigen::Index node = 0;
      (x.rowwise() - vertex.transpose()).rowwise().squaredNorm().minCoeff(&node);
      nearest.push_back(static_cast<int>(node));
    }
    frames.push_back({{"vertices", packed(places)}, {"nearest", packed(nearest)}, {"triangles", packed(triangles(refined))}});
  }
  return frames;
} catch (const std::exception&) {  // the record is of a program whose scenes were others, as its obstacles say
  return nullptr;
}

Json page_obstacles(const results::RunRecord& run, Json& surfaces) {
  try {
    const Readable read = read_obstacles(run);
    Json page{{"drawn", drawn_obstacles(read, *run.trajectory, surfaces)}, {"missing", read.missing}};
    if (!read.missing.empty() || read.scene.obstacles.empty()) return page;
    solver::Counters work;
    page["clearance"] = clearances(model::contacts(read.scene, work), *run.trajectory);
    page["distance"] = read.scene.contact.distance;
    return page;
  } catch (const std::exception& error) {  // the record is of a program whose scenes were others
    return {{"drawn", Json::array()}, {"missing", {error.what()}}};
  }
}

}  // namespace drape::bench
