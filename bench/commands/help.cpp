#include "bench/commands/help.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <sstream>

#include "results/provenance.hpp"
#include "solver/base/terminal.hpp"

namespace drape::bench {

std::string help_text(const std::string& text) { return base::wrapped(text, base::columns_of(STDOUT_FILENO)); }

HelpFormat::HelpFormat() { column_width(28); }

std::string HelpFormat::described(const std::string& text) const {
  return base::wrapped(text, base::columns_of(STDOUT_FILENO) - static_cast<int>(get_column_width()));
}

std::string HelpFormat::make_option_desc(const CLI::Option* option) const { return described(option->get_description()); }

std::string HelpFormat::make_subcommand(const CLI::App* command) const {
  std::ostringstream line;
  CLI::detail::format_help(line, command->get_name(), described(command->get_description()), get_column_width());
  return line.str();
}

std::string version_text() {
  const results::Provenance facts = results::provenance("", "");
  return fmt::format("drape {} ({})", value_of(facts, "version"), value_of(facts, "git_commit"));
}

}  // namespace drape::bench
