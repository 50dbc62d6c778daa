#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "bench/commands/argument_checks.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/names_of.hpp"
#include "bench/commands/output.hpp"
#include "bench/commands/report.hpp"
#include "bench/commands/scene_choice.hpp"
#include "bench/runs/automatic.hpp"
#include "bench/runs/frames.hpp"
#include "bench/runs/verbosity.hpp"
#include "model/cloth.hpp"
#include "solver/base/atomic_file.hpp"
#include "solver/base/threads.hpp"

namespace drape::bench {
namespace {

constexpr double most_steps = 1e7;
constexpr std::size_t most_runs = 1000;

struct RunArguments {
  SceneChoice choice;
  std::vector<std::string> methods;
  std::vector<double> steps;
  std::optional<double> until;
  std::vector<int> control;
  solver::Options options;
  double tolerance = 0;
  double accuracy = 0;  ///< for the method auto
  int threads = 1;
  Frames frames;
  std::string report;  ///< folder of a page about the runs; empty: none
  Output output;
};

/// Checks what CLI11 cannot: numbers that belong together.
void check_steps(const RunArguments& a, double end) {
  if (const std::size_t runs = a.methods.size() * a.steps.size(); runs > most_runs)
    throw std::invalid_argument(fmt::format("--method, --step: expected at most {} runs, not {} methods with {} steps",
                                            most_runs, a.methods.size(), a.steps.size()));
  for (const double h : a.steps)
    if (!(end / h <= most_steps))
      throw std::invalid_argument(fmt::format("--step: expected at most {:g} steps to t = {:g} s, so at least {:g}, not {:g}",
                                              most_steps, end, end / most_steps, h));
}

solver::StepControl step_control(const std::vector<int>& bounds) {
  if (bounds.empty()) return {};
  const int low = bounds[0], high = bounds[1];
  if (low > high || high == 0)
    throw std::invalid_argument(fmt::format("--control: expected MIN <= MAX and MAX at least 1, not {} {}", low, high));
  return {.min_updates = low, .max_updates = high};
}

std::string for_obstacles() { return names_of(solver::methods(), std::mem_fn(&solver::Method::meets_obstacles)); }

/// The elastic forces without a mean force that keep the method from the scene; empty if none does.
std::string in_the_way(const solver::Method& method, const model::Scene& scene) {
  return method.needs_energies ? fmt::format("{}", fmt::join(model::forces_without_energy(scene), ", ")) : "";
}

/// "all" is every method that the scene is for, with the chosen stage and linear solvers.
std::vector<std::string> named_methods(const std::vector<std::string>& names, const model::Scene& scene) {
  if (names != std::vector<std::string>{"all"}) return names;
  std::vector<std::string> all;
  for (const solver::Method& method : solver::methods())
    if (reason_against(method, scene).empty()) all.emplace_back(method.name);
  return all;
}

std::string ending_after_passes() {
  return names_of(solver::stage_kinds(), [](const solver::StageKind& kind) { return !kind.accelerated; });
}

constexpr const char* automatic = "auto";  ///< in the place of a method

/// Whether the program is to choose the method. The name and what it needs come together.
bool chooses(const RunArguments& a) {
  const bool named = std::ranges::find(a.methods, automatic) != a.methods.end();
  if (named && a.methods.size() > 1) throw std::invalid_argument("--method: expected auto alone, or methods without it");
  if (named && a.accuracy == 0) throw std::invalid_argument("--method auto: expected --accuracy beside it");
  if (!named && a.accuracy > 0) throw std::invalid_argument("--accuracy: expected --method auto beside it");
  if (!named && a.steps.empty()) throw std::invalid_argument("--step is required, except with --method auto");
  return named;
}

/// One run, by what is chosen.
Group chosen_group(RunSpec spec, double accuracy) {
  choose_automatically(spec, accuracy);
  say_note(fmt::format("auto: {}", spec.choice->reason));
  return {spec};
}

/// All methods with all steps.
Group run_group(const RunArguments& a) {
  model::Scene scene = a.choice.load();
  scene.end = a.until.value_or(scene.end);
  check_steps(a, scene.end);
  RunSpec spec{scene, fmt::format("{}", fmt::join(a.choice.sets, " ")), nullptr, 0, a.options};
  spec.options.control = step_control(a.control);
  spec.options.error_control = {a.tolerance, model::size(scene), scene.end, !model::has_contacts(scene)};
  if (chooses(a)) return chosen_group(spec, a.accuracy);
  Group group;
  for (const std::string& name : named_methods(a.methods, scene)) {
    spec.options.stage = a.options.stage;
    spec.options.linear_solver = a.options.linear_solver;
    spec.options.sub_steps = a.options.sub_steps;
    spec.options.sweeps = a.options.sweeps;
    choose_method(spec, name);
    if (!scene.obstacles.empty() && !spec.method->meets_obstacles)
      throw std::invalid_argument(
          fmt::format("method '{}': expected one of {} in a scene with obstacles", name, for_obstacles()));
    if (alters_positions(scene) && !spec.method->implicit())
      throw std::invalid_argument(
          fmt::format("method '{}': expected one with implicit stages for contact.response = \"alteration\"", name));
    if (a.options.passes > 0 && spec.method->nonlinear() && spec.options.stage->accelerated)
      throw std::invalid_argument(fmt::format("--passes: method '{}': expected one of the stage solvers {}, not {}", name,
                                              ending_after_passes(), spec.options.stage->name));
    if (const std::string forces = in_the_way(*spec.method, scene); !forces.empty())
      throw std::invalid_argument(fmt::format("method '{}': expected elastic forces with mean forces, not {}", name, forces));
    for (const double h : a.steps) {
      spec.step = h;
      group.push_back(spec);
    }
  }
  return group;
}

void run(const RunArguments& a) {
  if (a.output.sweep.shard && (!a.frames.folder.empty() || !a.report.empty()))
    throw std::invalid_argument(fmt::format("{} cannot be combined with --shard: it is for all runs",
                                            a.frames.folder.empty() ? "--report" : "--frames"));
  base::use_threads(a.threads);
  const std::vector<Group> groups{run_group(a)};
  Output output = a.output;
  if (!a.frames.folder.empty() && !output.dry_run) {
    if (output.sweep.start == results::Start::resumed)
      throw std::invalid_argument("--frames cannot be combined with --resume: frames of finished runs are not rewritten");
    output.sweep.out = out_file(output, "run");
    base::require_creatable(output.sweep.out);  // before a folder is made
    base::create_folder(a.frames.folder);
    base::require_empty_folder(a.frames.folder, "the frames");
    output.sweep.observer_for = [&](const RunSpec& spec) { return frame_writer(spec, a.frames); };
  }
  if (a.report.empty()) {
    sweep_and_print(groups, output, "run");
    return;
  }
  if (output.format != "table")
    throw std::invalid_argument("--report: expected --format table beside it, which it prints as well");
  constexpr double frame_spacing = 0.04;  // [s]
  if (!output.sweep.frames_every) output.sweep.frames_every = frame_spacing;
  base::create_folder(a.report);
  report({sweep_and_print(groups, output, "run")}, a.report);
}

/// What the method auto takes, instead of steps and of all that decides how accurate a method is.
void add_accuracy(CLI::App& command, double& accuracy) {
  CLI::Option* option =
      command
          .add_option("--accuracy", accuracy,
                      "with --method auto: the largest error of positions over the run that is allowed, over the scene's size")
          ->option_text("X")
          ->check(between(finest_accuracy, coarsest_accuracy));
  for (const char* other :
       {"--step", "--loop-tolerance", "--verlet-fraction", "--tolerance", "--stage-accuracy", "--passes", "--control"})
    option->excludes(other);
}

void add_solver_options(CLI::App& command, RunArguments& a) {
  command.add_option("--loop-tolerance", a.options.loop_tolerance, "of the fixed-point loop, relative to |b|")
      ->type_name("X")
      ->check(between(1e-15, 1.0))
      ->capture_default_str();
  command
      .add_option("--cg-tolerance", a.options.cg_tolerance,
                  "of linear solves, relative to |b|; in the loop at most half of its")
      ->type_name("X")
      ->check(between(1e-15, 1.0))
      ->capture_default_str();
  command.add_option("--max-updates", a.options.max_updates, "updates a step before it counts as not converged")
      ->type_name("N")
      ->check(between(1, 1000000))
      ->capture_default_str();
  command
      .add_option("--verlet-fraction", a.options.verlet_fraction,
                  "sub-step of verlet, rk4-substeps, bridson and strain-limited over its stability limit")
      ->type_name("X")
      ->check(between(1e-3, 1.0))
      ->capture_default_str();
  CLI::Option* tolerance =
      command
          .add_option(
              "--tolerance", a.tolerance,
              "of the error of positions over the scene's size, as pilot runs measure it, steps being --step at most; with "
              "obstacles of the local error")
          ->type_name("X")
          ->check(between(1e-15, 1.0));
  command.add_option("--stage-accuracy", a.options.stage_accuracy, "error left in a stage over the error of the time step")
      ->type_name("X")
      ->check(between(1e-9, 1.0))
      ->capture_default_str();
  command.add_option("--passes", a.options.passes, "updates after which a stage counts as solved, whatever its residual")
      ->type_name("M")
      ->check(between(1, 1000000));
  command.add_flag("--events", a.options.ends_at_kinks, "ends steps at kinks of forces that remember the motion");
  command.add_option("--control", a.control, "step control by the number of updates a step")
      ->option_text("MIN MAX")
      ->check(between(0, 1000000))
      ->expected(2)
      ->excludes(tolerance);
}

void add_thread_option(CLI::App& run, RunArguments& a) {
  run.add_option("--threads", a.threads, "that large sheets may use; results are the same for any number")
      ->type_name("N")
      ->check(between(1, base::max_threads))
      ->capture_default_str();
}

void add_frame_options(CLI::App& run, RunArguments& a) {
  CLI::Option* folder = run.add_option("--frames", a.frames.folder, "new folder for the runs as sequences of OBJ meshes")
                            ->type_name("FOLDER")
                            ->check(output_name());
  run.add_option("--every", a.frames.every, "simulated seconds between two frames")
      ->type_name("SECONDS")
      ->check(positive())
      ->needs(folder)
      ->capture_default_str();
}

}  // namespace

void add_run(CLI::App& app, const SweepOptions& defaults) {
  CLI::App& command = *app.add_subcommand("run", "run methods on a scene and compare them with the reference");
  const auto a = std::make_shared<RunArguments>();
  a->output.sweep = defaults;
  add_scene_option(command, a->choice);
  command
      .add_option(
          "--method", a->methods,
          "methods, with /STAGE_SOLVER and /LINEAR_SOLVER if not the first: bdf2,sbdf2/ic0,bdf2/newton; with sub-steps and "
          "sweeps: xpbd/4x5,kang/30; or all; or auto, which chooses by --accuracy and says why")
      ->required()
      ->type_name("A,B")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_option("--step", a->steps, "steps h in seconds")
      ->type_name("H1,H2")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(positive());
  command.add_option("--until", a->until, "end time in seconds [the scene's]")->type_name("T")->check(positive());
  add_overrides(command, a->choice);
  add_solver_options(command, *a);
  add_accuracy(command, a->accuracy);
  add_thread_option(command, *a);
  add_frame_options(command, *a);
  add_output_options(command, a->output);
  command
      .add_option("--report", a->report, "folder for a page of these runs with their motions, as the command report makes it")
      ->type_name("DIR")
      ->check(output_name());
  command.callback([=] { run(*a); });
}

}  // namespace drape::bench
