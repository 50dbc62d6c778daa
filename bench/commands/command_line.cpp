#include "bench/commands/command_line.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>
#include <system_error>

#include "bench/commands/argument_checks.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/help.hpp"
#include "bench/commands/plugin.hpp"
#include "bench/commands/shell_words.hpp"
#include "bench/runs/available_memory.hpp"
#include "bench/runs/interruption.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/atomic_file.hpp"
#include "solver/base/printable.hpp"

namespace drape::bench {
namespace {

constexpr int failure = 1;
constexpr int bad_input = 2;

/// Without a standard stream the next file that is opened would have its number, and what is printed would go there.
void open_standard_streams() {
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(fd, F_GETFD) < 0 && open("/dev/null", O_RDWR) < 0)  // NOLINT(android-cloexec-open): children have them as well
      throw std::system_error(errno, std::generic_category(), "/dev/null");
}

/// Throws std::system_error unless all that was printed went out.
void flush_output() {
  if (std::fflush(stdout) != 0) throw std::system_error(errno, std::generic_category(), "standard output");
}

/// The program as it was called: by its path, or by a script that stands for it.
std::string called_as(const char* path) {
  const std::string name = std::filesystem::path(path).filename();
  return name == "run" ? path : "bench_integrators";
}

std::string not_enough_memory(const CLI::App& app) {
  return fmt::format(
      "{}: not enough memory, {:.3g} GB are available: expected a smaller scene (grid.n), or fewer or smaller files",
      app.get_subcommands().empty() ? app.get_name() : app.get_subcommands().front()->get_name(), available_memory() / 1e9);
}

std::string farewell(const Interrupted& interrupted) {
  const std::string how =
      interrupted.out.empty()
          ? "nothing is recorded"
          : fmt::format("what is done is kept; continue by the same command with --resume --out {}", interrupted.out.string());
  return fmt::format("interrupted by {}; {}", interrupted.signal == SIGINT ? "SIGINT" : "SIGTERM", how);
}

}  // namespace

void add_commands(CLI::App& app, const SweepOptions& defaults, int& exit_code) {
  add_list(app);
  add_run(app, defaults);
  add_study(app, defaults);
  add_merge(app);
  add_inspect(app, exit_code);
  add_compare(app, exit_code);
  add_check(app, defaults, exit_code);
  add_forces(app, exit_code);
  add_report(app);
  add_export(app);
  add_fabric(app);
  add_pattern(app);
  add_score(app, defaults);
  add_peers(app);
  add_completion(app);
  add_man(app);
}

int run_command_line(int argc, const char* const* argv) {
  std::string command_line = "bench_integrators";
  for (int k = 1; k < argc; ++k) command_line += " " + shell_word(argv[k]);
  const std::string name = argc > 0 ? called_as(argv[0]) : "bench_integrators";
  // One line, in which what is quoted neither acts on the terminal nor fills it.
  const auto complain = [&](const std::string& message, int exit_code = bad_input) {
    constexpr std::size_t longest = 2000;
    fmt::print(stderr, "{}: {}\n", name, base::shortened(base::printable(message), longest));
    return exit_code;
  };
  CLI::App app(help_text("Runs time integrators of cloth side by side with a reference and records accuracy, work and time.\n"
                         "Without arguments: the main job, four studies and a report of them."),
               name);
  app.require_subcommand(0, 1);
  app.formatter(std::make_shared<HelpFormat>());
  app.set_version_flag("--version", version_text, "show the version");
  app.add_option_function<std::vector<std::string>>(
         "--plugin", [](const std::vector<std::string>& files) { std::ranges::for_each(files, load_plugin); },
         "load methods and forces from a shared library (repeatable; bench/plugin)")
      ->type_name("FILE.so")
      ->allow_extra_args(false);
  bool dry_run = false;
  add_main_job(app, dry_run);
  int exit_code = 0;
  SweepOptions defaults;
  defaults.command_line = command_line;
  add_commands(app, defaults, exit_code);
  app.footer(
      fmt::format("Examples:\n"
                  "  {0} run --scene hung-edge --method bdf2,sbdf2 --step 0.01,0.005\n"
                  "  {0} check bdf2/newton\n"
                  "  {0} study hung-sheets --out hung-sheets.h5 --format csv\n"
                  "  {0} compare before.h5 after.h5\n"
                  "  {0} run --help\n",
                  name));  // after the subcommands, which would inherit it
  note_interruptions();
  try {
    open_standard_streams();
    app.parse(argc, argv);
    if (app.get_subcommands().empty()) do_main_job(dry_run);
    flush_output();
    return exit_code;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    return complain(explanation(app, error));
  } catch (const std::invalid_argument& error) {
    return complain(error.what());
  } catch (const model::SceneError& error) {
    return complain(error.what());
  } catch (const base::FileError& error) {
    return complain(error.what());
  } catch (const Interrupted& interrupted) {
    return complain(farewell(interrupted), 128 + interrupted.signal);  // as a shell has it
  } catch (const std::filesystem::filesystem_error& error) {
    return complain(fmt::format("{}: cannot be used ({})", error.path1().string(), error.code().message()));
  } catch (const std::bad_alloc&) {
    return complain(not_enough_memory(app));
  } catch (const std::length_error&) {  // of a container: more than any machine has
    return complain(not_enough_memory(app));
  } catch (const std::exception& error) {  // no fault of the input: no place for the output
    return complain(error.what(), failure);
  }
}

}  // namespace drape::bench
