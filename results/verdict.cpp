#include "results/verdict.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace drape::results {
namespace {

/// In the order of Standing.
constexpr std::array<std::string_view, 3> words{"met", "open", "missed"};

}  // namespace

std::string_view to_string(Standing standing) { return words[static_cast<std::size_t>(standing)]; }

std::optional<Standing> standing_named(std::string_view name) {
  const auto found = std::ranges::find(words, name);
  if (found == words.end()) return std::nullopt;
  return static_cast<Standing>(found - words.begin());
}

std::string to_string(const Verdict& verdict) {
  std::string word(to_string(verdict.standing));
  if (verdict.detail.empty()) return word;
  return verdict.standing == Standing::open ? verdict.detail : std::move(word) + ": " + verdict.detail;
}

}  // namespace drape::results
