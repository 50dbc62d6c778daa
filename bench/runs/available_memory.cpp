#include "bench/runs/available_memory.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include "model/garment.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::bench {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The number after a word at the beginning of a line of a file; unlimited if there is none.
double number_after(const char* file, const std::string& word) {
  std::ifstream stream(file);
  for (std::string name; stream >> name; stream.ignore(std::numeric_limits<std::streamsize>::max(), '\n'))
    if (double value = 0; name == word && stream >> value) return value;
  return unlimited;
}

/// What the control group leaves [bytes]: pages of files count as held there, but can be dropped.
double of_control_group() {
  double most = 0, held = 0;
  if (!(std::ifstream("/sys/fs/cgroup/memory.max") >> most) || !(std::ifstream("/sys/fs/cgroup/memory.current") >> held))
    return unlimited;  // there is none, or it has the word max
  const double files = number_after("/sys/fs/cgroup/memory.stat", "file");
  return most - held + (files == unlimited ? 0 : files);
}

double of_limit(__rlimit_resource resource, const char* held) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  const double taken = number_after("/proc/self/status", held);
  return static_cast<double>(limit.rlim_cur) - (taken == unlimited ? 0 : 1024 * taken);
}

}  // namespace

double available_memory() {
  return std::max(0.0, std::min({1024 * number_after("/proc/meminfo", "MemAvailable:"), of_control_group(),
                                 of_limit(RLIMIT_AS, "VmSize:"), of_limit(RLIMIT_DATA, "VmData:")}));
}

void require_memory(const model::Scene& scene) {
  constexpr double bytes_per_particle = 1000;  // measured: the least that any method takes, without a reference
  const double particles = model::Garment(scene).particles(), available = available_memory();
  if (particles * bytes_per_particle > available)
    throw model::SceneError(fmt::format(
        "{}: {}: {:g} particles need at least {:.3g} GB, {:.3g} GB are available: expected at most {:.0f}", scene.name,
        scene.panels.empty() ? fmt::format("grid.n = [{}, {}]", scene.sheet.grid.nu, scene.sheet.grid.nv) : "panels", particles,
        particles * bytes_per_particle / 1e9, available / 1e9, available / bytes_per_particle));
}

}  // namespace drape::bench
