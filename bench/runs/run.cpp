#include "bench/runs/run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <exception>
#include <list>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/runs/interruption.hpp"
#include "model/phases.hpp"

namespace drape::bench {
namespace {

/// Ends a run from within the function that sees its steps: it has as many as it may, or an observer has thrown.
struct Enough {};

std::string memory_message(const Limits& limits) {
  return std::isfinite(limits.megabytes) ? fmt::format("more than {:g} MB", limits.megabytes) : "more than the machine has";
}

/// solver::integrate, phase by phase, seen by observers and limited to a number of steps.
class ObservedRun {
 public:
  ObservedRun(const RunSpec& spec, const model::Cloth& cloth, std::span<Observer* const> observers, const Limits& limits,
              Meter& meter, const EquationHook& hook)
      : spec_(spec),
        phases_(model::phases(spec.scene)),
        observers_(observers),
        most_steps_(limits.steps),
        counts_(limits.within_steps()),
        meter_(meter),
        hook_(hook),
        cloth_(&cloth) {}

  solver::RunResult integrate() {
    begin_phase();
    solver::RunResult result = integrate_phase();
    std::string lost;
    while (result.outcome == solver::Outcome::success && !is_complete() && phase_ + 1 < phases_.size()) {
      lost += enter_next_phase();
      const int rejected = result.rejected_steps;
      result = integrate_phase();
      result.rejected_steps += rejected;
    }
    result.steps = steps_;
    if (result.outcome == solver::Outcome::success && result.message.empty()) result.message = lost;
    return result;
  }

  double time() const { return integrator_ ? integrator_->time() : 0; }
  int steps() const { return steps_; }  ///< that all observers have let pass
  bool has_begun() const { return begun_; }

  /// After the last accepted step; empty if there was no start.
  solver::State state() const { return integrator_ ? integrator_->state() : solver::State(); }

 private:
  const model::Scene& phase() const { return phases_[phase_]; }

  void begin_phase() {
    integrator_.reset();
    if (counts_ || hook_) watched_.emplace(cloth_->ode);
    if (counts_) meter_.watch(*watched_);
    if (hook_) hook_(*watched_);
    integrator_.emplace(watched_ ? *watched_ : cloth_->ode, *spec_.method, spec_.options, cloth_->start, cloth_->begin,
                        begins_by_jump() ? solver::Start::jump : solver::Start::smooth);
    for (Observer* observer : observers_) observer->begin(phase(), *cloth_, integrator_->state());
    begun_ = true;
  }

  /// Whether strains or velocities jump from particle to particle where the phase begins: seams have merged particles, or begin
  /// to pull.
  bool begins_by_jump() const {
    const model::Garment& garment = *cloth_->garment;
    return phase_ > 0 || garment.nodes() < garment.particles() || !garment.sewn_nodes().empty();
  }

  /// Returns what is to be said of it.
  std::string enter_next_phase() {
    ++phase_;
    auto [cloth, lost] = model::compile_next(phase(), *cloth_, integrator_->state());
    cloth_ = &later_.emplace_back(std::move(cloth));
    begin_phase();
    constexpr double negligible = 1e-12;  // [J]
    if (!(lost > negligible)) return "";
    return fmt::format("{}sewing at {:g} s lost {:.3g} J", std::exchange(has_lost_, true) ? "; " : "", cloth_->begin, lost);
  }

  solver::RunResult integrate_phase() {
    try {
      return solver::integrate(*integrator_, phase().end, spec_.step, [this](const solver::StepReport& step) { see(step); });
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
    return {outcome, std::move(message), integrator_->time(), steps_, 0};
  }

  bool is_complete() const { return static_cast<std::size_t>(steps_) >= most_steps_; }

  void see(const solver::StepReport& step) {
    check_interruption();
    try {
      for (Observer* observer : observers_) observer->observe(step);
    } catch (...) {
      thrown_ = std::current_exception();
      throw Enough();
    }
    ++steps_;
    if (is_complete()) throw Enough();
  }

  const RunSpec& spec_;
  const std::vector<model::Scene> phases_;
  std::span<Observer* const> observers_;
  std::size_t most_steps_;
  bool counts_;
  Meter& meter_;
  const EquationHook& hook_;
  const model::Cloth* cloth_;
  std::list<model::Cloth> later_;  ///< of phases after the first; observers keep references
  std::optional<solver::SplitOde> watched_;
  std::optional<solver::Integrator> integrator_;
  std::size_t phase_ = 0;
  int steps_ = 0;
  bool begun_ = false, has_lost_ = false;
  std::exception_ptr thrown_;  ///< by an observer
};

/// `memory` is given back before the state at the end is copied.
RunEnd run_within(const RunSpec& spec, const model::Cloth& cloth, std::span<Observer* const> observers, const Limits& limits,
                  std::optional<MemoryLimit>& memory, const EquationHook& hook) {
  const std::clock_t begin = std::clock();
  RunEnd end;
  Meter meter(limits);
  ObservedRun observed(spec, cloth, observers, limits, meter, hook);
  const auto stop = [&](solver::Outcome outcome, std::string message, double last_good_time) {
    end.result = {outcome, std::move(message), last_good_time, observed.steps(), 0};
  };
  try {
    end.result = observed.integrate();
    if (end.result.outcome == solver::Outcome::success)
      for (const Observer* observer : observers)
        if (std::string remark = observer->remark(); !remark.empty()) end.result.message = std::move(remark);
  } catch (const Ending& ending) {
    stop(ending.outcome, ending.message, ending.last_good_time);
  } catch (const LimitReached& limit) {
    stop(limit.outcome, limit.what(), observed.time());
  } catch (const std::bad_alloc&) {
    memory.reset();
    stop(solver::Outcome::out_of_memory, memory_message(limits), observed.time());
  }
  memory.reset();
  if (observed.has_begun())
    for (Observer* observer : observers) observer->finish();
  end.state = observed.state();
  end.evaluations = meter.evaluations();
  end.newton_matrices = meter.newton_matrices();
  end.cpu_ms = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return end;
}

}  // namespace

RunEnd run(const RunSpec& spec, const model::Cloth& cloth, std::span<Observer* const> observers, const Limits& limits,
           const EquationHook& hook) {
  std::optional<MemoryLimit> memory(std::in_place, limits.megabytes);
  return run_within(spec, cloth, observers, limits, memory, hook);
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
  return run_within(spec, *cloth, observers, limits, memory, {});
}

}  // namespace drape::bench
