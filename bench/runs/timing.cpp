#include "bench/runs/timing.hpp"

#include <benchmark/benchmark.h>

#include <string>

#include "bench/runs/interruption.hpp"

namespace drape::bench {
namespace {

/// Collects the times of single repetitions; the name of a benchmark is its place in the group.
class Collector : public benchmark::BenchmarkReporter {
 public:
  Collector(std::vector<std::vector<double>>& times, TimeOf time_of) : times_(times), time_of_(time_of) {}

  bool ReportContext(const Context&) override { return true; }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Iteration)
        times_[std::stoul(run.run_name.function_name)].push_back(
            1e3 * (time_of_ == TimeOf::wall ? run.real_accumulated_time : run.cpu_accumulated_time));
  }

 private:
  std::vector<std::vector<double>>& times_;
  TimeOf time_of_;
};

/// `steps`: how many the last repetition took.
Prepare prepared(const RunSpec& spec, std::size_t most_steps, std::size_t& steps) {
  return [&spec, most_steps, &steps] {
    return [&spec, most_steps, &steps, cloth = model::compile(spec.scene)] {
      steps = static_cast<std::size_t>(run(spec, cloth, {}, {.steps = most_steps}).result.steps);
    };
  };
}

void interleave_repetitions() {
  static const bool initialized = [] {
    char program[] = "bench_integrators", flag[] = "--benchmark_enable_random_interleaving=true";
    char* arguments[] = {program, flag, nullptr};
    int count = 2;
    benchmark::Initialize(&count, arguments);
    return true;
  }();
  (void)initialized;
}

}  // namespace

std::vector<std::vector<double>> time_runs(const std::vector<Repeated>& runs, const std::function<void()>& done,
                                           TimeOf time_of) {
  if (runs.empty()) return {};
  interleave_repetitions();
  std::vector<std::vector<double>> times(runs.size());
  benchmark::ClearRegisteredBenchmarks();
  for (std::size_t k = 0; k < runs.size(); ++k)
    benchmark::RegisterBenchmark(std::to_string(k).c_str(),
                                 [&prepare = runs[k].prepare, &done](benchmark::State& state) {
                                   check_interruption();
                                   const std::function<void()> run = prepare();
                                   for (auto _ : state) run();
                                   done();
                                 })
        ->Iterations(1)
        ->Repetitions(runs[k].repetitions)
        ->MeasureProcessCPUTime()
        ->UseRealTime();
  Collector collector(times, time_of);
  benchmark::RunSpecifiedBenchmarks(&collector);
  return times;
}

std::size_t steps_to_time(const results::RunRecord& run) {
  switch (run.outcome) {
    case solver::Outcome::success:
    case solver::Outcome::out_of_time:
    case solver::Outcome::out_of_memory:
    case solver::Outcome::out_of_evaluations: return run.steps.size();
    case solver::Outcome::unstable: return run.steps.size() + 1;  // the step at which the energy guard ended it
    case solver::Outcome::not_converged:
    case solver::Outcome::breakdown:
    case solver::Outcome::not_finite:
    case solver::Outcome::inaccurate:
    case solver::Outcome::failed: break;
  }
  return Limits().steps;  // it ends by itself, in a step whose work is counted
}

std::vector<std::vector<double>> time_group(const Group& group, const std::vector<std::size_t>& most_steps, int repetitions,
                                            const std::function<void()>& done, std::vector<std::size_t>* steps) {
  std::vector<Repeated> runs;
  std::vector<std::size_t> taken(group.size());
  for (std::size_t k = 0; k < group.size(); ++k) runs.push_back({prepared(group[k], most_steps.at(k), taken[k]), repetitions});
  auto times = time_runs(runs, done);
  if (steps != nullptr) *steps = std::move(taken);
  return times;
}

}  // namespace drape::bench
