#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "bench/commands/commands.hpp"
#include "bench/commands/force_check.hpp"
#include "bench/commands/help.hpp"
#include "bench/commands/output.hpp"
#include "bench/commands/scene_choice.hpp"
#include "results/columns.hpp"

namespace drape::bench {
namespace {

using results::ColumnOf;
using results::field;
using results::Role;

constexpr ColumnOf<ForceCheck> force_columns[] = {
    {"force", "force", "", "see bench/run list forces", Role::key, field<&ForceCheck::name>},
    {"energy_error", "error of energy", "1",
     "of the work of the force at rest, against differences of its energy; empty: it has none", Role::error,
     field<&ForceCheck::energy>},
    {"dx_error", "of df/dx", "1", "of the Jacobian by positions, against differences of the force", Role::error,
     field<&ForceCheck::by_x>},
    {"dv_error", "of df/dv", "1", "of the Jacobian by velocities, against differences of the force", Role::error,
     field<&ForceCheck::by_v>},
    {"verdict", "verdict", "", "whether all are as small as those of central differences", Role::verdict,
     [](const ForceCheck& row) { return results::to_datum(results::check(row.agrees(), "agrees", "does not agree")); }},
};

int check(const SceneChoice& choice, const std::string& format) {
  const std::vector<ForceCheck> rows = check_forces(choice.load());
  print_table(
      results::make_table("forces", "Energies and Jacobians of the scene's forces, against differences", force_columns, rows),
      format);
  return std::ranges::all_of(rows, &ForceCheck::agrees) ? 0 : 1;
}

}  // namespace

void add_forces(CLI::App& app, int& exit_code) {
  CLI::App& command = *app.add_subcommand("forces", "compare the Jacobians and energies of a scene's forces with differences");
  const auto choice = std::make_shared<SceneChoice>();
  const auto format = std::make_shared<std::string>("table");
  add_scene_option(command, *choice);
  add_overrides(command, *choice);
  add_format_option(command, *format);
  command.footer(help_text("Forces that remember the motion are left out. Exit code: 1 if one does not agree."));
  command.callback([=, &exit_code] { exit_code = check(*choice, *format); });
}

}  // namespace drape::bench
