#include "bench/commands/help.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string_view>

#include "bench/commands/choices.hpp"
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

std::string HelpFormat::make_footer(const CLI::App* command) const {
  std::string footer = CLI::Formatter::make_footer(command);
  for (const auto& [title, choices, name] : choices_of_commands())
    if (name == command->get_name()) footer += paragraph(title, choices()) + '\n';
  return footer;
}

std::string version_text() {
  const results::Provenance facts = results::provenance("", "");
  std::string text = fmt::format("drape {} ({})", value_of(facts, "version"), value_of(facts, "git_commit"));
  constexpr std::string_view others[] = {"version", "git_commit", "cpu", "sweep"};  // said, or not of the program
  constexpr int name_width = 20;
  for (const results::Fact& fact : lasting(facts)) {
    if (std::ranges::find(others, fact.name) != std::end(others)) continue;
    text += fmt::format("\n{:<{}}{}", fact.name, name_width,
                        base::wrapped(fact.value, base::columns_of(STDOUT_FILENO) - name_width, name_width));
  }
  return text;
}

}  // namespace drape::bench
