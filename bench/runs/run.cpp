#include "bench/runs/run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <exception>
#include <new>
#include <optional>
#include <string>

#include "bench/runs/interruption.hpp"

namespace drape::bench {
namespace {

/// Ends a run from within the function that sees its steps: it has as many as it may, or an observer has thrown.
struct Enough {};

std::string memory_message(const Limits& limits) {
  return std::isfinite(limits.megabytes) ? fmt::format("more than {:g} MB", limits.megabytes) : "more than the machine has";
}

/// solver::integrate, seen by observers and limited to a number of steps.
class ObservedRun {
 public:
  ObservedRun(solver::Integrator& integrator, std::span<Observer* const> observers, std::size_t most_steps)
      : integrator_(integrator), observers_(observers), most_steps_(most_steps) {}

  solver::RunResult integrate(double t_end, double h) {
    try {
      return solver::integrate(integrator_, t_end, h, [this](const solver::StepReport& step) { see(step); });
    } catch (const Enough&) {
      if (thrown_) std::rethrow_exception(thrown_);
      return end_as(solver::Outcome::success, {});
    } catch (const LimitReached&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      return end_as(solver::Outcome::failed, error.what());
    }
  }

  /// The result of a run that ends after the last accepted step.
  solver::RunResult end_as(solver::Outcome outcome, std::string message) const {
    return {outcome, std::move(message), integrator_.time(), steps_, 0};
  }

  int steps() const { return steps_; }  ///< that all observers have let pass

 private:
  void see(const solver::StepReport& step) {
    check_interruption();
    try {
      for (Observer* observer : observers_) observer->observe(step);
    } catch (...) {
      thrown_ = std::current_exception();
      throw Enough();
    }
    if (static_cast<std::size_t>(++steps_) >= most_steps_) throw Enough();
  }

  solver::Integrator& integrator_;
  std::span<Observer* const> observers_;
  std::size_t most_steps_;
  int steps_ = 0;
  std::exception_ptr thrown_;  ///< by an observer
};

/// `memory` is given back before the state at the end is copied.
RunEnd run_within(const RunSpec& spec, const model::Cloth& cloth, std::span<Observer* const> observers, const Limits& limits,
                  std::optional<MemoryLimit>& memory) {
  const std::clock_t begin = std::clock();
  RunEnd end;
  Meter meter(limits);
  std::optional<solver::SplitOde> watched;
  std::optional<solver::Integrator> integrator;
  std::optional<ObservedRun> observed;
  const auto stop = [&](solver::Outcome outcome, std::string message, double last_good_time) {
    end.result = {outcome, std::move(message), last_good_time, observed ? observed->steps() : 0, 0};
  };
  const auto time = [&] { return integrator ? integrator->time() : 0; };
  try {
    if (limits.within_steps()) meter.watch(watched.emplace(cloth.ode));
    integrator.emplace(watched ? *watched : cloth.ode, *spec.method, spec.options, cloth.start);
    for (Observer* observer : observers) observer->begin(spec.scene, cloth, integrator->state());
    observed.emplace(*integrator, observers, limits.steps);
    end.result = observed->integrate(spec.scene.end, spec.step);
    if (end.result.outcome == solver::Outcome::success)
      for (const Observer* observer : observers)
        if (std::string remark = observer->remark(); !remark.empty()) end.result.message = std::move(remark);
  } catch (const Ending& ending) {
    stop(ending.outcome, ending.message, ending.last_good_time);
  } catch (const LimitReached& limit) {
    stop(limit.outcome, limit.what(), time());
  } catch (const std::bad_alloc&) {
    memory.reset();
    stop(solver::Outcome::out_of_memory, memory_message(limits), time());
  }
  memory.reset();
  if (observed)
    for (Observer* observer : observers) observer->finish();
  if (integrator) end.state = integrator->state();
  end.evaluations = meter.evaluations();
  end.newton_matrices = meter.newton_matrices();
  end.cpu_ms = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return end;
}

}  // namespace

RunEnd run(const RunSpec& spec, const model::Cloth& cloth, std::span<Observer* const> observers, const Limits& limits) {
  std::optional<MemoryLimit> memory(std::in_place, limits.megabytes);
  return run_within(spec, cloth, observers, limits, memory);
}

RunEnd run(const RunSpec& spec, std::optional<model::Cloth>& cloth, std::span<Observer* const> observers,
           const Limits& limits) {
  std::optional<MemoryLimit> memory(std::in_place, limits.megabytes);
  try {
    cloth = model::compile(spec.scene);
  } catch (const std::bad_alloc&) {
    memory.reset();
    return {.result = {.outcome = solver::Outcome::out_of_memory, .message = memory_message(limits)}};
  }
  return run_within(spec, *cloth, observers, limits, memory);
}

}  // namespace drape::bench
