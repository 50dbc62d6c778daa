#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// Help as users read it: as wide as the terminal.
namespace drape::bench {

/// A paragraph of help, broken into lines that the terminal holds.
std::string help_text(const std::string& text);

/// Breaks descriptions of options and subcommands into such lines.
class HelpFormat : public CLI::Formatter {
 public:
  HelpFormat();

  std::string make_option_desc(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* command) const override;

  /// Also has the names that the command takes. Only here, where help is asked for: to read all scenes takes a while.
  std::string make_footer(const CLI::App* command) const override;

 private:
  std::string described(const std::string& text) const;
};

/// The version with the commit of the sources, then what this program is built from and with, one fact a line.
std::string version_text();

}  // namespace drape::bench
