#pragma once

#include <CLI/CLI.hpp>

#include "bench/runs/sweep_options.hpp"

/// The subcommands of bench_integrators, each in a file of its own: its options, and what it does once they are parsed.
namespace drape::bench {

void add_list(CLI::App& app);
void add_merge(CLI::App& app);
void add_report(CLI::App& app);
void add_export(CLI::App& app);
void add_fabric(CLI::App& app);
void add_pattern(CLI::App& app);
void add_peers(CLI::App& app);
void add_completion(CLI::App& app);
void add_man(CLI::App& app);

/// `defaults`: how sweeps are recorded where no option says otherwise.
void add_run(CLI::App& app, const SweepOptions& defaults);
void add_study(CLI::App& app, const SweepOptions& defaults);
void add_score(CLI::App& app, const SweepOptions& defaults);

/// These set the program's exit code.
void add_inspect(CLI::App& app, int& exit_code);
void add_compare(CLI::App& app, int& exit_code);
void add_check(CLI::App& app, const SweepOptions& defaults, int& exit_code);
void add_forces(CLI::App& app, int& exit_code);

/// All of them.
void add_commands(CLI::App& app, const SweepOptions& defaults, int& exit_code);

/// The options of what the program does without a subcommand.
void add_main_job(CLI::App& app, bool& dry_run);

/// Does that, or says how much it would be.
void do_main_job(bool dry_run);

}  // namespace drape::bench
