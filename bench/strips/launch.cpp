#include "bench/strips/launch.hpp"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "bench/runs/child.hpp"
#include "solver/base/temporary.hpp"

namespace drape::bench::strips {
namespace {

namespace fs = std::filesystem;

const fs::path program = fs::path(DRAPE_PEERS) / "bench_strips";

/// More processes than cores are let in, and processes of root. Those that wait for a message let others compute: on a busy
/// machine they would else keep the sender from its core.
std::vector<std::string> command(int processes, const fs::path& folder) {
  return {"env",
          "OMPI_ALLOW_RUN_AS_ROOT=1",
          "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
          "OMPI_MCA_mpi_yield_when_idle=1",
          "OMPI_MCA_btl=self,vader",
          "OMPI_MCA_btl_vader_single_copy_mechanism=none",
          "mpirun",
          "--oversubscribe",
          "--bind-to",
          "none",
          "-n",
          std::to_string(processes),
          program,
          folder};
}

/// The line that the program has said, among those of mpirun.
std::string said_by_program(const std::string& text) {
  constexpr std::string_view name = "bench_strips: ";
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(name)) return line.substr(name.size());
  return text;
}

void run_program(int processes, const fs::path& folder, double limit) {
  const base::ChildSaid said = run_within<StripsError>(command(processes, folder), limit);
  if (said.exit_code != 0) throw StripsError(said_by_program(said.err));
}

solver::State read_state(const fs::path& path) {
  const auto particles = static_cast<Eigen::Index>(fs::file_size(path) / (6 * sizeof(double)));
  solver::State state{solver::Vectors(particles, 3), solver::Vectors(particles, 3)};
  std::ifstream file(path, std::ios::binary);
  for (solver::Vectors* field : {&state.x, &state.v})
    file.read(reinterpret_cast<char*>(field->data()), static_cast<std::streamsize>(3 * sizeof(double)) * particles);
  return state;
}

}  // namespace

std::string missing() {
  if (fs::exists(program)) return "";
  return "bench_strips is missing: install the Debian packages libopenmpi-dev and libhypre-dev (apt-get install libopenmpi-dev "
         "libhypre-dev), configure and build again";
}

StripsRun run_strips(const Problem& problem, int processes, double limit) {
  if (const std::string what = missing(); !what.empty()) throw std::invalid_argument(what);
  const base::TemporaryFolder folder;
  std::ofstream(folder / "problem.json") << nlohmann::json(problem);
  run_program(processes, folder.path(), limit);
  std::ifstream file(folder / "solved.json");
  StripsRun run{nlohmann::json::parse(file).get<Solved>(), {}};
  if (problem.writes_state) run.end = read_state(folder / state_file);
  return run;
}

}  // namespace drape::bench::strips
