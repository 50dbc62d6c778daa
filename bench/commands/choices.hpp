#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace drape::bench {

/// Something that users choose by its name.
struct Choice {
  std::string name;
  std::string description;
};
using Choices = std::vector<Choice>;

Choices scene_choices();
Choices scene_key_choices();
Choices method_choices();
Choices stage_solver_choices();
Choices linear_solver_choices();
Choices study_choices();
Choices force_choices();
Choices fabric_choices();
Choices peer_choices();
Choices kind_choices();    ///< of the names below
Choices format_choices();  ///< of what is printed
Choices shell_choices();   ///< for whom there is a completion

/// Names of one kind, as the subcommand list has them.
struct KindOfNames {
  std::string_view name;
  Choices (*choices)();
};
std::span<const KindOfNames> kinds_of_names();

/// Names of one kind under a title, and the command whose help has them.
struct ChoicesOfCommand {
  std::string_view title;
  Choices (*choices)();
  std::string_view command;
};
std::span<const ChoicesOfCommand> choices_of_commands();

/// The names alone.
std::vector<std::string> names(const Choices& choices);

/// A title, and below it the choices with their descriptions, one a line.
std::string paragraph(std::string_view title, const Choices& choices);

}  // namespace drape::bench
