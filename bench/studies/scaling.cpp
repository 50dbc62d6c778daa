#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "bench/studies.hpp"
#include "model/cloth.hpp"
#include "model/scene_file.hpp"
#include "results/table_builder.hpp"
#include "solver/integrator.hpp"
#include "solver/kernels.hpp"
#include "solver/threads.hpp"

namespace drape::bench {
namespace {

using solver::SparseMatrix;
using solver::Vectors;

constexpr double step = 0.01;  ///< [s]
constexpr int first_steps = 2, timed_steps = 3;
const std::vector<std::string> methods{"bdf2", "sbdf2"};

std::vector<int> sizes(bool quick) {
  if (quick) return {20, 40};
  return {20, 50, 100, 200, 316, 500, 1000};
}

/// Only what is worth it uses more than one.
std::vector<int> threads(int n) {
  if (n < 200) return {1};
  return {1, 2};
}

/// Calls f(threads) with as many threads as it is told.
template <class F>
void with_threads(int n, const F& f) {
  for (const int count : threads(n)) {
    solver::use_threads(count);
    f(count);
  }
  solver::use_threads(1);
}

/// Least wall time of some calls [s].
template <class F>
double seconds(int calls, const F& f) {
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < calls; ++k) {
    const auto begin = std::chrono::steady_clock::now();
    f();
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return least;
}

/// Bandwidth of a = b + 3 c on vector fields of so many particles [bytes/s].
double triad(int particles) {
  const Vectors b = Vectors::Random(particles, 3), c = Vectors::Random(particles, 3);
  Vectors a = b;
  const int calls = std::max(1, 1000000 / particles);  // so that the clock's resolution does not matter
  const double time = seconds(10, [&] {
    for (int k = 0; k < calls; ++k) {
      a.noalias() = b + 3.0 * c;
      asm volatile("" : : "r"(a.data()) : "memory");  // or the compiler would leave all but the last away
    }
  });
  return static_cast<double>(calls * solver::vector_bytes(particles, 3)) / time;
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

model::Cloth hung_sheet(int n) {
  const model::Override size[] = {{"grid.n", std::to_string(n)}};
  return model::compile(model::load_scene("hung-edge", size));
}

void add_size(results::TableBuilder& table, int n, int thread_count) {
  table.row();
  table.count("n", "n", "particles a side", n);
  table.count("threads", "threads", "that the linear solver may use; forces use one", thread_count);
}

/// The exponent p in time ~ particles^p by least squares; sizes are particles a side.
double exponent(const std::vector<int>& sides, const std::vector<double>& times) {
  Eigen::ArrayXd x(sides.size()), y(sides.size());
  for (std::size_t k = 0; k < sides.size(); ++k) {
    x[k] = 2 * std::log(sides[k]);
    y[k] = std::log(times[k]);
  }
  x -= x.mean();
  return (x * y).sum() / x.square().sum();
}

// --- Steps -------------------------------------------------------------------------------------------------------------------

struct StepCost {
  double seconds, updates, cg_iterations;
  std::string linear_solver;
};

StepCost cost_of_step(const model::Cloth& cloth, const std::string& method) {
  solver::Options options = solver::thesis_options();
  options.linear_solver = &solver::linear_solver("auto");
  solver::Integrator integrator(cloth.ode, solver::method(method), options, cloth.start);
  const auto advance = [&] {
    const solver::StageResult result = integrator.step(step);
    if (result.outcome != solver::Outcome::success)
      throw std::runtime_error(fmt::format("a step of {} failed: {}", method, solver::to_string(result.outcome)));
    return result;
  };
  for (int k = 0; k < first_steps; ++k) advance();
  StepCost cost{0, 0, 0, {}};
  cost.seconds = seconds(timed_steps, [&] {
    const solver::StageResult result = advance();
    cost.updates += static_cast<double>(result.updates) / timed_steps;
    cost.cg_iterations += static_cast<double>(result.cg_iterations) / timed_steps;
  });
  for (const solver::LinearSolver& kind : solver::linear_solvers())
    if (cloth.ode.work->count(fmt::format("linear_solver/{}", kind.name)) > 0) cost.linear_solver = kind.name;
  return cost;
}

results::Table steps(bool quick, Progress& progress) {
  results::TableBuilder table(
      "scaling", fmt::format("A step of {:g} s of the sheet hung by its edge, by size; linear solver: auto", step));
  std::vector<std::vector<double>> times(methods.size());
  const auto all = sizes(quick);
  const auto hundred = std::ranges::find(all, 100) - all.begin();
  for (const int n : all) {
    for (std::size_t k = 0; k < methods.size(); ++k) {
      progress.show(fmt::format("{} x {}, {}", n, n, methods[k]));
      with_threads(n, [&](int thread_count) {
        const StepCost cost = cost_of_step(hung_sheet(n), methods[k]);
        if (thread_count == 1) times[k].push_back(cost.seconds);
        add_size(table, n, thread_count);
        table.text("method", "method", "time integrator", methods[k]);
        table.text("linear_solver", "chosen", "the linear solver that auto chose", cost.linear_solver);
        table.number("step", "step", "ms", "least wall time of a step", 1e3 * cost.seconds);
        table.number("per_particle", "/particle", "ns", "the same, over the number of particles", 1e9 * cost.seconds / n / n);
        table.number("updates", "updates", "1", "linear systems a step", cost.updates);
        table.number("cg_iterations", "CG", "1", "iterations of conjugate gradients a step", cost.cg_iterations);
        if (n > 100)
          table.number("ratio", "of 100 x 100", "1",
                       "time per particle over that of 100 x 100; for BDF(2) at most 3 is asked for",
                       cost.seconds / (times[k][hundred] * n * n / 1e4));
        table.number("memory", "memory", "MB", "most memory that the process had until then", peak_memory_mb());
      });
      progress.advance();
    }
  }
  for (std::size_t k = 0; k < methods.size(); ++k) {
    table.row();
    table.text("method", "method", "time integrator", methods[k]);
    table.number("exponent", "exponent", "1", "p in time ~ particles^p", exponent(all, times[k]));
  }
  return table.finish();
}

// --- Conjugate gradients -----------------------------------------------------------------------------------------------------

/// The matrix of a stage of implicit Euler, without what couples to pinned particles.
SparseMatrix stage_matrix(const solver::SplitOde& ode) {
  std::vector<bool> pinned(ode.particles(), false);
  for (const solver::Pin& pin : ode.pins) pinned[pin.particle] = pin.all();
  SparseMatrix A = SparseMatrix(ode.mass.asDiagonal()) - step * step * ode.stiffness - step * ode.damping;
  A.prune([&](int i, int j, double) { return i == j || (!pinned[i] && !pinned[j]); });
  A.makeCompressed();
  return A;
}

/// Seconds and bytes of one iteration, or of one substitution.
struct IterationCost {
  double seconds, bytes;
};

/// Conjugate gradients without a preconditioner: the product with the matrix as a stencil and the vectors.
IterationCost cost_of_bare_iteration(const SparseMatrix& A) {
  const auto star = solver::five_point(A).value();
  const Vectors z = Vectors::Random(A.rows(), 3);
  Vectors p = z, q = z, d = z, r = z;
  double sum = 0;
  const double time = seconds(10, [&] {
    sum += solver::direct(star, z, 0.1, p, q);
    sum += solver::advance(1e-9, p, q, d, r);
  });
  if (!std::isfinite(sum)) throw std::runtime_error("an iteration of conjugate gradients is not finite");
  return {time, static_cast<double>(star.bytes() + solver::vector_bytes(A.rows(), 10))};
}

IterationCost cost_of_iteration(const model::Cloth& cloth, const SparseMatrix& A, const std::string& linear_solver) {
  solver::Work& work = *cloth.ode.work;
  solver::ConjugateGradients cg(solver::linear_solver(linear_solver).make(), 5, work);
  cg.analyze(A);
  if (cg.factor(A) != solver::Outcome::success) throw std::runtime_error("the matrix of the sheet is not positive definite");
  const Vectors b = Vectors::Random(A.rows(), 3);
  Vectors r = b, d = b;
  const auto count = [&](const char* kind) { return static_cast<double>(work.count(kind)); };
  const double bytes = count("linear_bytes"), applications = count("preconditioner_applications");
  constexpr int solves = 5;
  const double time = seconds(solves, [&] {
    r = b;
    cg.solve(A, {}, r, d, 0);
  });
  const double iterations = (count("preconditioner_applications") - applications) / solves;
  return {time / iterations, (count("linear_bytes") - bytes) / solves / iterations};
}

void add_iteration(results::TableBuilder& table, int n, int thread_count, const std::string& name, const IterationCost& cost,
                   double bandwidth) {
  add_size(table, n, thread_count);
  table.text("linear_solver", "linear solver", "with which preconditioner, or a substitution", name);
  table.number("iteration", "/particle", "ns", "time of an iteration over the number of particles", 1e9 * cost.seconds / n / n);
  table.number("bytes", "/particle", "B", "bytes that an iteration moves at least, over the number of particles",
               cost.bytes / n / n);
  table.number("bandwidth", "of triad", "%", "bytes over time, over the bandwidth of the triad",
               100 * cost.bytes / cost.seconds / bandwidth);
}

results::Table iterations(bool quick, Progress& progress) {
  results::TableBuilder table("scaling-iterations",
                              "An iteration of conjugate gradients, by size, beside the triad a = b + 3 c");
  for (const int n : sizes(quick)) {
    progress.show(fmt::format("{} x {}, conjugate gradients", n, n));
    const model::Cloth cloth = hung_sheet(n);
    const SparseMatrix A = stage_matrix(cloth.ode);
    const double bandwidth = triad(n * n);
    with_threads(n, [&](int thread_count) {
      add_iteration(table, n, thread_count, "none", cost_of_bare_iteration(A), bandwidth);
      table.number("triad", "triad", "GB/s", "bandwidth of the triad at this size with one thread", 1e-9 * bandwidth);
      for (const char* name : {"ic0", "mic0", "multigrid", "cholesky"})
        if (name != std::string_view("cholesky") || n <= 316)
          add_iteration(table, n, thread_count, name, cost_of_iteration(cloth, A, name), bandwidth);
    });
    progress.advance();
  }
  return table.finish();
}

}  // namespace

std::vector<TableJob> scaling(bool quick) {
  const int count = static_cast<int>(sizes(quick).size());
  return {{count * static_cast<int>(methods.size()), [quick](Progress& progress) { return steps(quick, progress); }},
          {count, [quick](Progress& progress) { return iterations(quick, progress); }}};
}

}  // namespace drape::bench
