#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bench/runs/run.hpp"
#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"
#include "results/table.hpp"

/// What the tables of the study `scaling` share.
namespace drape::bench::scaling_study {

constexpr double step = 0.01;  ///< [s]

/// Particles a side.
std::vector<int> sizes(bool quick);

/// The sheet hung by its edge, n × n.
model::Cloth hung_sheet(int n);

/// Calls f(threads) with as many threads as it is told; more than one only where it is worth it.
void with_threads(int n, const std::function<void(int threads)>& f);

/// Wall time of a call [s].
template <class F>
double seconds(const F& f) {
  const auto begin = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Takes the wall time of every step, without what is done between two.
class StepClock : public Observer {
 public:
  /// `between`: called after every step with the number of steps so far; may be empty.
  explicit StepClock(std::function<void(int steps)> between = {}) : between_(std::move(between)) {}

  void begin(const model::Scene&, const model::Cloth&, const solver::State&) override { start(); }
  void observe(const solver::StepReport& step) override;

  std::vector<double> times;  ///< [s]

 private:
  void start() { begin_ = std::chrono::steady_clock::now(); }

  std::function<void(int steps)> between_;
  std::chrono::steady_clock::time_point begin_;
};

constexpr int first_steps = 2;  ///< they make the matrices

/// Runs this many steps of the sheet, with the program's own choice of everything but the method. Throws std::runtime_error if
/// one fails.
void run_steps(int n, const std::string& method, const model::Cloth& cloth, int steps, StepClock& clock);

/// A table each: a step by size; an iteration of conjugate gradients by size; and whether the bars are met.
Job steps(bool quick);
Job iterations(bool quick);
Job bars(bool quick);

/// The bandwidth of an iteration of conjugate gradients without a preconditioner over that of the triad, in this number of
/// turns.
std::vector<double> bandwidth_of_bare_iterations(int n, int turns);

}  // namespace drape::bench::scaling_study
