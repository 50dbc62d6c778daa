#include "results/analysis/compare.hpp"

#include <fmt/format.h>

#include <memory>

#include "bench/commands/commands.hpp"
#include "bench/commands/help.hpp"
#include "bench/commands/output.hpp"
#include "results/file/run_file.hpp"
#include "solver/base/printable.hpp"

namespace drape::bench {
namespace {

struct CompareArguments {
  std::string a, b;
  results::CompareOptions options;
};

void print(const char* kind, const results::Aspect& aspect) {
  fmt::print("{}: {} ({})\n", kind, to_string(aspect.change), base::printable(aspect.reason));
  if (rows(aspect.worst) == 0) return;
  fmt::print("\n");
  print_text(aspect.worst);
  fmt::print("\n");
}

int compare_files(const CompareArguments& a) {
  const results::Comparison comparison =
      results::compare(results::read_recording(a.a), results::read_recording(a.b), a.options);
  print("accuracy", comparison.accuracy);
  print("work", comparison.work);
  print("time", comparison.time);
  return exit_code(comparison);
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
  CLI::App& command = *app.add_subcommand("compare", "compare the results of two files: accuracy, work and time");
  const auto a = std::make_shared<CompareArguments>();
  command.add_option("A", a->a, "HDF5 file of results")->required()->type_name("");
  command.add_option("B", a->b, "another, compared with the first")->required()->type_name("");
  command.add_flag_callback(
      "--no-times", [=] { a->options.times = false; }, "compare accuracy and work only");
  command.add_flag("--quiet-machine", a->options.quiet,
                   "judge what all cells' times share as well: the machine was as quick for B as for A");
  add_wide_option(command);
  command.footer(
      help_text("Cells are matched by scene, method, parameters, step and end; tables by name. Exit code: 0 the same or "
                "better, 1 a regression, 2 not comparable."));
  command.callback([=, &exit_code] { exit_code = compare_files(*a); });
}

}  // namespace drape::bench
