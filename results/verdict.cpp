#include "results/verdict.hpp"

#include <array>

namespace drape::results {
namespace {

/// In the order of Standing.
constexpr std::array<std::string_view, 3> words{"met", "open", "missed"};

}  // namespace

std::string verdict(Standing standing, std::string_view detail) {
  std::string text(words[static_cast<std::size_t>(standing)]);
  if (!detail.empty()) text.append(": ").append(detail);
  return text;
}

Standing standing(std::string_view verdict) {
  const std::string_view word = verdict.substr(0, verdict.find(':'));
  return word == words[0] ? Standing::met : word == words[2] ? Standing::missed : Standing::open;
}

}  // namespace drape::results
