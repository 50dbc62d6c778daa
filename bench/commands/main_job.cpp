#include <fmt/format.h>

#include "bench/commands/commands.hpp"
#include "bench/commands/report.hpp"
#include "bench/commands/study.hpp"

namespace drape::bench {
namespace {

/// How all methods do on two sheets; whether their orders are as declared; and which is the quickest at which error, beside
/// SUNDIALS at its best.
std::vector<StudyArguments> main_job() {
  std::vector<StudyArguments> studies(3);
  studies[0].name = "hung-sheets";
  studies[1].name = "orders";
  studies[1].quick = true;
  studies[2].name = "work-precision";
  studies[2].choice.scene = "hung-corners";
  return studies;
}

/// What does one of them alone.
std::string command_of(const StudyArguments& a) {
  return fmt::format("bench_integrators study {}{}{}", a.name, a.quick ? " --quick" : "",
                     a.choice.scene.empty() ? "" : " --scene " + a.choice.scene);
}

}  // namespace

void do_main_job() {
  std::vector<std::filesystem::path> files;
  for (StudyArguments study : main_job()) {
    study.output.sweep.command_line = command_of(study);
    fmt::print("{}\n", study.output.sweep.command_line);
    files.push_back(run_study(study));
  }
  std::filesystem::path folder = files.front();
  report(files, folder.replace_extension().concat("-report"));
}

}  // namespace drape::bench
