#include "bench/score/external_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "bench/score/observables.hpp"
#include "bench/score/true_motion.hpp"
#include "model/scene.hpp"
#include "model/sheet/edges.hpp"
#include "results/file/hdf5.hpp"
#include "solver/base/input_file.hpp"
#include "solver/base/process.hpp"
#include "solver/base/temporary.hpp"

namespace drape::bench {
namespace {

namespace fs = std::filesystem;
using solver::Vectors;

constexpr const char* interpreter = "/usr/bin/python3";  // Debian's own, which finds its packages
constexpr double most_seconds = 600;

/// What became of a script.
struct ScriptResult {
  bool success = false;
  std::string said;  ///< all that it has written; if it failed, why in one line
};

/// Runs a Python script, by its path in bench/.
ScriptResult run_script(std::string_view script, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{interpreter, fmt::format("{}/bench/{}", DRAPE_SOURCE_DIR, script)};
  words.insert(words.end(), arguments.begin(), arguments.end());
  try {
    const base::ChildSaid said = base::run_child(std::move(words), most_seconds);
    if (said.exit_code == 0) return {true, said.out + said.err};
    return {false, said.exit_code > 128 ? fmt::format("{} was {}", script, said.failure()) : said.failure()};
  } catch (const std::system_error& error) {
    return {false, error.what()};
  }
}

constexpr double matched_within = 0.01;  ///< of the shorter spacing

bool is_hdf5(const fs::path& file) { return file.extension() == ".h5" || file.extension() == ".hdf5"; }

void check_file(const std::string& file) {
  constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 30;
  try {
    base::require_input_file(file, most_bytes);
  } catch (const base::UnreadableFile& error) {
    throw std::invalid_argument(fmt::format("{}: {}: expected a file with another simulator's motion", file, error.what()));
  }
}

void check_choice(const std::vector<std::string>& files, std::optional<double> frame_time) {
  const bool hdf5 = std::ranges::any_of(files, is_hdf5);
  for (const std::string& file : files) check_file(file);
  if (hdf5 && files.size() > 1) throw std::invalid_argument("FILE: expected a single HDF5 file, or meshes only");
  if (hdf5 && frame_time) throw std::invalid_argument("--frame-time: an HDF5 file has its own times; expected meshes");
  if (!hdf5 && !frame_time) throw std::invalid_argument("mesh files need --frame-time, the time between frames in seconds");
}

std::string title(const std::vector<std::string>& files) {
  const std::string first = fs::path(files.front()).filename();
  return files.size() == 1 ? first : fmt::format("{} ... {}", first, fs::path(files.back()).filename().string());
}

results::Motion read(const std::vector<std::string>& files, std::optional<double> frame_time) {
  const base::TemporaryFolder folder;
  const fs::path plain = folder / "motion.h5";
  std::vector<std::string> arguments{plain, frame_time ? fmt::format("{}", *frame_time) : "none"};
  arguments.insert(arguments.end(), files.begin(), files.end());
  constexpr std::string_view script = "score/external_motion.py";
  const ScriptResult result = run_script(script, arguments);
  if (!result.success)
    throw std::invalid_argument(
        result.said.starts_with(script) ? fmt::format("{}: {}: it is damaged", title(files), result.said) : result.said);
  return results::read_motion(plain);
}

void check_times(const std::string& name, const std::vector<double>& times, double end) {
  if (times.size() < 2)
    throw std::invalid_argument(fmt::format("{}: expected at least two frames, not {}", name, times.size()));
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (!std::isfinite(times[k])) throw std::invalid_argument(fmt::format("{}: time of frame {}: expected a number", name, k));
    if (k > 0 && !(times[k] > times[k - 1]))
      throw std::invalid_argument(
          fmt::format("{}: frame {} at {:g} s: expected times that increase, the one before is at {:g} s", name, k, times[k],
                      times[k - 1]));
  }
  if (times.front() != 0)
    throw std::invalid_argument(
        fmt::format("{}: expected a first frame at 0 s, the scene's start, not {:g} s", name, times.front()));
  if (times.back() > end * (1 + 1e-9))
    throw std::invalid_argument(
        fmt::format("{}: frame {} at {:g} s: expected times up to the scene's end, {:g} s; move it by --set end.time=SECONDS",
                    name, times.size() - 1, times.back(), end));
}

void check_finite(const std::string& name, const char* what, const std::vector<Vectors>& frames) {
  for (std::size_t k = 0; k < frames.size(); ++k)
    if (!frames[k].allFinite()) throw std::invalid_argument(fmt::format("{}: frame {}: expected finite {}", name, k, what));
}

}  // namespace

std::vector<Eigen::Index> match(const Vectors& vertices, const Vectors& particles, const model::Grid& grid) {
  const auto [weft, warp] = shortest_edges(grid);
  const double within = matched_within * std::min(weft, warp);
  std::vector<Eigen::Index> by_x(static_cast<std::size_t>(vertices.rows())), matched;
  std::iota(by_x.begin(), by_x.end(), 0);
  const auto x_of = [&](Eigen::Index vertex) { return vertices(vertex, 0); };
  std::ranges::sort(by_x, {}, x_of);
  std::vector<bool> taken(by_x.size(), false);
  for (Eigen::Index i = 0; i < particles.rows(); ++i) {
    Eigen::Index nearest = -1;
    double least = within;
    for (auto at = std::ranges::lower_bound(by_x, particles(i, 0) - within, {}, x_of);
         at != by_x.end() && x_of(*at) <= particles(i, 0) + within; ++at) {
      const double distance = (vertices.row(*at) - particles.row(i)).norm();
      if (distance < least || (distance == least && nearest < 0)) least = distance, nearest = *at;
    }
    const auto place = [&] {
      return fmt::format("particle ({}, {}), which starts at ({:.6g}, {:.6g}, {:.6g}) m", i % grid.nu, i / grid.nu,
                         particles(i, 0), particles(i, 1), particles(i, 2));
    };
    if (nearest < 0)
      throw std::invalid_argument(
          fmt::format("the first frame is not the scene's start: no vertex within {:.2g} m of {}", within, place()));
    if (taken[static_cast<std::size_t>(nearest)])
      throw std::invalid_argument(fmt::format("vertex {} is nearest to two particles: one is {}", nearest, place()));
    taken[static_cast<std::size_t>(nearest)] = true;
    matched.push_back(nearest);
  }
  return matched;
}

ExternalMotion read_external_motion(const std::vector<std::string>& files, std::optional<double> frame_time,
                                    const model::Scene& scene) {
  require_describable(scene);
  check_choice(files, frame_time);
  const results::Motion motion = read(files, frame_time);
  ExternalMotion external{title(files), 0, motion.times, {}, motion.velocities.empty()};
  check_times(external.name, motion.times, scene.end);
  check_finite(external.name, "positions", motion.positions);
  check_finite(external.name, "velocities", motion.velocities);
  external.vertices = static_cast<int>(motion.positions.front().rows());
  std::vector<Eigen::Index> order;
  try {
    order = match(motion.positions.front(), model::start(scene).x, scene.sheet.grid);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", external.name, error.what()));
  }
  for (std::size_t k = 0; k < motion.times.size(); ++k) {
    solver::State y{motion.positions[k](order, Eigen::all), {}};
    if (!external.differenced) y.v = motion.velocities[k](order, Eigen::all);
    external.states.push_back(std::move(y));
  }
  if (external.differenced) difference(external.times, external.states);
  return external;
}

}  // namespace drape::bench
