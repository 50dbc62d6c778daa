#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"
#include "solver/integrator.hpp"

/// What solves a stage of implicit Euler to a residual, with how much work: every stage solver on the same stages, those of one
/// trajectory, from the same guess.
namespace drape::bench {
namespace {

using results::ColumnOf;
using results::Datum;
using results::field;
using results::Role;
using results::Standing;

constexpr double stage_step = 0.01;           ///< [s]
constexpr double trajectory_accuracy = 1e-6;  ///< of the stages of the trajectory, over the error of its steps
constexpr int most_updates = 20'000;          ///< with little damping the loop is slow
constexpr double as_before = 0.2;             ///< relative difference from table 1c that counts as none
constexpr double residuals[] = {1e-1, 1e-2, 1e-5};

/// What a residual is compared with.
enum class Beside {
  right_hand_side,  ///< |b| of the linear system, as the program's tolerances
  inertia,          ///< |M (v + h g)|: no forces of the sheet in it
};

std::string_view to_string(Beside beside) { return beside == Beside::inertia ? "|M (v + h g)|" : "|b|"; }

/// A stage solver of the study. `radius`: assumed by Chebyshev's weights.
struct Solver {
  std::string_view kind;
  std::optional<double> radius = {};
};
constexpr Solver stage_solvers[] = {{"fixed-point"},
                                    {"printed-loop"},
                                    {"chebyshev", 0.9},
                                    {"chebyshev", 0.97},
                                    {"chebyshev", 0.99},
                                    {"chebyshev", 0.997},
                                    {"lbfgs"},
                                    {"anderson"},
                                    {"newton"},
                                    {"tension-newton"},
                                    {"vbd"}};

std::string name_of(const Solver& solver) {
  return solver.radius ? fmt::format("{} {:g}", solver.kind, *solver.radius) : std::string(solver.kind);
}

/// Mean updates a stage that another implementation of the same solvers took on the same sheet, from another guess: table 1c
/// of the survey with which this study began.
struct Known {
  std::string_view solver;
  double damping, residual, updates;
};
constexpr Known table_1c[] = {{"fixed-point", 50, 1e-5, 22.1},
                              {"fixed-point", 5, 1e-5, 132.8},
                              {"fixed-point", 0.5, 1e-5, 975.7},
                              {"fixed-point", 50, 1e-1, 2.3},
                              {"fixed-point", 50, 1e-2, 6.3},
                              {"fixed-point", 0.5, 1e-1, 16},
                              {"fixed-point", 0.5, 1e-2, 80},
                              {"chebyshev 0.9", 50, 1e-5, 21.9},
                              {"chebyshev 0.97", 50, 1e-5, 32.6},
                              {"chebyshev 0.99", 50, 1e-5, 50.5},
                              {"chebyshev 0.997", 50, 1e-5, 88},
                              {"chebyshev 0.9", 5, 1e-5, 55},
                              {"chebyshev 0.97", 5, 1e-5, 40},
                              {"chebyshev 0.99", 5, 1e-5, 64},
                              {"chebyshev 0.997", 5, 1e-5, 113},
                              {"chebyshev 0.9", 0.5, 1e-5, 425},
                              {"chebyshev 0.97", 0.5, 1e-5, 232},
                              {"chebyshev 0.99", 0.5, 1e-5, 121},
                              {"chebyshev 0.997", 0.5, 1e-5, 126},
                              {"lbfgs", 50, 1e-5, 10.6},
                              {"lbfgs", 5, 1e-5, 31.6},
                              {"lbfgs", 0.5, 1e-5, 97.2},
                              {"anderson", 50, 1e-5, 8.9},
                              {"anderson", 5, 1e-5, 23.5},
                              {"anderson", 0.5, 1e-5, 69.2},
                              {"anderson", 50, 1e-1, 1.9},
                              {"anderson", 50, 1e-2, 4.0},
                              {"anderson", 0.5, 1e-1, 4.9},
                              {"anderson", 0.5, 1e-2, 13.3},
                              {"vbd", 50, 1e-5, 1014},
                              {"vbd", 5, 1e-5, 900},
                              {"vbd", 0.5, 1e-5, 1153},
                              {"vbd", 50, 1e-1, 38},
                              {"vbd", 50, 1e-2, 142},
                              {"vbd", 0.5, 1e-1, 109},
                              {"vbd", 0.5, 1e-2, 205}};

/// Mean work of a stage solver on the stages of a trajectory.
struct StageWork {
  std::string solver, beside;
  double damping = 0, residual = 0;
  double updates = 0, most_updates = 0, forces = 0, substitutions = 0, newton_matrices = 0, ms = 0;
  std::int64_t failed = 0;
  std::optional<double> known = {};
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StageWork, solver, beside, damping, residual, updates, most_updates, forces, substitutions,
                                   newton_matrices, ms, failed, known)

std::optional<double> known_updates(const StageWork& work) {
  for (const Known& row : table_1c)
    if (work.solver == row.solver && work.damping == row.damping && work.residual == row.residual) return row.updates;
  return {};
}

std::optional<results::Verdict> verdict(const StageWork& work) {
  if (work.failed > 0) return results::Verdict{Standing::missed, fmt::format("{} stages not solved", work.failed)};
  if (!work.known) return {};
  const double ratio = work.updates / *work.known;
  if (std::abs(ratio - 1) <= as_before) return results::Verdict{Standing::met, "as in table 1c"};
  return results::Verdict{Standing::open, fmt::format("{:.2g} times table 1c", ratio)};
}

constexpr ColumnOf<StageWork> stage_columns[] = {
    {"damping", "d", "N s/m", "linear damping", Role::key, field<&StageWork::damping>},
    {"beside", "beside", "", "what the residual is compared with", Role::key, field<&StageWork::beside>},
    {"residual", "|r| <=", "1", "residual at which a stage ends, in this unit", Role::key, field<&StageWork::residual>},
    {"solver", "solver", "", "stage solver, with the spectral radius that Chebyshev's weights assume", Role::key,
     field<&StageWork::solver>},
    {"updates", "updates", "1", "updates or sweeps, mean of all stages", Role::counter, field<&StageWork::updates>},
    {"most_updates", "most", "1", "updates of the stage that took most", Role::counter, field<&StageWork::most_updates>},
    {"forces", "forces", "1", "evaluations of all forces, mean of all stages", Role::counter, field<&StageWork::forces>},
    {"substitutions", "subst.", "1", "substitutions in the factor of the constant matrix, mean", Role::counter,
     field<&StageWork::substitutions>},
    {"newton_matrices", "Jacobians", "1", "assemblies of the Newton matrix, mean", Role::counter,
     field<&StageWork::newton_matrices>},
    {"ms", "time", "ms", "wall time of a stage, mean", Role::time, field<&StageWork::ms>},
    {"known", "table 1c", "1", "updates of another implementation, from another guess", Role::note, field<&StageWork::known>},
    {"verdict", "verdict", "", "whether the updates are within a fifth of table 1c; unless all stages are solved, missed",
     Role::verdict, [](const StageWork& work) { return results::to_datum(verdict(work)); }},
};

model::Scene falling_sheet(double damping, bool quick) {
  std::vector<model::Override> overrides{{"material.damping", fmt::format("{}", damping)}};
  if (quick) overrides.push_back({"grid.n", "6"});
  return model::load_scene("hung-corners", overrides);
}

/// The states at the ends of implicit Euler's steps, the start among them, with stages solved by Newton's method.
std::vector<solver::State> trajectory(const model::Scene& scene, const model::Cloth& cloth, int steps) {
  RunSpec spec{scene, "", &solver::method("implicit-euler"), stage_step, {}};
  spec.options.stage = &solver::stage_kind("newton");
  spec.options.stage_accuracy = trajectory_accuracy;
  spec.scene.end = steps * stage_step;
  std::vector<solver::State> states;
  FunctionObserver keep([&](const solver::StepReport& step) { states.push_back(step.y); });
  Observer* const observers[] = {&keep};
  run(spec, cloth, observers);
  return states;
}

solver::Stage stage_from(const solver::State& y, std::size_t n) {
  return {stage_step, static_cast<double>(n + 1) * stage_step, y.x, y.v};
}

/// |b| where the stage begins, and what gravity makes of the momentum [N s].
struct Size {
  double b, inertia;
  double of(Beside beside) const { return beside == Beside::inertia ? inertia : b; }
};

std::vector<Size> sizes_of(const model::Cloth& cloth, const Eigen::Vector3d& gravity,
                           const std::vector<solver::State>& states) {
  solver::StageSystem system(cloth.ode, {}, nullptr);
  system.prepare(stage_step, 1);
  std::vector<Size> sizes;
  for (std::size_t n = 0; n + 1 < states.size(); ++n) {
    solver::State y = states[n];
    const solver::Stage stage = stage_from(states[n], n);
    system.evaluate(stage, nullptr, y);
    system.filter_residual(stage_step);
    solver::Vectors momentum = cloth.ode.mass.asDiagonal() * (y.v.rowwise() + stage_step * gravity.transpose());
    solver::filter(cloth.ode.pins, momentum);
    sizes.push_back({system.scale(stage, y).b, momentum.norm()});
  }
  return sizes;
}

solver::Options options_of(const Solver& solver, double residual) {
  solver::Options options;
  options.stage = &solver::stage_kind(solver.kind);
  options.linear_solver = &solver::linear_solver("cholesky");
  options.max_updates = most_updates;
  options.cg_tolerance = residual;  // the only one that the printed loop has
  options.chebyshev_radius = solver.radius.value_or(options.chebyshev_radius);
  return options;
}

/// All stages of a trajectory.
struct StagesOfSheet {
  model::Scene scene;
  double damping;
  std::vector<solver::State> states;
  std::vector<Size> sizes;
};

StagesOfSheet stages_of(double damping, bool quick) {
  StagesOfSheet all{falling_sheet(damping, quick), damping, {}, {}};
  const model::Cloth cloth = model::compile(all.scene);
  all.states = trajectory(all.scene, cloth, quick ? 10 : static_cast<int>(std::lround(all.scene.end / stage_step)));
  all.sizes = sizes_of(cloth, all.scene.sheet.gravity, all.states);
  return all;
}

/// Solves every stage from the velocities where its step begins.
StageWork solve_stages(const StagesOfSheet& stages, const Solver& solver, Beside beside, double residual) {
  using Clock = std::chrono::steady_clock;
  const model::Cloth cloth = model::compile(stages.scene);
  solver::StageSolver stage_solver(cloth.ode, options_of(solver, residual));
  StageWork work{name_of(solver), std::string(to_string(beside)), stages.damping, residual};
  const auto count = static_cast<double>(stages.sizes.size());
  for (std::size_t n = 0; n < stages.sizes.size(); ++n) {
    solver::Stage stage = stage_from(stages.states[n], n);
    stage.residual = residual * stages.sizes[n].of(beside);
    solver::State y = stages.states[n];
    const Clock::time_point begin = Clock::now();
    const solver::StageResult result = stage_solver.solve(stage, y);
    work.ms += std::chrono::duration<double, std::milli>(Clock::now() - begin).count() / count;
    work.updates += result.updates / count;
    work.most_updates = std::max<double>(work.most_updates, result.updates);
    work.failed += result.outcome != solver::Outcome::success;
  }
  const auto mean = [&](const char* kind) { return static_cast<double>(cloth.ode.work->count(kind)) / count; };
  work.forces = mean("forces");
  work.substitutions = mean("preconditioner_applications");
  work.newton_matrices = mean("newton_matrices");
  if (beside == Beside::inertia) work.known = known_updates(work);
  return work;
}

/// The printed loop ends by its own rule, beside its own |b|.
bool ends_beside(const Solver& solver, Beside beside) {
  return beside == Beside::right_hand_side || solver.kind != "printed-loop";
}

std::vector<double> dampings(bool quick) { return quick ? std::vector{5.0} : std::vector{50.0, 5.0, 0.5}; }

std::vector<StageWork> run_stages(bool quick, Checkpoint& checkpoint) {
  std::vector<StageWork> rows;
  checkpoint.each(dampings(quick), [&](const double damping) {
    const StagesOfSheet stages = stages_of(damping, quick);
    for (const Beside beside : {Beside::right_hand_side, Beside::inertia})
      for (const double residual : residuals)
        for (const Solver& solver : stage_solvers) {
          if (!ends_beside(solver, beside)) continue;
          const std::string id = fmt::format("{}, d = {}, {} {}", name_of(solver), damping, residual, to_string(beside));
          checkpoint.show(id);
          rows.push_back(checkpoint.timed(id, [&] { return solve_stages(stages, solver, beside, residual); }));
          if (quick) rows.back().known.reset();  // of another sheet
        }
    checkpoint.advance();
  });
  return rows;
}

results::Table stage_table(const std::vector<StageWork>& rows) {
  return results::make_table("stages",
                             "Stage solvers on the stages of implicit Euler, hung-corners, h = 0.01 s: work to a residual",
                             stage_columns, rows);
}

}  // namespace

std::vector<Job> stages(const Question& question) {
  const auto compute = [quick = question.quick](Checkpoint& checkpoint) { return run_stages(quick, checkpoint); };
  return {job("stages", static_cast<int>(dampings(question.quick).size()), compute, stage_table)};
}

}  // namespace drape::bench
