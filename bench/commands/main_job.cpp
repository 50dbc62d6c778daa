#include <fmt/format.h>

#include "bench/commands/commands.hpp"
#include "bench/commands/report.hpp"
#include "bench/commands/study.hpp"

namespace drape::bench {
namespace {

/// A part of the main job, and the command that does it alone.
struct Part {
  const char* command;
  StudyArguments study;
};

/// How all methods do on two sheets; whether their orders are as declared; and which is the quickest at which error, beside
/// SUNDIALS at its best.
std::vector<Part> main_job() {
  std::vector<Part> parts(3);
  parts[0].study.name = "hung-sheets";
  parts[0].command = "study hung-sheets";
  parts[1].study.name = "orders";
  parts[1].study.quick = true;
  parts[1].command = "study orders --quick";
  parts[2].study.name = "work-precision";
  parts[2].study.choice.scene = "hung-corners";
  parts[2].command = "study work-precision --scene hung-corners";
  return parts;
}

}  // namespace

void do_main_job() {
  std::vector<Part> parts = main_job();
  std::vector<std::filesystem::path> files;
  for (auto& [command, study] : parts) {
    study.output.sweep.command_line = fmt::format("bench_integrators {}", command);
    fmt::print("{}\n", study.output.sweep.command_line);
    files.push_back(run_study(study));
  }
  std::filesystem::path folder = files.front();
  report(files, folder.replace_extension().concat("-report"));
}

}  // namespace drape::bench
