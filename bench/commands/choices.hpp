#pragma once

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
Choices fabric_choices();
Choices peer_choices();

/// A title, and below it the choices with their descriptions, one a line.
std::string paragraph(std::string_view title, const Choices& choices);

}  // namespace drape::bench
