#include "bench/commands/output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "bench/commands/argument_checks.hpp"
#include "bench/commands/choices.hpp"
#include "bench/commands/dry_run.hpp"
#include "bench/runs/verbosity.hpp"
#include "results/analysis/runs_table.hpp"
#include "results/file/xdmf.hpp"
#include "results/screen.hpp"
#include "solver/base/printable.hpp"
#include "solver/base/terminal.hpp"
#include "solver/linear/pattern_cache.hpp"

namespace drape::bench {
namespace {

bool all_columns = false;

results::Screen screen() {
  results::Screen screen{.colours = base::wants_colours(STDOUT_FILENO)};
  if (!all_columns && isatty(STDOUT_FILENO) == 1) screen.columns = static_cast<std::size_t>(base::columns_of(STDOUT_FILENO));
  return screen;
}

}  // namespace

void print_text(const results::Table& table) { fmt::print("{}", to_text(table, screen())); }

void print_table(const results::Table& table, const std::string& format) {
  if (format == "table") return print_text(table);
  fmt::print("{}", format == "csv" ? to_csv(table) : to_json(table));
}

void print_tables(const std::vector<results::Table>& tables, const std::string& format) {
  if (format == "json") {
    fmt::print("{}", results::to_json(std::span(tables)));
    return;
  }
  for (const results::Table& table : tables) {
    if (format == "table" && table.for_file) continue;
    fmt::print("{}{}\n", format == "csv" ? "# " : "\n", base::printable(format == "csv" ? table.name : table.description));
    print_table(table, format);
  }
}

void say_end(const std::filesystem::path& out, const std::string& format) {
  if (format == "table") fmt::print("\nrecorded in {}\n", base::printable(out.string()));
  if (verbosity() != Verbosity::verbose) return;
  const auto [computed, shared] = solver::pattern_counts();
  say_note(fmt::format("{} patterns of matrices were ordered, {} times the order was known", computed, shared));
}

std::filesystem::path out_file(const Output& output, const std::string& job) {
  return output.sweep.out.empty() ? default_out(job) : output.sweep.out;
}

std::filesystem::path sweep_and_print(const std::vector<Group>& groups, Output output, const std::string& job) {
  if (output.dry_run) {
    print_plan(groups, output.sweep, job);
    return {};
  }
  output.sweep.out = out_file(output, job);
  if (output.sweep.shard) {
    fmt::print("{}\n", base::printable(compute_shard(groups, output.sweep)));
    return {};
  }
  print_table(results::to_table(sweep(groups, output.sweep)), output.format);
  say_end(output.sweep.out, output.format);
  if (output.sweep.frames_every && output.format == "table")
    fmt::print("motion for ParaView: {}\n", base::printable(results::xdmf_path(output.sweep.out).string()));
  return output.sweep.out;
}

void add_verbosity_options(CLI::App& command) {
  CLI::Option* quiet = command.add_flag_callback(
      "-q,--quiet", [] { set_verbosity(Verbosity::quiet); }, "say nothing on standard error but what is wrong");
  command
      .add_flag_callback(
          "-v,--verbose", [] { set_verbosity(Verbosity::verbose); },
          "also say on standard error what is done when, a line each")
      ->excludes(quiet);
}

void add_wide_option(CLI::App& command) {
  command.add_flag_callback(
      "--wide", [] { all_columns = true; }, "tables with all columns, however wide the terminal is");
}

void add_format_option(CLI::App& command, std::string& format) {
  const std::vector<std::string> formats = names(format_choices());
  command.add_option("--format", format, "what is printed")
      ->type_name(fmt::format("{}", fmt::join(formats, "|")))
      ->check(one_of("format", formats))
      ->capture_default_str();
  add_wide_option(command);
}

void add_agreement(CLI::App& command, double& agreement) {
  command
      .add_option("--agreement", agreement, "largest disagreement of the two solvers behind a reference, over the scene's size")
      ->type_name("X")
      ->check(between(1e-15, 1.0))
      ->capture_default_str();
}

void add_record_options(CLI::App& command, Output& output) {
  command
      .add_option("--out", output.sweep.out,
                  "HDF5 file to record in; must not exist, except with --resume [results/runs/<time>-<job>-<process>.h5]")
      ->type_name("FILE.h5")
      ->check(output_name());
  command
      .add_flag_callback(
          "--resume", [&] { output.sweep.start = results::Start::resumed; },
          "continue FILE.h5 where a process before this one was killed; without one, begin it")
      ->needs("--out");
  add_format_option(command, output.format);
  add_verbosity_options(command);
}

void add_table_options(CLI::App& command, Output& output) {
  command.add_option("--repeat", output.sweep.repetitions, "timed repetitions of every run, interleaved")
      ->type_name("R")
      ->check(between(1, 1000))
      ->capture_default_str();
  add_record_options(command, output);
  add_agreement(command, output.sweep.agreement);
}

void add_output_options(CLI::App& command, Output& output) {
  add_table_options(command, output);
  command
      .add_option_function<std::string>(
          "--shard", [&](const std::string& text) { output.sweep.shard = share_named(text); },
          "only part i of n of the sweep, begun or continued, in FILE.h5.shard-i-of-n.journal; merge makes FILE.h5 of all n")
      ->type_name("i/n")
      ->check(shard_name())
      ->needs("--out");
  command.add_flag("-n,--dry-run", output.dry_run, "only say how much would be computed, and how long that may take");
  command
      .add_option("--time-limit", output.sweep.limits.seconds, "wall time of a run, which ends as out of time beyond it [none]")
      ->type_name("SECONDS")
      ->check(positive());
  command
      .add_option("--memory-limit", output.sweep.limits.megabytes,
                  "memory of a run, which ends as out of memory beyond it [none]")
      ->type_name("MB")
      ->check(positive());
  command.add_flag_callback(
      "--no-reference", [&] { output.sweep.reference = false; }, "measure no errors");
  command
      .add_option_function<std::string>(
          "--trajectory", [&](const std::string& text) { output.sweep.frames_every = seconds_every(text); },
          "keep the motion of every run in frames so far apart; ParaView opens FILE.h5.xdmf")
      ->type_name("every=SECONDS")
      ->check(every_seconds());
}

}  // namespace drape::bench
