#include "bench/command_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <functional>
#include <optional>
#include <system_error>

#include "bench/argument_checks.hpp"
#include "bench/choices.hpp"
#include "bench/frames.hpp"
#include "bench/plot.hpp"
#include "bench/studies.hpp"
#include "bench/sweep.hpp"
#include "bench/table_jobs.hpp"
#include "model/scene_file.hpp"
#include "results/atomic_file.hpp"
#include "results/run_file.hpp"
#include "results/runs_table.hpp"
#include "solver/named.hpp"
#include "solver/threads.hpp"

namespace drape::bench {
namespace {

constexpr int failure = 1;
constexpr int bad_input = 2;
constexpr double most_steps = 1e7;

/// What stands on the command line.
struct Arguments {
  std::string list_kind;
  std::string scene;
  std::vector<std::string> methods;
  std::vector<double> steps;
  std::optional<double> until;
  std::vector<std::string> sets;
  std::vector<int> control;
  solver::Options options;
  double tolerance = 0;
  int threads = 1;
  std::string study;
  bool quick = false;
  bool no_reference = false;
  double agreement = SweepOptions().agreement;
  int repeat = 3;
  std::string out;
  std::string format = "table";
  Frames frames;
  std::string command_line;
};

struct Kind {
  std::string_view name;
  Choices (*choices)();
};
constexpr Kind kinds[] = {{"scenes", scene_choices}, {"methods", method_choices}, {"studies", study_choices}};

/// The names of one kind for programs, or all kinds for people.
void list(const std::string& kind) {
  if (kind.empty()) {
    std::string_view separator;
    for (const Kind& any : kinds) fmt::print("{}{}", std::exchange(separator, "\n"), paragraph(any.name, any.choices()));
    return;
  }
  for (const Choice& choice : solver::find_named(std::span<const Kind>(kinds), "kind of names", kind).choices())
    fmt::print("{}\n", choice.name);
}

/// Checks what CLI11 cannot: numbers that belong together.
void check_steps(const Arguments& a, double end) {
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

/// The names of those for which something holds, for a message.
template <class Row, class Holds>
std::string names_of(std::span<const Row> table, Holds holds) {
  std::vector<std::string_view> names;
  for (const Row& row : table)
    if (holds(row)) names.push_back(row.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The studies that can be made of any scene.
std::string of_any_scene() {
  return names_of(studies(), [](const Study& study) { return study.of_scene != nullptr; });
}

std::string for_obstacles() { return names_of(solver::methods(), std::mem_fn(&solver::Method::meets_obstacles)); }

model::Scene chosen_scene(const Arguments& a) {
  std::vector<model::Override> overrides;
  for (const std::string& text : a.sets) overrides.push_back(model::parse_override(text));
  return model::load_scene(a.scene, overrides);
}

std::vector<Group> run_groups(const Arguments& a) {
  model::Scene scene = chosen_scene(a);
  scene.end = a.until.value_or(scene.end);
  check_steps(a, scene.end);
  Cell cell{scene, fmt::format("{}", fmt::join(a.sets, " ")), nullptr, 0, a.options};
  cell.options.control = step_control(a.control);
  cell.options.error_control = {a.tolerance, model::size(scene), scene.end};
  Group group;
  for (const std::string& name : a.methods) {
    cell.options.stage = a.options.stage;
    cell.options.linear_solver = a.options.linear_solver;
    choose_method(cell, name);
    if (!scene.obstacles.empty() && !cell.method->meets_obstacles)
      throw std::invalid_argument(
          fmt::format("method '{}': expected one of {} in a scene with obstacles", name, for_obstacles()));
    for (const double h : a.steps) {
      cell.step = h;
      group.push_back(cell);
    }
  }
  return {group};
}

void print_table(const results::Table& table, const std::string& format) {
  fmt::print("{}", format == "csv" ? to_csv(table) : format == "json" ? to_json(table) : to_text(table));
}

/// Tables under their descriptions; as CSV under their names; as JSON in one object.
void print_tables(const std::vector<results::Table>& tables, const std::string& format) {
  if (format == "json") {
    fmt::print("{}", results::to_json(std::span(tables)));
    return;
  }
  for (const results::Table& table : tables) {
    if (format == "table" && std::ranges::all_of(table.columns, [](const auto& column) { return column.title.empty(); }))
      continue;  // for the file
    fmt::print("{}{}\n", format == "csv" ? "# " : "\n", format == "csv" ? table.name : table.description);
    print_table(table, format);
  }
}

void say_where(const std::filesystem::path& out, const std::string& format) {
  if (format == "table") fmt::print("\nrecorded in {}\n", out.string());
}

std::filesystem::path out_file(const Arguments& a, const std::string& job) {
  return a.out.empty() ? default_out(job) : std::filesystem::path(a.out);
}

void sweep_and_print(const std::vector<Group>& groups, const Arguments& a, const std::string& job) {
  SweepOptions options;
  options.repetitions = a.repeat;
  options.reference = !a.no_reference;
  options.agreement = a.agreement;
  options.command_line = a.command_line;
  options.out = out_file(a, job);
  if (!a.frames.folder.empty()) {
    results::require_creatable(options.out);  // before a folder is made
    make_folder(a.frames);
    options.look = [&](const Cell& cell) { return frame_writer(cell, a.frames); };
  }
  print_table(results::to_table(sweep(groups, options)), a.format);
  say_where(options.out, a.format);
}

std::vector<TableJob> table_jobs(const Study& chosen, const Arguments& a) {
  if (a.scene.empty()) return chosen.tables(a.quick);
  return chosen.of_scene(chosen_scene(a), a.quick);
}

void check_scene(const Study& chosen, const Arguments& a) {
  if (!a.scene.empty() && chosen.of_scene == nullptr)
    throw std::invalid_argument(
        fmt::format("--scene: the study {} has scenes of its own; it is for {}", chosen.name, of_any_scene()));
  if (a.scene.empty() && !a.sets.empty()) throw std::invalid_argument("--set: expected --scene beside it");
}

void run_study(const Study& chosen, const Arguments& a) {
  check_scene(chosen, a);
  const std::string name(chosen.name);
  if (chosen.groups) return sweep_and_print(chosen.groups(a.quick), a, name);
  const std::vector<TableJob> jobs = table_jobs(chosen, a);
  const std::filesystem::path out = out_file(a, name);
  const auto tables = compute(jobs, out, a.command_line);
  print_tables(tables, a.format);
  say_where(out, a.format);
  if (chosen.plot.empty()) return;
  const std::string said = plot(chosen.plot, out);
  if (a.format == "table") fmt::print("{}", said);
}

void add_output_options(CLI::App& command, Arguments& a) {
  command.add_option("--repeat", a.repeat, "timed repetitions of every run, interleaved")
      ->type_name("R")
      ->check(between(1, 1000))
      ->capture_default_str();
  command.add_option("--out", a.out, "HDF5 file to record in; must not exist [results/runs/<time>-<job>-<process>.h5]")
      ->type_name("FILE.h5")
      ->check(not_empty());
  command.add_option("--format", a.format, "what is printed")
      ->type_name("table|csv|json")
      ->check(CLI::IsMember({"table", "csv", "json"}).description(""))
      ->capture_default_str();
  command.add_flag("--no-reference", a.no_reference, "measure no errors");
  command
      .add_option("--agreement", a.agreement,
                  "largest disagreement of the two solvers behind a reference, over the scene's size")
      ->type_name("X")
      ->check(between(1e-15, 1.0))
      ->capture_default_str();
}

void add_solver_options(CLI::App& command, Arguments& a) {
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
  command.add_option("--verlet-fraction", a.options.verlet_fraction, "sub-step of verlet over its stability limit")
      ->type_name("X")
      ->check(between(1e-3, 1.0))
      ->capture_default_str();
  CLI::Option* tolerance =
      command
          .add_option("--tolerance", a.tolerance, "of the local error over the scene's size: steps of --step at most follow it")
          ->type_name("X")
          ->check(between(1e-15, 1.0));
  command.add_option("--stage-accuracy", a.options.stage_accuracy, "error left in a stage over the error of the time step")
      ->type_name("X")
      ->check(between(1e-9, 1.0))
      ->capture_default_str();
  command.add_option("--control", a.control, "step control by the number of updates a step")
      ->option_text("MIN MAX")
      ->check(between(0, 1000000))
      ->expected(2)
      ->excludes(tolerance);
}

void add_thread_option(CLI::App& run, Arguments& a) {
  run.add_option("--threads", a.threads, "that the linear algebra of large grids may use")
      ->type_name("N")
      ->check(between(1, solver::max_threads))
      ->capture_default_str();
}

void add_frame_options(CLI::App& run, Arguments& a) {
  CLI::Option* folder = run.add_option("--frames", a.frames.folder, "new folder for the runs as sequences of OBJ meshes")
                            ->type_name("FOLDER")
                            ->check(not_empty());
  run.add_option("--every", a.frames.every, "simulated seconds between two frames")
      ->type_name("SECONDS")
      ->check(positive())
      ->needs(folder)
      ->capture_default_str();
}

void add_run(CLI::App& app, Arguments& a) {
  CLI::App& run = *app.add_subcommand("run", "run methods on a scene and compare them with the reference");
  run.add_option("--scene", a.scene, "built-in scene or TOML file")->required()->type_name("NAME|FILE.toml");
  run.add_option("--method", a.methods,
                 "methods, with /STAGE_SOLVER and /LINEAR_SOLVER if not the first: bdf2,sbdf2/ic0,bdf2/newton")
      ->required()
      ->type_name("A,B")
      ->delimiter(',')
      ->allow_extra_args(false);
  run.add_option("--step", a.steps, "steps h in seconds")
      ->required()
      ->type_name("H1,H2")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(positive());
  run.add_option("--until", a.until, "end time in seconds [the scene's]")->type_name("T")->check(positive());
  run.add_option("--set", a.sets, "override a key of the scene (repeatable)")->type_name("key=value")->allow_extra_args(false);
  add_solver_options(run, a);
  add_thread_option(run, a);
  add_frame_options(run, a);
  add_output_options(run, a);
  run.footer(fmt::format("{}\n{}\n{}\n{}\n{}", paragraph("Scenes", scene_choices()), paragraph("Methods", method_choices()),
                         paragraph("Stage solvers", stage_solver_choices()),
                         paragraph("Linear solvers", linear_solver_choices()),
                         paragraph("Keys of scenes", scene_key_choices())));
  run.callback([&a] {
    solver::use_threads(a.threads);
    sweep_and_print(run_groups(a), a, "run");
  });
}

void add_study(CLI::App& app, Arguments& a) {
  CLI::App& command = *app.add_subcommand("study", "run one of the studies");
  command.add_option("NAME", a.study, "its name")->required()->type_name("");
  command.add_flag("--quick", a.quick, "a short form, for tests");
  command
      .add_option("--scene", a.scene,
                  fmt::format("a scene, by name or TOML file, instead of the study's own ({})", of_any_scene()))
      ->type_name("SCENE")
      ->check(not_empty());
  command.add_option("--set", a.sets, "override a key of that scene (repeatable)")
      ->type_name("key=value")
      ->allow_extra_args(false);
  add_output_options(command, a);
  command.footer(paragraph("Studies", study_choices()));
  command.callback([&a] { run_study(study(a.study), a); });
}

void add_list(CLI::App& app, Arguments& a) {
  CLI::App& command = *app.add_subcommand("list", "names of scenes, methods or studies, one a line");
  command.add_option("KIND", a.list_kind, "scenes, methods or studies [all, with descriptions]")->type_name("");
  command.callback([&a] { list(a.list_kind); });
}

/// Throws std::system_error unless all that was printed went out.
void flush_output() {
  if (std::fflush(stdout) != 0) throw std::system_error(errno, std::generic_category(), "standard output");
}

int complain(const std::string& message, int exit_code = bad_input) {
  fmt::print(stderr, "bench_integrators: {}\n", message);
  return exit_code;
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
  app.footer(
      "Examples:\n"
      "  bench_integrators run --scene hung-edge --method bdf2,sbdf2 --step 0.01,0.005 --set material.damping=0.5\n"
      "  bench_integrators study hung-sheets --out hung-sheets.h5 --format csv\n"
      "  bench_integrators run --help\n");  // after the subcommands, which would inherit it
  try {
    app.parse(argc, argv);
    if (app.get_subcommands().empty()) run_study(studies().front(), a);
    flush_output();
    return 0;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    return complain(explanation(app, error));
  } catch (const std::invalid_argument& error) {
    return complain(error.what());
  } catch (const model::SceneError& error) {
    return complain(error.what());
  } catch (const results::FileError& error) {
    return complain(error.what());
  } catch (const std::exception& error) {  // no fault of the input: no memory, no place for the output
    return complain(error.what(), failure);
  }
}

}  // namespace drape::bench
