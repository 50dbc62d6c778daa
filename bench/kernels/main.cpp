// Costs of the pieces, for what a person asks before choosing a solver: ns per particle of the product with the constant
// matrix, of every force, and of a whole CG iteration, each beside what the machine's triad takes to move as many bytes; and of
// what Eigen and CHOLMOD offer for the same, so that the reason for kernels of our own stays measured; ns per triangle of
// finding where cloth meets itself; and what threads make of them.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "model/cloth.hpp"
#include "model/collision/self_contacts.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/stopwatch.hpp"
#include "solver/base/threads.hpp"
#include "solver/linear/block_cholesky.hpp"
#include "solver/linear/cholmod_view.hpp"
#include "solver/linear/conjugate_gradients.hpp"
#include "solver/linear/kernels.hpp"
#include "solver/linear/stage_matrix.hpp"

namespace drape::bench {
namespace {

using solver::SparseMatrix;
using solver::Vectors;

/// The sheet of the main job with n × n particles and only the forces that the changes leave.
model::Scene sheet(int n, std::vector<model::Override> changes) {
  changes.push_back({"grid.n", std::to_string(n)});
  return model::load_scene("hung-edge", changes);
}

/// Off the exact grid, so that no branch or cancellation is special.
Vectors perturbed(const Vectors& x, double size) { return x + size * Vectors::Random(x.rows(), 3); }

/// Adds the time of an iteration over the number of particles as a column.
void per_particle(benchmark::State& state, std::int64_t particles) {
  state.counters["per_particle"] = benchmark::Counter(
      static_cast<double>(particles), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// a = b + 3 c on vector fields.
class Triad {
 public:
  explicit Triad(std::int64_t particles) : b_(Vectors::Random(particles, 3)), c_(Vectors::Random(particles, 3)), a_(b_) {}

  void operator()() {
    a_.noalias() = b_ + 3.0 * c_;
    benchmark::ClobberMemory();
  }
  std::int64_t bytes() const { return solver::vector_bytes(a_.rows(), 3); }

 private:
  Vectors b_, c_, a_;
};

/// Bandwidth of the triad on this number of particles by one thread, the best of many calls [bytes/s].
double triad_bandwidth(std::int64_t particles) {
  Triad triad(particles);
  const std::int64_t calls = std::max<std::int64_t>(1, 100'000 / particles);  // so that the clock's resolution does not matter
  double least = std::numeric_limits<double>::infinity();                     // [ms]
  for (int k = 0; k < 15; ++k) {
    double time = 0;
    {
      const base::Stopwatch clock(&time);
      for (std::int64_t call = 0; call < calls; ++call) triad();
    }
    least = std::min(least, time);
  }
  return 1e3 * static_cast<double>(calls * triad.bytes()) / least;
}

/// Adds the bandwidth, and how long the triad takes to move as many bytes: the roof that memory, or the cache they are in, sets
/// for one thread.
void roofline(benchmark::State& state, std::int64_t bytes, std::int64_t particles) {
  state.counters["bytes_per_s"] = benchmark::Counter(static_cast<double>(bytes), benchmark::Counter::kIsIterationInvariantRate,
                                                     benchmark::Counter::kIs1000);
  state.counters["roof"] = static_cast<double>(bytes) / triad_bandwidth(particles) / static_cast<double>(particles);
}

void triad(benchmark::State& state) {
  const auto n = state.range(0) * state.range(0);
  Triad triad(n);
  for (auto _ : state) triad();
  per_particle(state, n);
  roofline(state, triad.bytes(), n);
}

void product(benchmark::State& state) {
  const model::Cloth cloth = compile(sheet(static_cast<int>(state.range(0)), {}));
  const SparseMatrix A = solver::stage_matrix(cloth.ode, 0.01);
  const Vectors x = perturbed(cloth.start.x, 0.01);
  Vectors y = x;
  for (auto _ : state) benchmark::DoNotOptimize(solver::multiply(A, x, y));
  per_particle(state, A.rows());
  roofline(state, solver::multiply_bytes(A), A.rows());
}

void cg_iteration(benchmark::State& state, const solver::LinearSolver& linear_solver) {
  constexpr int iterations = 10;
  const model::Cloth cloth = compile(sheet(static_cast<int>(state.range(0)), {}));
  const SparseMatrix A = solver::stage_matrix(cloth.ode, 0.01);
  solver::ConjugateGradients cg(linear_solver.make(), iterations, *cloth.ode.work);
  cg.analyse(A);
  if (cg.factor(A) != solver::Outcome::success) return state.SkipWithError("the matrix is not positive definite");
  const Vectors b = perturbed(cloth.start.x, 1);
  Vectors r = b, d = b;
  for (auto _ : state) {
    r = b;
    benchmark::DoNotOptimize(cg.solve(A, {}, r, d, -std::numeric_limits<double>::infinity()));
  }
  // One if the factor is complete.
  const std::int64_t done = cloth.ode.work->count("preconditioner_applications") / state.iterations();
  per_particle(state, A.rows() * done);
  roofline(state, cloth.ode.work->count("linear_bytes") / state.iterations() / done, A.rows());
}

/// Eigen's own iteration, which takes the three columns one after the other.
template <class Preconditioner>
void eigen_cg_iteration(benchmark::State& state) {
  constexpr int iterations = 10;
  const model::Cloth cloth = compile(sheet(static_cast<int>(state.range(0)), {}));
  const SparseMatrix A = solver::stage_matrix(cloth.ode, 0.01);
  Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower | Eigen::Upper, Preconditioner> cg(A);
  cg.setMaxIterations(iterations);
  cg.setTolerance(0);
  const Eigen::MatrixX3d b = perturbed(cloth.start.x, 1);
  Eigen::MatrixX3d d = b;
  for (auto _ : state) {
    d = cg.solve(b);
    benchmark::ClobberMemory();
  }
  per_particle(state, A.rows() * iterations);
}

/// CHOLMOD's own solve of three columns, in memory that is kept.
void cholmod_solve(benchmark::State& state) {
  const model::Cloth cloth = compile(sheet(static_cast<int>(state.range(0)), {}));
  const SparseMatrix A = solver::stage_matrix(cloth.ode, 0.01);
  cholmod_common common;
  cholmod_start(&common);
  cholmod_sparse view = solver::cholmod_view(A);
  cholmod_factor* factor = cholmod_analyze(&view, &common);
  cholmod_factorize(&view, factor, &common);
  const auto n = static_cast<std::size_t>(A.rows());
  cholmod_dense* b = cholmod_ones(n, 3, CHOLMOD_REAL, &common);
  cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;
  for (auto _ : state) benchmark::DoNotOptimize(cholmod_solve2(CHOLMOD_A, factor, b, nullptr, &x, nullptr, &y, &e, &common));
  per_particle(state, A.rows());
  for (cholmod_dense** field : {&b, &x, &y, &e}) cholmod_free_dense(field, &common);
  cholmod_free_factor(&factor, &common);
  cholmod_finish(&common);
}

/// A sheet under way and its Newton matrix.
struct NewtonProblem {
  model::Cloth cloth;
  Vectors x, v;
  SparseMatrix J;

  explicit NewtonProblem(int n)
      : cloth(compile(sheet(n, {{"material.damping", "0.5"}}))), x(perturbed(cloth.start.x, 1e-3)), v(cloth.start.v) {
    assemble();
  }
  void assemble() { cloth.ode.newton_matrix(0, x, v, 0.01, solver::Jacobian::whole, J); }
};

void newton_matrix(benchmark::State& state) {
  NewtonProblem newton(static_cast<int>(state.range(0)));
  for (auto _ : state) newton.assemble();
  per_particle(state, newton.x.rows());
}

void newton_factor(benchmark::State& state) {
  const NewtonProblem newton(static_cast<int>(state.range(0)));
  solver::BlockCholesky factor(newton.J);
  factor.factor(newton.J);  // the kernel clears pages when they are used first, which takes longer than a factor
  for (auto _ : state)
    if (!factor.factor(newton.J)) return state.SkipWithError("the matrix is not positive definite");
  per_particle(state, newton.x.rows());
}

void newton_solve(benchmark::State& state) {
  const NewtonProblem newton(static_cast<int>(state.range(0)));
  solver::BlockCholesky factor(newton.J);
  if (!factor.factor(newton.J)) return state.SkipWithError("the matrix is not positive definite");
  Vectors d = newton.x;
  for (auto _ : state) factor.solve(newton.x, d);
  per_particle(state, newton.x.rows());
}

/// CHOLMOD's own factors of the same matrix, by columns or by supernodes.
void cholmod_newton_factor(benchmark::State& state, int supernodal) {
  const NewtonProblem newton(static_cast<int>(state.range(0)));
  cholmod_common common;
  cholmod_start(&common);
  common.supernodal = supernodal;
  cholmod_sparse view = solver::cholmod_view(newton.J);
  cholmod_factor* factor = cholmod_analyze(&view, &common);
  for (auto _ : state) cholmod_factorize(&view, factor, &common);
  per_particle(state, newton.x.rows());
  cholmod_free_factor(&factor, &common);
  cholmod_finish(&common);
}

void force(benchmark::State& state, const std::vector<model::Override>& changes) {
  const model::Scene scene = sheet(static_cast<int>(state.range(0)), changes);
  const model::Cloth cloth = compile(scene);
  const Vectors x = perturbed(cloth.start.x, 0.2 * scene.sheet.grid.spacing_u());
  const Vectors v = perturbed(cloth.start.v, 1);
  Vectors f = x, by_velocity = x;
  cloth.ode.force(0, x, v, f);
  cloth.ode.force(0, x, 2 * v, by_velocity);
  const bool reads_velocities = f != by_velocity;
  for (auto _ : state) {
    cloth.ode.force(0, x, v, f);
    benchmark::ClobberMemory();
  }
  per_particle(state, cloth.ode.particles());
  roofline(state, solver::vector_bytes(x.rows(), reads_velocities ? 3 : 2), x.rows());
}

/// Only this much of the material, and no weight.
std::vector<model::Override> only(std::vector<model::Override> kept) {
  std::vector<model::Override> changes{
      {"material.tension", "0"}, {"material.damping", "0"}, {"material.shear", "0"}, {"forces.gravity", "[0, 0, 0]"}};
  changes.insert(changes.end(), kept.begin(), kept.end());
  return changes;
}

/// Layers of n × n particles each, 2 cm apart, 3 mm above each other, which lie askew and fall by 1.5 cm in waves of 1 cm.
struct Layers {
  model::ClothSurface surface;
  Vectors x0, x1;
};

Layers layers_of_cloth(int layers, int n) {
  constexpr double side = 0.02, between = 3e-3, amplitude = 0.01, wave_number = 20;  // [m], [1/m]
  const Eigen::Matrix3d turned = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  Vectors x0(layers * n * n, 3), x1 = x0;
  std::vector<std::array<int, 3>> triangles;
  for (int k = 0; k < layers; ++k)
    for (int b = 0; b < n; ++b)
      for (int a = 0; a < n; ++a) {
        const int i = a + n * (b + n * k);
        const Eigen::Vector3d flat(a * side, b * side, k * between);
        x0.row(i) = turned * flat;
        x1.row(i) = turned * (flat + Eigen::Vector3d(0, 0, -0.015 + amplitude * std::sin(wave_number * flat.x())));
        if (a + 1 == n || b + 1 == n) continue;
        triangles.push_back({i, i + 1, i + n});
        triangles.push_back({i + n + 1, i + n, i + 1});
      }
  return {model::ClothSurface(triangles, x0), x0, x1};
}

/// What a step with contact of the cloth with itself would find within 4 mm.
void collision(benchmark::State& state, int layers) {
  const Layers cloth = layers_of_cloth(layers, static_cast<int>(state.range(0)));
  solver::Counters work;
  model::SelfContacts contacts(cloth.surface, work);
  std::vector<model::Approach> found;
  contacts.find(cloth.x0, cloth.x1, 4e-3, found);  // it grows once
  for (auto _ : state) contacts.find(cloth.x0, cloth.x1, 4e-3, found);
  const auto triangles = static_cast<double>(cloth.surface.faces().size());
  state.counters["per_triangle"] =
      benchmark::Counter(triangles, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["found"] = static_cast<double>(found.size()) / triangles;
}

int cores() { return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, base::max_threads); }

void register_all() {
  const std::vector<std::int64_t> sizes{20, 100, 1000};
  const auto add = [&](const std::string& name, auto function, const std::vector<std::int64_t>& some_sizes) {
    for (const std::int64_t n : some_sizes) benchmark::RegisterBenchmark(name.c_str(), function)->Arg(n)->ArgName("n");
  };
  // What threads do faster, on all cores, with real time.
  const auto add_threads = [&](const std::string& name, auto function, std::int64_t n) {
    const auto with_threads = [function](benchmark::State& state) {
      base::use_threads(static_cast<int>(state.range(1)));
      function(state);
      base::use_threads(1);
    };
    for (int threads = 1; threads <= cores(); threads *= 2)
      benchmark::RegisterBenchmark(("threads/" + name).c_str(), with_threads)
          ->Args({n, threads})
          ->ArgNames({"n", "threads"})
          ->UseRealTime();
  };
  add("triad", triad, sizes);
  add("product", product, sizes);
  for (const solver::LinearSolver& linear_solver : solver::linear_solvers()) {
    // The complete factor of a million particles takes minutes: not a kernel.
    const bool complete = linear_solver.name == "cholesky";
    add(
        fmt::format("cg-iteration/{}", linear_solver.name),
        [&](benchmark::State& state) { cg_iteration(state, linear_solver); },
        complete ? std::vector<std::int64_t>{20, 100} : sizes);
  }
  add_threads(
      "cg-iteration/multigrid", [](benchmark::State& state) { cg_iteration(state, solver::linear_solver("multigrid")); }, 1000);
  const std::vector<std::int64_t> factored{20, 50, 100};
  add("newton/matrix", newton_matrix, factored);
  add("newton/factor", newton_factor, factored);
  add("newton/solve", newton_solve, factored);
  add_threads("newton/matrix", newton_matrix, 100);
  add_threads("newton/factor", newton_factor, 100);
  for (const auto& [name, supernodal] : {std::pair("columns", CHOLMOD_SIMPLICIAL), std::pair("supernodes", CHOLMOD_SUPERNODAL)})
    add(
        fmt::format("library/cholmod-newton-factor/{}", name),
        [supernodal = supernodal](benchmark::State& state) { cholmod_newton_factor(state, supernodal); }, factored);
  add("library/eigen-cg-iteration", eigen_cg_iteration<Eigen::IdentityPreconditioner>, sizes);
  add("library/eigen-cg-iteration-ic", eigen_cg_iteration<Eigen::IncompleteCholesky<double>>, sizes);
  add("library/cholmod-solve", cholmod_solve, {20, 100});
  const std::vector<std::pair<std::string, std::vector<model::Override>>> forces{
      {"none", only({})},
      {"tension", only({{"material.tension", "1e4"}})},
      {"damping", only({{"material.damping", "50"}})},
      {"projected-damping", only({{"material.damping", "50"}, {"material.damping_form", "projected"}})},
      {"shear", only({{"material.shear", "100"}})},
      {"shear-viscous", only({{"material.shear", "100"}, {"material.shear_damping", "1"}})},
      {"printed-shear", only({{"material.shear", "100"}, {"material.shear_form", "printed"}})},
      {"contraction", only({{"material.tension", "1e4"}, {"material.contraction", "1e3"}})},
      {"membrane", only({{"material.bend", "1e-3"}, {"material.bend_form", "membrane"}})},
      {"plate", only({{"material.bend", "1e-3"}})},
      {"plate-unprojected", only({{"material.bend", "1e-3"}, {"material.bend_projected", "false"}})},
      {"hung-sheet", {}},
      {"hung-panel", {{"grid.grading", "1.5"}}},
  };
  for (const auto& [name, changes] : forces) {
    const auto evaluated = [changes = changes](benchmark::State& state) { force(state, changes); };
    add("force/" + name, evaluated, sizes);
    add_threads("force/" + name, evaluated, 1000);
  }
  for (const auto& [name, layers] : {std::pair("collision/flat", 1), std::pair("collision/layers", 3)}) {
    const auto found = [layers = layers](benchmark::State& state) { collision(state, layers); };
    add(name, found, {23, 71, 224});
    add_threads(name, found, 224);
  }
}

}  // namespace
}  // namespace drape::bench

int main(int argc, char** argv) {
  drape::bench::register_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
