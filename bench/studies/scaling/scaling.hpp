#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"
#include "results/table.hpp"
#include "solver/integrator.hpp"

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

/// A run of the sheet with the program's own choice of everything but the method, past its first steps.
class Run {
 public:
  Run(int n, const std::string& method);

  /// Wall time of the next step [s]. Throws std::runtime_error if the step fails.
  double advance();

  int particles() const { return cloth_.ode.particles(); }
  std::int64_t count(std::string_view work) const { return cloth_.ode.work->count(work); }

 private:
  std::string method_;
  model::Cloth cloth_;
  solver::Integrator integrator_;
};

/// A table each: a step by size; an iteration of conjugate gradients by size; and whether the bars are met.
results::Table steps(bool quick, Checkpoint& checkpoint);
results::Table iterations(bool quick, Checkpoint& checkpoint);
results::Table bars(bool quick, Checkpoint& checkpoint);

/// The bandwidth of an iteration of conjugate gradients without a preconditioner over that of the triad, in this number of
/// turns.
std::vector<double> bandwidth_of_bare_iterations(int n, int turns);

}  // namespace drape::bench::scaling_study
