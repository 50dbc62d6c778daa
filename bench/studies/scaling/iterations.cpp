#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/studies/scaling/scaling.hpp"
#include "results/analysis/runs_table.hpp"
#include "solver/base/statistics.hpp"
#include "solver/linear/conjugate_gradients.hpp"
#include "solver/linear/five_point.hpp"
#include "solver/linear/kernels.hpp"

namespace drape::bench::scaling_study {
namespace {

using solver::SparseMatrix;
using solver::Vectors;

/// a = b + 3 c on vector fields of so many particles.
class Triad {
 public:
  explicit Triad(int particles)
      : b_(Vectors::Random(particles, 3)),
        c_(Vectors::Random(particles, 3)),
        a_(b_),
        calls_(std::max(1, 1000000 / particles)) {}

  /// Bandwidth of some calls, so many that the clock's resolution does not matter [bytes/s].
  double bandwidth() {
    const double time = seconds([&] {
      for (int k = 0; k < calls_; ++k) {
        a_.noalias() = b_ + 3.0 * c_;
        asm volatile("" : : "r"(a_.data()) : "memory");  // or the compiler would leave all but the last away
      }
    });
    return static_cast<double>(calls_ * solver::vector_bytes(a_.rows(), 3)) / time;
  }

 private:
  Vectors b_, c_, a_;
  int calls_;
};

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
class BareIteration {
 public:
  explicit BareIteration(const SparseMatrix& A)
      : star_(solver::five_point(A).value()), z_(Vectors::Random(A.rows(), 3)), p_(z_), q_(z_), d_(z_), r_(z_) {}

  IterationCost operator()() {
    double sum = 0;
    const double time = seconds([&] { sum = solver::direct(star_, z_, 0.1, p_, q_) + solver::advance(1e-9, p_, q_, d_, r_); });
    if (!std::isfinite(sum)) throw std::runtime_error("an iteration of conjugate gradients is not finite");
    return {time, static_cast<double>(star_.bytes() + solver::vector_bytes(z_.rows(), 10))};
  }

 private:
  solver::FivePoint star_;
  Vectors z_, p_, q_, d_, r_;
};

/// Some iterations with a preconditioner, or a substitution.
class Iterations {
 public:
  Iterations(const SparseMatrix& A, solver::Counters& work, const std::string& linear_solver)
      : A_(A),
        work_(work),
        cg_(solver::linear_solver(linear_solver).make(), 5, work),
        b_(Vectors::Random(A.rows(), 3)),
        r_(b_),
        d_(b_) {
    cg_.analyze(A);
    if (cg_.factor(A) != solver::Outcome::success) throw std::runtime_error("the matrix of the sheet is not positive definite");
  }

  IterationCost operator()() {
    const std::int64_t bytes = work_.count("linear_bytes"), applied = work_.count("preconditioner_applications");
    r_ = b_;
    const double time = seconds([&] { cg_.solve(A_, {}, r_, d_, 0); });
    const auto iterations = static_cast<double>(work_.count("preconditioner_applications") - applied);
    return {time / iterations, static_cast<double>(work_.count("linear_bytes") - bytes) / iterations};
  }

 private:
  const SparseMatrix& A_;
  solver::Counters& work_;
  solver::ConjugateGradients cg_;
  Vectors b_, r_, d_;
};

/// Costs and the triad's bandwidth in turns, because the machine's speed drifts.
struct Turns {
  std::vector<double> seconds, triad, ratio;
  double bytes = 0;
};

template <class Iterate>
Turns turns(int count, Triad& triad, Iterate&& iterate) {
  Turns all;
  for (int k = 0; k < count; ++k) {
    const double bandwidth = triad.bandwidth();
    const IterationCost cost = iterate();
    all.bytes = cost.bytes;
    all.seconds.push_back(cost.seconds);
    all.triad.push_back(bandwidth);
    all.ratio.push_back(cost.bytes / cost.seconds / bandwidth);
  }
  return all;
}

void add_iteration(results::TableBuilder& table, int n, int threads, const std::string& name, const Turns& turns) {
  const auto median = [](const std::vector<double>& values) { return base::quantile(values, 0.5); };
  const double particles = static_cast<double>(n) * n;
  add_size(table, n, threads);
  table.text("linear_solver", "linear solver", "with which preconditioner, or a substitution", name);
  table.number("iteration", "/particle", "ns", "median time of an iteration over the number of particles",
               1e9 * median(turns.seconds) / particles);
  table.number("bytes", "/particle", "B", "bytes that an iteration moves at least, over the number of particles",
               turns.bytes / particles);
  table.number(
      "bandwidth", "of triad", "%",
      "bytes over time, over the bandwidth of the triad: median of turns; above 100 where the triad has to load what it "
      "overwrites, which is not counted",
      100 * median(turns.ratio));
  table.number("triad", "triad", "GB/s", "median bandwidth of the triad in turns with that, with one thread",
               1e-9 * median(turns.triad));
}

/// All preconditioners on one size.
void add_iterations(results::TableBuilder& table, int n) {
  constexpr int count = 11;
  const model::Cloth cloth = hung_sheet(n);
  const SparseMatrix A = stage_matrix(cloth.ode);
  Triad triad(n * n);
  with_threads(n, [&](int threads) {
    add_iteration(table, n, threads, "none", turns(count, triad, BareIteration(A)));
    for (const char* name : {"ic0", "mic0", "multigrid", "cholesky"})
      if (name != std::string_view("cholesky") || n <= 316)
        add_iteration(table, n, threads, name, turns(count, triad, Iterations(A, *cloth.ode.work, name)));
  });
}

}  // namespace

results::Table iterations(bool quick, Checkpoint& checkpoint) {
  results::TableBuilder table("scaling-iterations",
                              "An iteration of conjugate gradients, by size, in turns with the triad a = b + 3 c");
  for (const int n : sizes(quick)) {
    checkpoint.show(fmt::format("{} x {}, conjugate gradients", n, n));
    checkpoint.rows(table, std::to_string(n), [&](results::TableBuilder& rows) { add_iterations(rows, n); });
    checkpoint.advance();
  }
  return table.finish();
}

std::vector<double> bandwidth_of_bare_iterations(int n, int count) {
  Triad triad(n * n);
  return turns(count, triad, BareIteration(stage_matrix(hung_sheet(n).ode))).ratio;
}

}  // namespace drape::bench::scaling_study
