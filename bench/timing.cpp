#include "bench/timing.hpp"

#include <benchmark/benchmark.h>

#include <optional>
#include <string>

namespace drape::bench {
namespace {

/// Collects the times of single repetitions; the name of a benchmark is its place in the group.
class Collector : public benchmark::BenchmarkReporter {
 public:
  explicit Collector(std::vector<std::vector<double>>& times) : times_(times) {}

  bool ReportContext(const Context&) override { return true; }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Iteration)
        times_[std::stoul(run.run_name.function_name)].push_back(1e3 * run.real_accumulated_time);
  }

 private:
  std::vector<std::vector<double>>& times_;
};

void solve(benchmark::State& state, const Cell& cell) {
  const model::Cloth cloth = model::compile(cell.scene);
  std::optional<solver::Integrator> integrator;
  for (auto _ : state) {
    integrator.emplace(cloth.ode, *cell.method, cell.options, cloth.start);
    integrate(*integrator, cell.scene.end, cell.step);
  }
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

std::vector<std::vector<double>> time_group(const Group& group, int repetitions, const std::function<void()>& done) {
  interleave_repetitions();
  std::vector<std::vector<double>> times(group.size());
  benchmark::ClearRegisteredBenchmarks();
  for (std::size_t k = 0; k < group.size(); ++k)
    benchmark::RegisterBenchmark(std::to_string(k).c_str(),
                                 [&cell = group[k], &done](benchmark::State& state) {
                                   solve(state, cell);
                                   done();
                                 })
        ->Iterations(1)
        ->Repetitions(repetitions)
        ->UseRealTime();
  Collector collector(times);
  benchmark::RunSpecifiedBenchmarks(&collector);
  return times;
}

}  // namespace drape::bench
