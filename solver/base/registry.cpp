#include "solver/base/registry.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <vector>

#include "solver/base/printable.hpp"

namespace drape::base {
namespace {

/// Insertions, deletions and replacements of characters that make one text the other, whether small or capital letters
/// [Levenshtein 1966].
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto small = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::size_t> row(b.size() + 1);  // distances of the beginning of a from those of b
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (small(a[i]) == small(b[j]) ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_name(std::string_view name, std::span<const std::string_view> names) {
  constexpr std::size_t longest = 64;  // of names that are ours
  if (name.size() > longest || names.empty()) return "";
  const std::string_view nearest = std::ranges::min(names, {}, [&](std::string_view any) { return edit_distance(name, any); });
  return edit_distance(name, nearest) <= std::max<std::size_t>(1, name.size() / 3) ? std::string(nearest) : "";
}

std::string unknown_name(std::string_view kind, std::string_view name, std::span<const std::string_view> names) {
  std::string message("unknown ");
  message.append(kind).append(" '").append(quoted(name)).append("'");
  if (const std::string nearest = nearest_name(name, names); !nearest.empty())
    message.append(" (did you mean ").append(nearest).append("?)");
  const char* separator = ": expected one of ";
  for (const std::string_view any : names) {
    message.append(separator).append(any);
    separator = ", ";
  }
  return message;
}

}  // namespace drape::base
