#include "bench/commands/manual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "bench/commands/choices.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/help.hpp"
#include "results/provenance.hpp"

namespace drape::bench {
namespace {

constexpr std::string_view program = "bench_integrators";

/// A text as troff reads it: a line of its own, in which nothing is a command.
std::string troff(std::string_view text) {
  std::string line;
  for (const char c : text) {
    switch (c) {
      case '\\': line += "\\e"; break;
      case '-': line += "\\-"; break;
      case '\n': line += ' '; break;
      default: line += c;
    }
  }
  return "\\&" + line + '\n';
}

std::string item(std::string_view name, std::string_view description) { return ".TP\n.B " + troff(name) + troff(description); }

std::string section(std::string_view title) {
  std::string capitals(title);
  std::ranges::transform(capitals, capitals.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return ".SH " + capitals + '\n';
}

std::string usage(const CLI::App& command, const std::string& name) {
  const std::string line = HelpFormat().make_usage(&command, name);
  return ".PP\n.B " + troff(line.substr(line.find(name), line.find('\n') - line.find(name)));
}

/// Arguments, then options.
std::string options_of(const CLI::App& command) {
  const HelpFormat format;
  std::string text;
  for (const bool positional : {true, false})
    for (const CLI::Option* option : command.get_options())
      if (option->get_positional() == positional)
        text += item(format.make_option_name(option, positional) + format.make_option_opts(option), option->get_description());
  return text;
}

}  // namespace

std::string manual(const CLI::App& app) {
  const results::Provenance facts = results::provenance("", "");
  std::string text = fmt::format(".TH BENCH_INTEGRATORS 1 \"\" \"drape {}\" \"drape\"\n", value_of(facts, "version"));
  text += section("name") + std::string(program) + " \\- time integrators of cloth, side by side with a reference\n";
  text += section("synopsis") + usage(app, std::string(program));
  text += section("description") + troff(app.get_description());
  text += section("options") + options_of(app);
  text += section("commands");
  for (const CLI::App* command : app.get_subcommands({})) {
    const std::string name = command->get_name();
    text += ".SS " + name + '\n' + troff(command->get_description()) + usage(*command, fmt::format("{} {}", program, name)) +
            options_of(*command);
    if (const std::string footer = command->get_footer(); !footer.empty()) text += ".PP\n" + troff(footer);
  }
  for (const auto& [title, choices, command] : choices_of_commands()) {
    text += section(title) + troff(fmt::format("Taken by {}.", command));
    for (const Choice& choice : choices()) text += item(choice.name, choice.description);
  }
  text += section("exit status") + item("0", "success") + item("1", "a failure, or an answer that is not the wanted one") +
          item("2", "bad input, which one line on standard error explains") + item("130, 143", "interrupted or terminated");
  text += section("environment") + item("DRAPE_CACHE", "folder of references that are kept [~/.cache/drape]") +
          item("NO_COLOR", "if set, tables have no colours") + item("TERM", "the terminal; one that is dumb has no colours");
  text += section("files") + item("results/runs/*.h5", "what was computed, unless --out names another file");
  return text;
}

void add_man(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("man", "the manual page; to read it: man -l FILE");
  command.callback([&app] { fmt::print("{}", manual(app)); });
}

}  // namespace drape::bench
