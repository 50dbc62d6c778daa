#include <fmt/format.h>

#include "bench/commands/commands.hpp"
#include "bench/commands/report.hpp"
#include "bench/commands/study.hpp"

namespace drape::bench {
namespace {

constexpr double frame = 0.04;  ///< [s]

/// Four motions to look at; how all methods do on two sheets; whether their orders are as declared; and which is the quickest
/// at which error, beside SUNDIALS, tuned.
std::vector<StudyArguments> main_job() {
  std::vector<StudyArguments> studies(4);
  studies[0].name = "motions";
  studies[0].output.sweep.frames_every = frame;
  studies[1].name = "hung-sheets";
  studies[2].name = "orders";
  studies[2].quick = true;
  studies[3].name = "work-precision";
  studies[3].choice.scene = "hung-corners";
  return studies;
}

/// What does one of them alone.
std::string command_of(const StudyArguments& a) {
  std::string command = "bench_integrators study " + a.name;
  if (a.quick) command += " --quick";
  if (!a.choice.scene.empty()) command += " --scene " + a.choice.scene;
  if (a.output.sweep.frames_every) command += fmt::format(" --trajectory every={:g}", *a.output.sweep.frames_every);
  return command;
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
