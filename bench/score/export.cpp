#include "bench/score/export.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <sstream>

#include "model/obstacles/surface.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/file/motion_file.hpp"
#include "solver/base/printable.hpp"

namespace drape::bench {
namespace {

std::string obj(double t, const model::Polygons& polygons) {
  std::ostringstream out;
  fmt::print(out, "# t = {:g} s\n", t);
  model::write_obj(out, polygons);
  return out.str();
}

std::string reference_file(const TrueMotion& truth, std::span<const double> times) {
  results::ReferenceMotion reference{truth.scene.name, truth.families, {{times.begin(), times.end()}, {}, {}}, {}};
  for (const double t : times) {
    solver::State y = state_at(truth.motion, t);
    reference.motion.positions.push_back(std::move(y.x));
    reference.motion.velocities.push_back(std::move(y.v));
    reference.uncertainty.push_back(uncertainty_at(truth, t));
  }
  const std::vector<std::byte> bytes = results::to_bytes(reference);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};  // NOLINT
}

std::string readme(const TrueMotion& truth, std::span<const double> times) {
  return fmt::format(
      R"(The scene {0}, as a benchmark for simulators of cloth.

{1}.

scene.json    all of it, in SI units: particles, masses, coefficients, forces, pins, obstacles, the start, the times
              of the frames, the equations by their numbers in the thesis, and what to expect at every frame (energies,
              centre of mass, lowest point, largest stretch), each with what it is uncertain by
scene.toml    the same scene as bench_integrators reads it
start.obj     the mesh at t = 0; its vertices are the particles, in their order{2}{6}
reference.h5  the motion itself, as {3} have it: /time (F) [s],
              /positions (F x N x 3) [m], /velocities [m/s], /uncertainty (F) [m]: root mean square over the particles

The equations are those of: O. Etzmuss, Animation of Surfaces with Applications to Cloth Modelling, Tuebingen 2002.
z is up where there is gravity along -z. A simulator starts from start.obj with the velocities in scene.json, and writes
its positions at times of its choice, from t = 0 to at most {4:g} s, as an HDF5 file with /time, /positions and, if it can,
/velocities; or as a sequence of meshes (OBJ, PLY, VTK, VTU), one a frame. How far off it is, is measured by

    bench_integrators score --scene scene.toml motion.h5
    bench_integrators score --scene scene.toml --frame-time {5:g} frame-*.obj

The order of the vertices does not matter, nor do additional ones. With --cost SECONDS, what the simulator took on the
same machine, its cost is compared as well.
)",
      base::printable(truth.scene.name),
      truth.scene.description.empty() ? "It has no description" : base::printable(truth.scene.description),
      truth.scene.obstacles.empty()
          ? ""
          : "\nobstacle-k.obj  obstacle k of scene.json, where it is at t = 0; obstacle-k-n.obj at that of frame n, "
            "counted from 0,\n              where parts of it move or it deforms",
      truth.families, truth.scene.end, times[1],
      truth.scene.trim.given() ? "\ntrimmed.obj   the mesh that is drawn in its place, at t = 0" : "");
}

}  // namespace

std::map<std::string, std::string> exported(const TrueMotion& truth, std::span<const double> times) {
  const model::Scene& scene = truth.scene;
  std::map<std::string, std::string> files{
      {"scene.json", scene_json(truth, times)},
      {"scene.toml", model::to_toml(model::without_trim(scene))},
      {"start.obj", obj(0, model::sheet_polygons(scene.sheet.grid, truth.motion.states.front().x))},
      {"reference.h5", reference_file(truth, times)},
      {"README.txt", readme(truth, times)}};
  if (const auto trimmed = model::trimmed_surface(scene))
    files["trimmed.obj"] = obj(0, trimmed->at(truth.motion.states.front().x));
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k) {
    const model::PosedObstacle obstacle(scene.obstacles[k], 4 * model::size(scene));
    files[fmt::format("obstacle-{}.obj", k)] = obj(0, obstacle.at(0));
    if (!scene.obstacles[k].shape->moves()) continue;
    for (std::size_t n = 0; n < times.size(); ++n)
      files[fmt::format("obstacle-{}-{:04}.obj", k, n)] = obj(times[n], obstacle.at(times[n]));
  }
  return files;
}

}  // namespace drape::bench
