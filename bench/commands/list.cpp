#include <fmt/format.h>

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

}  // namespace

void add_list(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("list", "names of scenes, methods, studies, forces, fabrics or peers, one a line");
  const auto kind = std::make_shared<std::string>();
  command.add_option("KIND", *kind, "scenes, methods, studies, forces, fabrics or peers [all, with descriptions]")
      ->type_name("");
  command.callback([=] { list(*kind); });
}

}  // namespace drape::bench
