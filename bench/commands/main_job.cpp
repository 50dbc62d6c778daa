#include <fmt/format.h>

#include <stdexcept>

#include "bench/commands/commands.hpp"
#include "bench/commands/report.hpp"
#include "bench/commands/study.hpp"
#include "bench/runs/verbosity.hpp"

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

void add_main_job(CLI::App& app, bool& dry_run) {
  app.add_flag("-n,--dry-run", dry_run, "only say how much the main job would compute, and how long that may take");
  add_wide_option(app);
  add_verbosity_options(app);
  app.parse_complete_callback([&] {  // before a subcommand does anything
    if (dry_run && !app.get_subcommands().empty())
      throw std::invalid_argument("--dry-run: expected after run or study, or without a subcommand");
  });
}

void do_main_job(bool dry_run) {
  if (!dry_run)
    say_note("this is the main job, four studies and a report; --dry-run tells how long it takes, --help what else there is");
  std::vector<std::filesystem::path> files;
  for (StudyArguments study : main_job()) {
    study.output.dry_run = dry_run;
    study.output.sweep.command_line = command_of(study);
    fmt::print("{}\n", study.output.sweep.command_line);
    files.push_back(run_study(study));
  }
  if (dry_run) return;
  std::filesystem::path folder = files.front();
  report(files, folder.replace_extension().concat("-report"));
}

}  // namespace drape::bench
