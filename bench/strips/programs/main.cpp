// One huge sheet in strips, a process each: mpirun -n PROCESSES bench_strips FOLDER, with problem.json in the folder.

#include <HYPRE_config.h>
#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/strips/programs/cvode.hpp"
#include "bench/strips/programs/pfmg.hpp"
#include "bench/strips/programs/processes.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/process.hpp"
#include "solver/integrator.hpp"

namespace drape::bench::strips {
namespace {

/// Times and traffic of steps.
class StepClock {
 public:
  void start() { begin_ = Clock::now(), sent_ = traffic(); }

  void stop() {
    const Traffic step = traffic() - sent_;
    (seconds_.empty() ? first_ : later_) += step;
    seconds_.push_back(std::chrono::duration<double>(Clock::now() - begin_).count());
    start();
  }

  const std::vector<double>& seconds() const { return seconds_; }
  Traffic first() const { return first_; }
  Traffic later() const { return later_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_;
  Traffic sent_, first_, later_;
  std::vector<double> seconds_;
};

solver::State run_method(const Strip& strip, const Problem& problem, const std::function<void()>& between) {
  const solver::LinearSolver linear_solver = pfmg(strip);
  solver::Options options;
  options.stage = &solver::stage_kind(problem.stage_solver);
  options.linear_solver = &linear_solver;
  solver::Integrator integrator(strip.ode(), solver::method(problem.method), options, strip.start(), strip.begin());
  for (int k = 0; k < problem.steps; ++k) {
    const solver::StageResult result = integrator.step(problem.step);
    if (result.outcome != solver::Outcome::success)
      throw std::runtime_error(fmt::format("{}: step {}: {}", problem.method, k + 1, to_string(result.outcome)));
    between();
  }
  return integrator.state();
}

Rank rank_of(const double* numbers) {
  const auto whole = [&](int k) { return static_cast<std::int64_t>(numbers[k]); };
  return {static_cast<int>(whole(0)), {whole(1), whole(2), whole(3)}, {whole(4), whole(5), whole(6)}, numbers[7]};
}

/// The same for all processes.
Solved solved(const Strip& strip, const StepClock& clock) {
  Solved all;
  all.libraries = fmt::format("hypre {}", HYPRE_RELEASE_VERSION);
  for (const auto& kind : strip.ode().work->kinds())
    if (kind.count != 0) all.work[kind.name] = kind.count;
  const Traffic first = clock.first(), later = clock.later();
  const std::array<double, 8> numbers{static_cast<double>(strip.share().lines), static_cast<double>(first.messages),
                                      static_cast<double>(first.bytes),         static_cast<double>(first.reductions),
                                      static_cast<double>(later.messages),      static_cast<double>(later.bytes),
                                      static_cast<double>(later.reductions),    base::peak_memory()};
  const std::vector<double> ranks = Processes::gathered(numbers), seconds = Processes::gathered(clock.seconds());
  for (std::size_t k = 0; k < ranks.size(); k += numbers.size()) all.ranks.push_back(rank_of(&ranks[k]));
  all.seconds.assign(clock.seconds().size(), 0);
  for (std::size_t k = 0; k < seconds.size(); ++k) {
    double& slowest = all.seconds[k % all.seconds.size()];
    slowest = std::max(slowest, seconds[k]);
  }
  return all;
}

/// Every process writes what is its own, at its place.
void write_state(const Strip& strip, const solver::State& y, const std::string& path) {
  MPI_File file = nullptr;
  MPI_File_open(MPI_COMM_WORLD, path.c_str(), MPI_MODE_CREATE | MPI_MODE_WRONLY, MPI_INFO_NULL, &file);
  const MPI_Offset row = 3 * sizeof(double), all = row * strip.columns() * strip.lines();
  const MPI_Offset first = row * strip.columns() * strip.share().first;
  const auto write = [&](const solver::Vectors& field, MPI_Offset begin) {
    MPI_File_write_at_all(file, begin + first, field.data() + 3 * strip.first_row(), static_cast<int>(3 * strip.rows()),
                          MPI_DOUBLE, MPI_STATUS_IGNORE);
  };
  write(y.x, 0);
  write(y.v, all);
  MPI_File_close(&file);
}

Problem read_problem(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw std::invalid_argument(path + ": cannot be read");
  try {
    return nlohmann::json::parse(in).get<Problem>();
  } catch (const nlohmann::json::exception& error) {
    throw std::invalid_argument(fmt::format("{}: {}", path, error.what()));
  }
}

void solve(const std::string& folder) {
  const Problem problem = read_problem(folder + "/problem.json");
  const model::Scene scene = model::parse_scene(problem.scene, "problem.json");
  check(problem, scene);
  const Strip strip(scene, problem.lines);
  StepClock clock;
  MPI_Barrier(MPI_COMM_WORLD);
  clock.start();
  const auto between = [&] { clock.stop(); };
  const solver::State end =
      is_of_sundials(problem.method) ? run_cvode(strip, problem, between) : run_method(strip, problem, between);
  const Solved all = solved(strip, clock);
  if (problem.writes_state) write_state(strip, end, folder + "/" + state_file);
  if (Processes::rank() == 0) std::ofstream(folder + "/solved.json") << nlohmann::json(all);
}

/// What is wrong with the input is so for all processes: one says it. What fails in one ends all.
int run(int argc, char** argv) {
  const Processes processes(&argc, &argv);
  const auto say = [](const std::exception& error) { fmt::print(stderr, "bench_strips: {}\n", error.what()); };
  try {
    if (argc != 2) throw std::invalid_argument("expected one argument, a folder with problem.json");
    solve(argv[1]);
    return 0;
  } catch (const std::invalid_argument& error) {
    if (Processes::rank() == 0) say(error);
    return 2;
  } catch (const model::SceneError& error) {
    if (Processes::rank() == 0) say(error);
    return 2;
  } catch (const std::exception& error) {
    say(error);
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  return 1;
}

}  // namespace
}  // namespace drape::bench::strips

int main(int argc, char** argv) { return drape::bench::strips::run(argc, argv); }
