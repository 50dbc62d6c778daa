#include "bench/commands/completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/commands/argument_checks.hpp"
#include "bench/commands/choices.hpp"
#include "bench/commands/commands.hpp"

namespace drape::bench {
namespace {

Choices solver_choices() {
  Choices choices = stage_solver_choices();
  std::ranges::move(linear_solver_choices(), std::back_inserter(choices));
  return choices;
}

/// The names that an option or argument takes, whichever command it is of.
struct NamesTaken {
  std::string_view by;
  Choices (*choices)();
  Choices (*parts)() = nullptr;  ///< what may follow behind a slash
  std::string_view suffix = "";  ///< what must follow
};
constexpr NamesTaken names_taken[] = {
    {.by = "--scene", .choices = scene_choices},
    {.by = "--method", .choices = method_choices, .parts = solver_choices},
    {.by = "METHOD", .choices = method_choices, .parts = solver_choices},
    {.by = "--set", .choices = scene_key_choices, .suffix = "="},
    {.by = "material.fabric", .choices = fabric_choices},
    {.by = "--format", .choices = format_choices},
    {.by = "NAME", .choices = study_choices},
    {.by = "KIND", .choices = kind_choices},
    {.by = "SHELL", .choices = shell_choices},
};

const NamesTaken* taken_by(std::string_view name) {
  const auto found = std::ranges::find(names_taken, name, &NamesTaken::by);
  return found == std::end(names_taken) ? nullptr : &*found;
}

std::string words(Choices (*choices)()) {
  return choices == nullptr ? "" : fmt::format("{}", fmt::join(names(choices()), " "));
}

/// The variables of the script that say what may follow.
std::string proposals(std::string_view by, std::string_view files, char separator = '\0') {
  const NamesTaken* names = taken_by(by);
  return fmt::format("values=\"{}\" parts=\"{}\" suffix={} files={} separator={}",
                     names == nullptr ? "" : words(names->choices), names == nullptr ? "" : words(names->parts),
                     names == nullptr ? "" : names->suffix, files, separator == '\0' ? "" : std::string(1, separator));
}

/// What bash calls the files that an option takes; empty if it takes none.
std::string_view files_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto has = [&](const char* word) { return type.find(word) != std::string::npos; };
  return has("DIR") || has("FOLDER") ? "directory" : has("FILE") ? "file" : "";
}

std::vector<std::string> spellings(const CLI::Option& option) {
  std::vector<std::string> all;
  for (const std::string& name : option.get_snames()) all.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) all.push_back("--" + name);
  return all;
}

/// The options of a command and what its arguments may be: names, or else files.
std::string branch_of(const CLI::App& command) {
  std::vector<std::string> options;
  std::string arguments;
  for (const CLI::Option* option : command.get_options()) {
    std::ranges::move(spellings(*option), std::back_inserter(options));
    const std::string name = option->get_name(true);
    if (option->get_positional()) arguments = proposals(name, taken_by(name) == nullptr ? "file" : "");
  }
  return fmt::format("    {}) options=\"{}\" {} ;;\n", command.get_name(), fmt::join(options, " "), arguments);
}

/// What may stand behind the options that take a value. Options of the same name take the same, whichever command they are of.
std::string branches_of_values(const CLI::App& app) {
  std::map<std::string, std::string> branches{{"material.fabric", proposals("material.fabric", "")}};
  std::vector<const CLI::App*> commands = app.get_subcommands({});
  commands.push_back(&app);
  for (const CLI::App* command : commands)
    for (const CLI::Option* option : command->get_options())
      if (option->nonpositional() && option->get_items_expected_max() > 0)
        branches.emplace(fmt::format("{}", fmt::join(spellings(*option), "|")),
                         proposals(option->get_name(), files_of(*option), option->get_delimiter()));
  std::string text;
  for (const auto& [spelling, proposed] : branches) text += fmt::format("    {}) options= {} ;;\n", spelling, proposed);
  return text;
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  std::vector<std::string> commands, options;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  for (const CLI::Option* option : app.get_options()) std::ranges::move(spellings(*option), std::back_inserter(options));
  std::string script = fmt::format(
      R"(# Completion of bench_integrators and bench/run for bash, as `bench_integrators completion bash` prints it.
_drape() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}}
  local command= options= values= parts= suffix= files= separator= begun= k
  [[ $word != = ]] || word=  # a word of its own, as bash breaks words
  [[ $before != = ]] || before=${{COMP_WORDS[COMP_CWORD - 2]}}
  for ((k = 1; k < COMP_CWORD; ++k)); do
    case ${{COMP_WORDS[k]}} in
      {0}) command=${{COMP_WORDS[k]}} && break ;;
    esac
  done
  case $command in
    "") options="{1}" values="{2}" ;;
)",
      fmt::join(commands, "|"), fmt::join(options, " "), fmt::join(commands, " "));
  for (const CLI::App* command : app.get_subcommands({})) script += branch_of(*command);
  script += "  esac\n  case $before in\n" + branches_of_values(app);
  script += R"(  esac
  if [[ -n $separator && $word == *"$separator"* ]]; then
    begun=${word%"$separator"*}$separator word=${word##*"$separator"}
  fi
  if [[ -n $parts && $word == */* ]]; then
    begun+=${word%/*}/ word=${word##*/} values=$parts
  fi
  if [[ $word == -* ]]; then values=$options suffix= files=; fi
  mapfile -t COMPREPLY < <(compgen -P "$begun" -S "$suffix" -W "$values" -- "$word")
  [[ -z $suffix ]] || compopt -o nospace
  [[ -z $files ]] || { compopt -o filenames && mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -A "$files" -- "$word"); }
}
complete -F _drape bench_integrators bench/run ./bench/run
)";
  return script;
}

void add_completion(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("completion", "a script by which a shell completes commands, options and names");
  const auto shell = std::make_shared<std::string>();
  command.add_option("SHELL", *shell, fmt::format("{}", fmt::join(names(shell_choices()), ", ")))
      ->required()
      ->type_name("")
      ->check(one_of("shell", names(shell_choices())));
  command.callback([&app, shell] { fmt::print("{}", bash_completion(app)); });
}

}  // namespace drape::bench
