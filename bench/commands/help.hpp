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

 private:
  std::string described(const std::string& text) const;
};

/// The version, with the commit of the sources.
std::string version_text();

}  // namespace drape::bench
