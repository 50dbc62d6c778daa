#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/runs/sweep.hpp"
#include "results/table.hpp"

namespace drape::bench {

/// How results are made, where they are kept and what is printed of them.
struct Output {
  SweepOptions sweep;
  std::string format = "table";
  bool dry_run = false;  ///< whether only to say how much that would be
};

/// The option --agreement.
void add_agreement(CLI::App& command, double& agreement);

/// The options --format and --wide.
void add_format_option(CLI::App& command, std::string& format);

/// The options --out, --resume, --format and those of verbosity.
void add_record_options(CLI::App& command, Output& output);

/// Options of commands that write tables.
void add_table_options(CLI::App& command, Output& output);

/// The options --quiet and --verbose.
void add_verbosity_options(CLI::App& command);

/// The option --wide.
void add_wide_option(CLI::App& command);

/// Options of commands that run scenes: those of tables, and limits.
void add_output_options(CLI::App& command, Output& output);

/// The file asked for, or one named after the job.
std::filesystem::path out_file(const Output& output, const std::string& job);

/// Runs all groups, prints the runs, says where they are recorded and returns that; or prints how much that would be, or what
/// is to be said about a shard of them.
std::filesystem::path sweep_and_print(const std::vector<Group>& groups, Output output, const std::string& job);

/// A table for users, as wide as the terminal, or with all columns where standard output is none.
void print_text(const results::Table& table);

void print_table(const results::Table& table, const std::string& format);

/// Tables under their descriptions; as CSV under their names; as JSON in one object.
void print_tables(const std::vector<results::Table>& tables, const std::string& format);

/// Where the record is, among tables for users only; with --verbose also how often orderings of matrices were shared.
void say_end(const std::filesystem::path& out, const std::string& format);

}  // namespace drape::bench
