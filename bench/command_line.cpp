#include "bench/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <functional>

#include "bench/studies.hpp"
#include "bench/sweep.hpp"
#include "model/scene_file.hpp"
#include "results/run_file.hpp"
#include "results/table.hpp"

namespace drape::bench {
namespace {

constexpr int bad_input = 2;
constexpr double most_steps = 1e7;

/// What stands on the command line.
struct Arguments {
  std::string list_what;
  std::string scene;
  std::vector<std::string> methods;
  std::vector<double> steps;
  double until = 0;
  std::vector<std::string> sets;
  std::vector<double> control;
  solver::Options options;
  std::string study;
  bool quick = false;
  bool no_reference = false;
  int repeat = 3;
  std::string out;
  std::string format = "table";
  std::string command_line;
};

void list(const std::string& what) {
  if (what == "scenes")
    for (const model::BuiltinScene& scene : model::builtin_scenes()) fmt::print("{}\n", scene.name);
  if (what == "methods")
    for (const solver::Method& method : solver::methods()) fmt::print("{}\n", method.name);
  if (what == "studies")
    for (const Study& known : studies()) fmt::print("{}\n", known.name);
}

/// Checks what CLI11 cannot: numbers that belong together.
void check_steps(const Arguments& a, double end) {
  for (const double h : a.steps)
    if (!(end / h <= most_steps))
      throw std::invalid_argument(fmt::format("--step {}: expected at most {} steps to t = {} s", h, most_steps, end));
}

solver::StepControl step_control(const std::vector<double>& bounds) {
  if (bounds.empty()) return {};
  const double low = bounds[0], high = bounds[1];
  if (low != std::floor(low) || high != std::floor(high) || low < 0 || high < 1 || low > high || high > most_steps)
    throw std::invalid_argument("--control: expected whole numbers MIN MAX with 0 <= MIN <= MAX and MAX at least 1");
  return {.min_updates = static_cast<int>(low), .max_updates = static_cast<int>(high)};
}

std::vector<Group> run_groups(const Arguments& a) {
  std::vector<model::Override> overrides;
  for (const std::string& text : a.sets) overrides.push_back(model::parse_override(text));
  model::Scene scene = model::load_scene(a.scene, overrides);
  if (a.until > 0) scene.end = a.until;
  check_steps(a, scene.end);
  Cell cell{scene, fmt::format("{}", fmt::join(a.sets, " ")), nullptr, 0, a.options};
  cell.options.control = step_control(a.control);
  Group group;
  for (const std::string& name : a.methods) {
    cell.options.linear_solver = a.options.linear_solver;
    choose_method(cell, name);
    for (const double h : a.steps) {
      cell.step = h;
      group.push_back(cell);
    }
  }
  return {group};
}

void print(const std::vector<results::RunRecord>& runs, const Arguments& a, const std::filesystem::path& out) {
  if (a.format == "csv") {
    fmt::print("{}", results::to_csv(runs));
  } else if (a.format == "json") {
    fmt::print("{}\n", results::to_json(runs));
  } else {
    fmt::print("{}\nrecorded in {}\n", results::to_table(runs), out.string());
  }
}

void sweep_and_print(const std::vector<Group>& groups, const Arguments& a, const std::string& job) {
  SweepOptions options;
  options.repetitions = a.repeat;
  options.reference = !a.no_reference;
  options.command_line = a.command_line;
  options.out = a.out.empty() ? default_out(job) : std::filesystem::path(a.out);
  print(sweep(groups, options), a, options.out);
}

void add_output_options(CLI::App& command, Arguments& a) {
  command.add_option("--repeat", a.repeat, "timed repetitions of every run, interleaved")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command.add_option("--out", a.out, "HDF5 file to record in; must not exist [results/runs/<time>-<job>.h5]");
  command.add_option("--format", a.format, "what is printed")
      ->check(CLI::IsMember({"table", "csv", "json"}))
      ->capture_default_str();
  command.add_flag("--no-reference", a.no_reference, "measure no errors");
}

void add_run(CLI::App& app, Arguments& a) {
  CLI::App& run = *app.add_subcommand("run", "run methods on a scene and compare them with the reference");
  run.add_option("--scene", a.scene, "built-in scene or TOML file (keys: see below)")->required();
  run.add_option("--method", a.methods, "methods, each with /LINEAR_SOLVER if not the first: bdf2,sbdf2/cholesky")
      ->required()
      ->delimiter(',');
  run.add_option("--step", a.steps, "steps h in seconds")->required()->delimiter(',')->check(CLI::PositiveNumber);
  run.add_option("--until", a.until, "end time in seconds [the scene's]")->check(CLI::PositiveNumber);
  run.add_option("--set", a.sets, "override a key of the scene: --set key=value (repeatable)")->allow_extra_args(false);
  run.add_option("--loop-tolerance", a.options.loop_tolerance, "of the fixed-point loop, relative to |b|")
      ->check(CLI::Range(1e-15, 1.0))
      ->capture_default_str();
  run.add_option("--cg-tolerance", a.options.cg_tolerance, "of linear solves, relative to |b|; in the loop at most half of its")
      ->check(CLI::Range(1e-15, 1.0))
      ->capture_default_str();
  run.add_option("--max-updates", a.options.max_updates, "updates a step before it counts as not converged")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  run.add_option("--verlet-fraction", a.options.verlet_fraction, "sub-step of verlet over its stability limit")
      ->check(CLI::Range(1e-3, 1.0))
      ->capture_default_str();
  run.add_option("--control", a.control, "MIN MAX: step control by the number of updates a step")->expected(2);
  add_output_options(run, a);

  std::string footer = "Methods:\n";
  for (const solver::Method& method : solver::methods()) footer += fmt::format("  {:<16}{}\n", method.name, method.description);
  footer += "\nLinear solvers:\n";
  for (const solver::LinearSolver& solver : solver::linear_solvers())
    footer += fmt::format("  {:<16}{}\n", solver.name, solver.description);
  footer += "\nKeys of scenes:\n";
  for (const model::KeyHelp& key : model::scene_keys()) footer += fmt::format("  {:<31}{}\n", key.path, key.description);
  run.footer(footer);
  run.callback([&a] { sweep_and_print(run_groups(a), a, "run"); });
}

void add_study(CLI::App& app, Arguments& a) {
  CLI::App& command = *app.add_subcommand("study", "run one of the studies");
  std::string names = "Studies:\n";
  for (const Study& known : studies()) names += fmt::format("  {:<16}{}\n", known.name, known.description);
  command.add_option("name", a.study, "its name")->required();
  command.add_flag("--quick", a.quick, "a short form, for tests");
  add_output_options(command, a);
  command.footer(names);
  command.callback([&a] { sweep_and_print(study(a.study).groups(a.quick), a, a.study); });
}

void add_list(CLI::App& app, Arguments& a) {
  CLI::App& command = *app.add_subcommand("list", "names of scenes, methods or studies, one a line");
  command.add_option("what", a.list_what, "scenes, methods or studies")
      ->required()
      ->check(CLI::IsMember({"scenes", "methods", "studies"}));
  command.callback([&a] { list(a.list_what); });
}

int complain(const std::string& message) {
  fmt::print(stderr, "bench_integrators: {}\n", message);
  return bad_input;
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  Arguments a;
  for (int k = 0; k < argc; ++k) a.command_line += (k > 0 ? " " : "") + std::string(argv[k]);
  CLI::App app(
      "Runs time integrators of cloth side by side with a reference and records accuracy, work and time.\n"
      "Without arguments: the study hung-sheets.",
      "bench_integrators");
  app.require_subcommand(0, 1);
  add_list(app, a);
  add_run(app, a);
  add_study(app, a);
  try {
    app.parse(argc, argv);
    if (app.get_subcommands().empty()) sweep_and_print(studies().front().groups(false), a, std::string(studies().front().name));
    return 0;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    return complain(error.what());
  } catch (const std::invalid_argument& error) {
    return complain(error.what());
  } catch (const model::SceneError& error) {
    return complain(error.what());
  } catch (const results::FileError& error) {
    return complain(error.what());
  }
}

}  // namespace drape::bench
