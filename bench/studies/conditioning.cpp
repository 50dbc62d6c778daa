#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "bench/runs/timing.hpp"
#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/theory/condition.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"
#include "solver/base/noise.hpp"
#include "solver/base/statistics.hpp"
#include "solver/linear/conjugate_gradients.hpp"

namespace drape::bench {
namespace {

using reference::PinnedBorder;
using results::ColumnOf;
using results::Datum;
using results::field;
using results::Role;

constexpr double spring_modulus = 1e4;        ///< k [N/m] of the sheets
constexpr double error_reduction = 2e-4;      ///< ε, the relative tolerance of linear systems in the thesis' way
constexpr double condition_agreement = 0.01;  ///< of a condition that is measured with its closed form
constexpr double spring_step = 0.01;          ///< h [s] of the sheets with the thesis' numerical stiffness

struct ConditionedBorder {
  PinnedBorder pinned;
  const char *name, *place;  ///< empty: no particle
};
constexpr ConditionedBorder conditioned_borders[] = {
    {PinnedBorder::all, "all", "border"}, {PinnedBorder::one_edge, "one edge", "upper edge"}, {PinnedBorder::none, "none", ""}};

/// c of γ = c h.
struct StageLength {
  const char* method;
  double c;
};
constexpr StageLength stage_lengths[] = {{"implicit-euler", 1}, {"bdf2", 2.0 / 3}, {"midpoint", 0.5}};

/// The matrix of a stage: a sheet of 0.8 m with its border, damping and stage.
struct StageMatrix {
  int n = 20;
  ConditionedBorder border = conditioned_borders[0];
  double damping = 0;  ///< d [N s/m]
  StageLength stage = stage_lengths[0];
};

model::Scene scene_of(const StageMatrix& system) {
  model::Scene scene = model::load_scene("hung-edge", std::vector<model::Override>{{"grid.n", fmt::format("{}", system.n)}});
  scene.sheet.material.damping = {system.damping, system.damping};
  scene.sheet.material.tension = {spring_modulus, spring_modulus};
  scene.sheet.material.shear = 0;
  scene.pins.clear();
  if (*system.border.place != 0) {
    model::PinRule pin;
    pin.where = system.border.place;
    scene.pins.push_back(pin);
  }
  return scene;
}

/// Components along all eigenvectors, none in pinned particles; the same in every process.
solver::Vectors any_solution(const solver::SplitOde& ode) {
  solver::Vectors d = 0.5 * base::noise(3 * ode.particles(), 1).reshaped(ode.particles(), 3);
  solver::filter(ode.pins, d);
  return d;
}

/// A system with one linear solver.
struct Conditioned {
  int n = 0;
  std::string pinned, method, solver;
  double nu = 0, delta = 0;     ///< ν_h and δ_h of the step
  double condition = 0;         ///< of the preconditioned matrix, by Lanczos
  std::optional<double> known;  ///< in closed form
  int iterations = 0;
  double sufficient = 0;

  std::optional<results::Verdict> as_known() const {
    if (!known) return {};
    return results::check(std::abs(condition / *known - 1) <= condition_agreement, "as in closed form",
                          "not as in closed form");
  }
  results::Verdict within() const {
    return results::check(iterations <= std::ceil(sufficient), "within the bound", "more than the bound");
  }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Conditioned, n, pinned, method, solver, nu, delta, condition, known, iterations, sufficient)

Conditioned condition(const StageMatrix& system, const solver::LinearSolver& kind) {
  const model::Scene scene = scene_of(system);
  const model::Cloth cloth = model::compile(scene);
  const double h = spring_step, gamma = system.stage.c * h;
  const double area = scene.sheet.material.density * std::pow(scene.sheet.grid.spacing_u(), 2);  // ρ l² [kg]
  Conditioned row;
  row.n = system.n;
  row.pinned = system.border.name;
  row.method = system.stage.method;
  row.solver = kind.name;
  row.nu = h * h * spring_modulus / area;
  row.delta = h * system.damping / area;
  const double g = system.stage.c * (system.stage.c * row.nu + row.delta);
  const solver::SparseMatrix A = reference::stage_matrix(cloth.ode, gamma);
  const auto preconditioner = kind.make();
  preconditioner->analyse(A);
  if (preconditioner->factor(A) != solver::Outcome::success) return row;
  const reference::KrylovRun run = reference::krylov_run(A, *preconditioner, any_solution(cloth.ode), error_reduction);
  row.condition = run.eigenvalues.condition();
  row.iterations = run.iterations;
  row.sufficient = reference::sufficient_iterations(row.condition, error_reduction);
  if (kind.name == "jacobi") row.known = reference::stage_eigenvalues(system.n, g, system.border.pinned).condition();
  return row;
}

constexpr ColumnOf<Conditioned> conditioned_columns[] = {
    {"n", "n", "1", "particles a side", Role::key, field<&Conditioned::n>},
    {"pinned", "pinned", "", "what of the border is pinned", Role::key, field<&Conditioned::pinned>},
    {"method", "method", "", "whose stage the matrix is of, h = 0.01 s", Role::key, field<&Conditioned::method>},
    {"stiffness", "ν_h", "1", "numerical stiffness h² k/(ρ l²)", Role::key, field<&Conditioned::nu>},
    {"damping", "δ_h", "1", "h d/(ρ l²)", Role::key, field<&Conditioned::delta>},
    {"linear_solver", "solver", "", "preconditioner", Role::key, field<&Conditioned::solver>},
    {"condition", "κ", "1", "condition of the preconditioned matrix, by Lanczos", Role::quantity,
     field<&Conditioned::condition>},
    {"known", "closed form", "1", "the same in closed form, where the diagonal scales the matrix by its masses", Role::quantity,
     field<&Conditioned::known>},
    {"as_known", "closed form", "", "whether both agree within 1 %", Role::verdict,
     [](const Conditioned& row) { return results::to_datum(row.as_known()); }},
    {"iterations", "iterations", "1", "until the error in the norm of A has fallen by 2e-4", Role::counter,
     field<&Conditioned::iterations>},
    {"sufficient", "sufficient", "1", "iterations by (3.7): ½ √κ ln(2/ε)", Role::quantity, field<&Conditioned::sufficient>},
    {"within", "bound", "", "whether the iterations are within the bound", Role::verdict,
     [](const Conditioned& row) { return results::to_datum(row.within()); }},
};

constexpr const char* compared_solvers[] = {"jacobi", "cg", "ic0", "mic0", "multigrid"};

std::vector<StageMatrix> systems(bool quick) {
  std::vector<StageMatrix> all;
  for (const ConditionedBorder& border : conditioned_borders)
    for (const StageLength& stage : stage_lengths) all.push_back({quick ? 8 : 20, border, 0, stage});
  for (const double d : {5.0, 50.0, 500.0}) all.push_back({quick ? 8 : 20, conditioned_borders[1], d, stage_lengths[0]});
  for (const int n : quick ? std::vector{12} : std::vector{50, 100, 200}) all.push_back({n, conditioned_borders[1]});
  return all;
}

std::vector<Conditioned> conditions(bool quick, Checkpoint& checkpoint) {
  std::vector<Conditioned> rows;
  checkpoint.each(systems(quick), [&](const StageMatrix& system) {
    checkpoint.each(compared_solvers, [&](const char* name) {
      const std::string id = fmt::format("{} × {}, {} pinned, d = {}, {}, {}", system.n, system.n, system.border.name,
                                         system.damping, system.stage.method, name);
      checkpoint.show(id);
      rows.push_back(checkpoint.once(id, [&] { return condition(system, solver::linear_solver(name)); }));
      checkpoint.advance();
    });
  });
  return rows;
}

// --- A dense inverse against a sparse solve (3.3.4) --------------------------------------------------------------------------

/// Median times [µs] of one solve for three coordinates.
struct Inverse {
  int particles = 0;
  std::array<double, 3> medians{}, spreads{};  ///< of the product with the inverse, IC(0)-CG to 2e-4, and the factor

  results::Verdict cheaper() const {
    return results::check(medians[1] + spreads[1] < medians[0] - spreads[0], "cheaper", "not cheaper");
  }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Inverse, particles, medians, spreads)

/// Solves a system in one of three ways, again and again.
struct InverseSolves {
  explicit InverseSolves(int n)
      : cloth(model::compile(scene_of({n, conditioned_borders[1]}))),
        A(reference::stage_matrix(cloth.ode, spring_step)),
        iterative(solver::linear_solver("ic0").make(), 10'000, *cloth.ode.work),
        direct(solver::linear_solver("cholesky").make(), 1, *cloth.ode.work) {
    inverse = Eigen::MatrixXd(A).llt().solve(Eigen::MatrixXd::Identity(A.rows(), A.cols()));
    for (solver::ConjugateGradients* system : {&iterative, &direct}) {
      system->analyse(A);
      system->factor(A);
    }
    b = A * any_solution(cloth.ode);
    r = d = b;
  }

  void solve(int way) {
    if (way == 0) {
      d.noalias() = inverse * b;
      return;
    }
    r = b;
    (way == 1 ? iterative : direct).solve(A, {}, r, d, error_reduction * b.norm());
  }

  model::Cloth cloth;
  solver::SparseMatrix A;
  solver::ConjugateGradients iterative, direct;
  Eigen::MatrixXd inverse;
  solver::Vectors b, r, d;
};

Inverse time_inverse(int n, bool quick) {
  InverseSolves system(n);
  const int times = quick ? 1 : std::max(1, 20'000 / (n * n)), repetitions = quick ? 3 : 15;
  std::vector<Repeated> ways;
  for (const int way : {0, 1, 2})
    ways.push_back({[&system, way, times] {
                      return [&system, way, times] {
                        for (int k = 0; k < times; ++k) system.solve(way);
                      };
                    },
                    repetitions});
  const auto measured = time_runs(ways, [] {});
  Inverse row{.particles = n * n};
  for (const int way : {0, 1, 2}) {
    row.medians[way] = 1e3 * base::quantile(measured[way], 0.5) / times;
    row.spreads[way] = 1e3 * (base::quantile(measured[way], 0.75) - base::quantile(measured[way], 0.25)) / 2 / times;
  }
  return row;
}

template <int way>
constexpr auto inverse_median = [](const Inverse& row) -> Datum { return row.medians[way]; };

constexpr ColumnOf<Inverse> inverse_columns[] = {
    {"particles", "N", "1", "particles of a sheet hung by one edge, implicit Euler, h = 0.01 s", Role::key,
     field<&Inverse::particles>},
    {"inverse", "inverse", "µs", "product of the dense inverse with three coordinates", Role::time, inverse_median<0>},
    {"ic0", "CG, IC(0)", "µs", "conjugate gradients to 2e-4 from no guess", Role::time, inverse_median<1>},
    {"cholesky", "factor", "µs", "substitution with the complete factor", Role::time, inverse_median<2>},
    {"verdict", "CG", "", "whether conjugate gradients are cheaper than the inverse, as the thesis says (3.3.4)", Role::verdict,
     [](const Inverse& row) { return results::to_datum(row.cheaper()); }},
};

const std::vector<int>& inverse_sizes(bool quick) {
  static const std::vector<int> all{5, 7, 10, 14, 20, 28, 36, 50}, few{5, 8};
  return quick ? few : all;
}

std::vector<Inverse> inverses(bool quick, Checkpoint& checkpoint) {
  std::vector<Inverse> rows;
  checkpoint.each(inverse_sizes(quick), [&](const int n) {
    const std::string id = fmt::format("dense inverse, {} particles", n * n);
    checkpoint.show(id);
    rows.push_back(checkpoint.timed(id, [&] { return time_inverse(n, quick); }));
    checkpoint.advance();
  });
  return rows;
}

}  // namespace

std::vector<Job> conditioning(const Question& question) {
  const bool quick = question.quick;
  const auto parts = static_cast<int>(systems(quick).size() * std::size(compared_solvers));
  return {
      job(
          "conditioning", parts, [quick](Checkpoint& checkpoint) { return conditions(quick, checkpoint); },
          [](const std::vector<Conditioned>& rows) {
            return results::make_table("conditioning",
                                       "Condition of a stage's matrix and the iterations of conjugate gradients, with (3.7)",
                                       conditioned_columns, rows);
          }),
      job(
          "inverse", static_cast<int>(inverse_sizes(quick).size()),
          [quick](Checkpoint& checkpoint) { return inverses(quick, checkpoint); },
          [](const std::vector<Inverse>& rows) {
            return results::make_table("inverse", "One solve: the dense inverse against sparse solvers", inverse_columns, rows);
          })};
}

}  // namespace drape::bench
