#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "bench/commands/commands.hpp"
#include "bench/commands/help.hpp"
#include "bench/commands/output.hpp"
#include "bench/studies/method_check.hpp"
#include "solver/base/hash.hpp"

namespace drape::bench {
namespace {

struct CheckArguments {
  std::string method;
  Output output;
};

/// The first row of the table with an order has the verdict on it.
bool has_declared_order(const std::vector<results::Table>& tables) {
  const auto has_order = [](const results::Table& table) { return find_column(table, results::Role::order) != nullptr; };
  const results::Column* verdicts = find_column(*std::ranges::find_if(tables, has_order), results::Role::verdict);
  return standing(verdicts->cells.front()) == results::Standing::met;
}

int check(const CheckArguments& a) {
  const Job job = method_check(a.method);
  SweepOptions options = a.output.sweep;
  options.out = out_file(a.output, "check");
  const Results all = record_in_file(options, base::long_hash_text("check " + a.method), {job});
  if (a.output.format == "table" && !all.summary.empty())
    fmt::print("{}", all.summary);
  else
    print_tables(all.tables, a.output.format);
  say_end(options.out, a.output.format);
  return has_declared_order(all.tables) ? 0 : 1;
}

}  // namespace

void add_check(CLI::App& app, const SweepOptions& defaults, int& exit_code) {
  CLI::App& command = *app.add_subcommand("check", "what a method is good for, on one screen: order, stability, energy, cost");
  const auto a = std::make_shared<CheckArguments>();
  a->output.sweep = defaults;
  command.add_option("METHOD", a->method, "its name, with /STAGE_SOLVER and /LINEAR_SOLVER if not the first: bdf2/newton")
      ->required()
      ->type_name("");
  add_record_options(command, a->output);
  command.footer(help_text("Exit code: 1 if the order is not as declared."));
  command.callback([=, &exit_code] { exit_code = check(*a); });
}

}  // namespace drape::bench
