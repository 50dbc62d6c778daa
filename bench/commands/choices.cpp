#include "bench/commands/choices.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "bench/peers/peers.hpp"
#include "bench/studies/studies.hpp"
#include "model/fabric.hpp"
#include "model/forces/term.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/terminal.hpp"
#include "solver/methods.hpp"

namespace drape::bench {
namespace {

template <class Table>
Choices from_table(const Table& table) {
  Choices choices;
  for (const auto& row : table) choices.push_back({std::string(row.name), std::string(row.description)});
  return choices;
}

}  // namespace

Choices scene_choices() {
  Choices choices;
  for (const model::BuiltinScene& scene : model::builtin_scenes())
    choices.push_back({std::string(scene.name), model::parse_scene(scene.toml, scene.name).description});
  return choices;
}

Choices scene_key_choices() {
  Choices choices;
  for (const model::KeyHelp& key : model::scene_keys()) choices.push_back({key.path, key.description});
  return choices;
}

Choices method_choices() { return from_table(solver::methods()); }

Choices stage_solver_choices() { return from_table(solver::stage_kinds()); }

Choices linear_solver_choices() { return from_table(solver::linear_solvers()); }

Choices study_choices() { return from_table(studies()); }

Choices force_choices() { return from_table(model::term_kinds()); }

Choices fabric_choices() { return from_table(model::fabrics()); }
Choices peer_choices() { return from_table(peers::all_peers()); }

Choices kind_choices() {
  Choices choices;
  for (const KindOfNames& kind : kinds_of_names()) choices.push_back({std::string(kind.name), ""});
  return choices;
}

Choices format_choices() {
  return {{"table", "for users"}, {"csv", "comma-separated values, all columns"}, {"json", "all columns"}};
}

Choices shell_choices() { return {{"bash", "also for zsh, by its bashcompinit"}}; }

std::span<const KindOfNames> kinds_of_names() {
  static constexpr KindOfNames table[] = {{"scenes", scene_choices}, {"methods", method_choices}, {"studies", study_choices},
                                          {"forces", force_choices}, {"fabrics", fabric_choices}, {"peers", peer_choices}};
  return table;
}

std::span<const ChoicesOfCommand> choices_of_commands() {
  static constexpr ChoicesOfCommand table[] = {{"Scenes", scene_choices, "run"},
                                               {"Methods", method_choices, "run"},
                                               {"Stage solvers", stage_solver_choices, "run"},
                                               {"Linear solvers", linear_solver_choices, "run"},
                                               {"Keys of scenes", scene_key_choices, "run"},
                                               {"Studies", study_choices, "study"}};
  return table;
}

std::vector<std::string> names(const Choices& choices) {
  std::vector<std::string> all;
  for (const Choice& choice : choices) all.push_back(choice.name);
  return all;
}

std::string paragraph(std::string_view title, const Choices& choices) {
  const auto length = [](const Choice& choice) { return choice.name.size(); };
  const std::size_t width = length(std::ranges::max(choices, {}, length));
  const int indent = static_cast<int>(width) + 4, columns = base::columns_of(STDOUT_FILENO);
  std::string text = fmt::format("{}:\n", title);
  for (const Choice& choice : choices)
    text += fmt::format("  {:<{}}  {}\n", choice.name, width, base::wrapped(choice.description, columns - indent, indent));
  return text;
}

}  // namespace drape::bench
