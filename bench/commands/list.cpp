#include <fmt/format.h>
#include <fmt/ranges.h>

#include <ranges>
#include <utility>

#include "bench/commands/choices.hpp"
#include "bench/commands/commands.hpp"
#include "solver/base/registry.hpp"

namespace drape::bench {
namespace {

/// The names of one kind for programs, or all kinds for users.
void list(const std::string& kind) {
  if (kind.empty()) {
    std::string_view separator;
    for (const KindOfNames& any : kinds_of_names())
      fmt::print("{}{}", std::exchange(separator, "\n"), paragraph(any.name, any.choices()));
    return;
  }
  for (const Choice& choice : base::find_named(kinds_of_names(), "kind of names", kind).choices())
    fmt::print("{}\n", choice.name);
}

std::string all_kinds() {
  const auto names = kinds_of_names() | std::views::transform(&KindOfNames::name);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

void add_list(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("list", "names of " + all_kinds());
  const auto kind = std::make_shared<std::string>();
  command.add_option("KIND", *kind, all_kinds() + " [all, with descriptions]")->type_name("");
  command.callback([=] { list(*kind); });
}

}  // namespace drape::bench
