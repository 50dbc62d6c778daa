#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

/// What CLI11 leaves out: its own checks of numbers let NaN pass and print limits of hundreds of digits, and some of its
/// messages do not say what would be right.
namespace drape::bench {

/// Finite and above 0.
CLI::Validator positive();

CLI::Validator between(double least, double most);
CLI::Validator between(int least, int most);
CLI::Validator not_empty();

/// One of some names, which are of a kind.
CLI::Validator one_of(const std::string& kind, const std::vector<std::string>& names);

/// Checks the name of a file or folder to be made. One that begins with '-' is more likely an option, or meant to be the
/// standard output.
CLI::Validator output_name();

/// A text "every=X" with X finite and above 0, and this X.
CLI::Validator every_seconds();
double seconds_every(const std::string& text);

/// A shard, "i/n".
CLI::Validator shard_name();

/// One line on what is wrong with the command line and what would be right.
std::string explanation(const CLI::App& app, const CLI::ParseError& error);

}  // namespace drape::bench
