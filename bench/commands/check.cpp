#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/commands/commands.hpp"
#include "bench/commands/help.hpp"
#include "bench/commands/output.hpp"
#include "bench/runs/identity.hpp"
#include "bench/runs/run.hpp"
#include "bench/runs/table_jobs.hpp"
#include "bench/studies/method_check.hpp"
#include "results/verdict.hpp"

namespace drape::bench {
namespace {

using results::Table;

struct CheckArguments {
  std::string method;
  Output output;
};

const Table& named(const std::vector<Table>& tables, std::string_view name) {
  return *std::ranges::find(tables, name, &Table::name);
}

double number(const Table& table, std::string_view column, std::size_t row) {
  return number_in(find_column(table, column), row);
}

std::string text(const Table& table, std::string_view column, std::size_t row) {
  return text_in(find_column(table, column), row);
}

/// The first row has the order.
bool has_declared_order(const Table& order) { return results::standing(text(order, "verdict", 0)) == results::Standing::met; }

std::string order_lines(const Table& order, int declared) {
  const std::size_t last = rows(order) - 1;
  const double fitted = number(order, "fitted_order", 0);
  return fmt::format("order      {} (declared {}): {}\n           {};\n           {} steps, {:g} to {:.2g} s\n",
                     std::isnan(fitted) ? "none" : fmt::format("{:.2f}", fitted), declared, text(order, "verdict", 0),
                     order.description, rows(order), number(order, "step", 0), number(order, "step", last));
}

std::string seconds(double value) { return std::isnan(value) ? "none" : fmt::format("{:.3g} s", value); }

std::string stability_lines(const Table& stability) {
  std::string lines = "stability  largest steps, hung by two corners, 10 x 10, k = 1e4, to 0.24 s\n";
  for (std::size_t row = 0; row < rows(stability); ++row)
    lines += fmt::format("           d = {:<4g} accurate {}, stable {}: {}; theory: {}\n", number(stability, "damping", row),
                         seconds(number(stability, "accurate", row)), seconds(number(stability, "stable", row)),
                         text(stability, "verdict", row), text(stability, "theory", row));
  return lines;
}

std::string energy_lines(const Table& energy) {
  std::string lines = "energy     undamped, 1 s; over the largest kinetic energy\n";
  for (std::size_t row = 0; row < rows(energy); ++row) {
    const double change = number(energy, "change", row);
    lines += fmt::format("           h = {:<6g} {}: {}\n", number(energy, "step", row),
                         std::isnan(change)
                             ? text(energy, "outcome", row)
                             : fmt::format("{:+.2g} at the end, at most {:+.2g}", change, number(energy, "gain", row)),
                         text(energy, "verdict", row));
  }
  return lines;
}

/// The quickest at each error has a star.
std::string cost_lines(const Table& cost) {
  std::string head, lines;
  for (std::size_t row = 0; row < rows(cost); ++row) {
    const std::string method = text(cost, "method", row);
    const double wanted = number(cost, "wanted", row), time = number(cost, "time", row);
    if (row == 0 || method != text(cost, "method", row - 1))
      lines += fmt::format("{}           {:<18.18}", row == 0 ? "" : "\n", method);
    if (method == text(cost, "method", 0)) head += fmt::format("{:>9.0e}       ", wanted);
    bool quickest = !std::isnan(time);
    for (std::size_t other = 0; other < rows(cost); ++other)
      if (number(cost, "wanted", other) == wanted && number(cost, "time", other) < time) quickest = false;
    lines += std::isnan(time) ? fmt::format("{:>16}", "-")
                              : fmt::format("{:>8.3g}{}{:>7}", time, quickest ? '*' : ' ', number(cost, "forces", row));
  }
  head.erase(head.find_last_not_of(' ') + 1);
  return fmt::format("cost       median ms (* the quickest) and evaluations of forces, d = 5, 0.3 s\n           {:<18}{}\n{}\n",
                     "error at most", head, lines);
}

std::string summary(const std::string& name, const solver::Method& method, const std::vector<Table>& tables) {
  return fmt::format("{}: {}\n\n{}{}{}{}", name, method.description, order_lines(named(tables, "check-order"), method.order),
                     stability_lines(named(tables, "check-stability")), energy_lines(named(tables, "check-energy")),
                     cost_lines(named(tables, "check-cost")));
}

int check(const CheckArguments& a) {
  RunSpec cell{{}, "", nullptr, 1, {}};
  choose_method(cell, a.method);  // before anything is computed
  SweepOptions options = a.output.sweep;
  options.out = out_file(a.output, "check");
  std::vector<Table> tables = compute(check_jobs(a.method), hash_of("check " + a.method), options);
  if (a.output.format == "table")
    fmt::print("{}", summary(a.method, *cell.method, tables));
  else
    print_tables(tables, a.output.format);
  say_where(options.out, a.output.format);
  return has_declared_order(named(tables, "check-order")) ? 0 : 1;
}

}  // namespace

void add_check(CLI::App& app, const std::string& command_line, int& exit_code) {
  CLI::App& command = *app.add_subcommand("check", "what a method is good for, on one screen: order, stability, energy, cost");
  const auto a = std::make_shared<CheckArguments>();
  a->output.sweep.command_line = command_line;
  command.add_option("METHOD", a->method, "its name, with /STAGE_SOLVER and /LINEAR_SOLVER if not the first: bdf2/newton")
      ->required()
      ->type_name("");
  add_record_options(command, a->output);
  command.footer(help_text("Exit code: 1 if the order is not as declared."));
  command.callback([=, &exit_code] { exit_code = check(*a); });
}

}  // namespace drape::bench
