#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "bench/studies/scaling/scaling.hpp"
#include "results/columns.hpp"
#include "solver/base/statistics.hpp"
#include "solver/linear/conjugate_gradients.hpp"
#include "solver/linear/five_point.hpp"
#include "solver/linear/kernels.hpp"

namespace drape::bench::scaling_study {
namespace {

using solver::SparseMatrix;
using solver::Vectors;

/// a = b + 3 c on vector fields of this number of particles.
class Triad {
 public:
  explicit Triad(int particles)
      : b_(Vectors::Random(particles, 3)),
        c_(Vectors::Random(particles, 3)),
        a_(b_),
        calls_(std::max(1, 1000000 / particles)) {}

  /// Bandwidth over enough calls that the clock's resolution does not matter [bytes/s].
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
    const double time =
        seconds([&] { sum = solver::update_direction(star_, z_, 0.1, p_, q_) + solver::advance(1e-9, p_, q_, d_, r_); });
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
    cg_.analyse(A);
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

/// What an iteration of conjugate gradients costs.
struct IterationRow {
  int n, threads;
  std::string linear_solver;
  double nanoseconds, bytes;  ///< a particle
  double percent;             ///< of the triad's bandwidth
  double triad;               ///< [GB/s]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(IterationRow, n, threads, linear_solver, nanoseconds, bytes, percent, triad)

using results::ColumnOf;
using results::field;
using results::Role;

constexpr ColumnOf<IterationRow> iteration_columns[] = {
    {"n", "n", "1", "particles a side", Role::key, field<&IterationRow::n>},
    {"threads", "threads", "1", "that an iteration may use", Role::key, field<&IterationRow::threads>},
    {"linear_solver", "linear solver", "", "with which preconditioner, or a substitution", Role::key,
     field<&IterationRow::linear_solver>},
    {"iteration", "/particle", "ns", "median time of an iteration over the number of particles", Role::time,
     field<&IterationRow::nanoseconds>},
    {"bytes", "/particle", "B", "bytes that an iteration moves at least, over the number of particles", Role::quantity,
     field<&IterationRow::bytes>},
    {"bandwidth", "of triad", "%",
     "bytes over time, over the bandwidth of the triad: median of turns; above 100 where the triad has to load what it "
     "overwrites, which is not counted",
     Role::time, field<&IterationRow::percent>},
    {"triad", "triad", "GB/s", "median bandwidth of the triad in turns with that, with one thread", Role::time,
     field<&IterationRow::triad>},
};

IterationRow row_of(int n, int threads, const std::string& name, const Turns& turns) {
  const auto median = [](const std::vector<double>& values) { return base::quantile(values, 0.5); };
  const double particles = static_cast<double>(n) * n;
  return {.n = n,
          .threads = threads,
          .linear_solver = name,
          .nanoseconds = 1e9 * median(turns.seconds) / particles,
          .bytes = turns.bytes / particles,
          .percent = 100 * median(turns.ratio),
          .triad = 1e-9 * median(turns.triad)};
}

/// What is timed on one size.
struct TimedSheet {
  model::Cloth cloth;
  SparseMatrix A;
  Triad triad;

  explicit TimedSheet(int n) : cloth(hung_sheet(n)), A(stage_matrix(cloth.ode)), triad(n * n) {}

  Turns of(const std::string& preconditioner) {
    constexpr int count = 11;
    if (preconditioner == "none") return turns(count, triad, BareIteration(A));
    return turns(count, triad, Iterations(A, *cloth.ode.work, preconditioner));
  }
};

/// All preconditioners on one size.
std::vector<IterationRow> iterations_on(int n, Checkpoint& checkpoint) {
  std::optional<TimedSheet> sheet;  // made for the first row that no process before this one has made
  std::vector<IterationRow> rows;
  with_threads(n, [&](int threads) {
    for (const std::string name : {"none", "ic0", "mic0", "multigrid", "cholesky"}) {
      if (name == "cholesky" && n > 316) continue;
      rows.push_back(checkpoint.timed(fmt::format("{} {} {}", n, threads, name), [&] {
        if (!sheet) sheet.emplace(n);
        return row_of(n, threads, name, sheet->of(name));
      }));
    }
  });
  return rows;
}

std::vector<IterationRow> all_iterations(bool quick, Checkpoint& checkpoint) {
  std::vector<IterationRow> rows;
  checkpoint.each(sizes(quick), [&](const int n) {
    checkpoint.show(fmt::format("{} x {}, conjugate gradients", n, n));
    std::ranges::move(iterations_on(n, checkpoint), std::back_inserter(rows));
    checkpoint.advance();
  });
  return rows;
}

results::Table iterations_table(const std::vector<IterationRow>& rows) {
  return results::make_table("scaling-iterations",
                             "An iteration of conjugate gradients, by size, in turns with the triad a = b + 3 c",
                             iteration_columns, rows);
}

}  // namespace

Job iterations(bool quick) {
  return job(
      "scaling-iterations", static_cast<int>(sizes(quick).size()),
      [quick](Checkpoint& checkpoint) { return all_iterations(quick, checkpoint); }, iterations_table);
}

std::vector<double> bandwidth_of_bare_iterations(int n, int count) {
  Triad triad(n * n);
  return turns(count, triad, BareIteration(stage_matrix(hung_sheet(n).ode))).ratio;
}

}  // namespace drape::bench::scaling_study
