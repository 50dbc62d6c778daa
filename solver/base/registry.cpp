#include "solver/base/registry.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>
#include <vector>

#include "solver/base/printable.hpp"

namespace drape::base {
namespace {

/// Insertions, deletions and replacements of characters, and exchanges of two neighbours, that make one text the other, whether
/// small or capital letters [Damerau 1964]. What is exchanged is not changed again.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto same = [](char c, char d) {
    return std::tolower(static_cast<unsigned char>(c)) == std::tolower(static_cast<unsigned char>(d));
  };
  std::vector<std::size_t> before, last, row(b.size() + 1);  // distances of the beginnings of a from those of b
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    before = std::exchange(last, row);
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      row[j + 1] = std::min({last[j] + (same(a[i], b[j]) ? 0 : 1), row[j] + 1, last[j + 1] + 1});
      if (i > 0 && j > 0 && same(a[i], b[j - 1]) && same(a[i - 1], b[j])) row[j + 1] = std::min(row[j + 1], before[j - 1] + 1);
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
