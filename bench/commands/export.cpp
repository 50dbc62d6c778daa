#include "bench/score/export.hpp"

#include <fmt/format.h>

#include "bench/commands/argument_checks.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/output.hpp"
#include "bench/commands/scene_choice.hpp"
#include "bench/runs/progress.hpp"
#include "bench/runs/reference_reports.hpp"
#include "bench/runs/sweep.hpp"
#include "bench/runs/trajectory_observer.hpp"
#include "solver/base/atomic_file.hpp"
#include "solver/base/printable.hpp"

namespace drape::bench {
namespace {

struct ExportArguments {
  SceneChoice choice;
  std::string out;
  double every = 0.04;
  double agreement = SweepOptions().agreement;
};

void export_scene(const ExportArguments& a) {
  const model::Scene scene = a.choice.load();
  check_frames("--every", a.every, scene.end);
  std::vector<double> times = frame_times(a.every, 0, scene.end);
  if (times.empty())
    throw std::invalid_argument(fmt::format("--every: expected at most the scene's end, {:g} s, not {:g}", scene.end, a.every));
  times.insert(times.begin(), 0);
  base::require_empty_folder(a.out, "the exported scene");
  Progress progress(1);
  const auto truth = [&] {
    ReferenceReports reports(progress, scene.name);
    return true_motion(scene, times, a.agreement, {.say = std::ref(reports)});
  };
  const auto files = exported(truth(), times);
  base::publish_folder(a.out, files);
  for (const auto& [name, content] : files) fmt::print("{}\n", base::printable((std::filesystem::path(a.out) / name).string()));
}

}  // namespace

void add_export(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("export", "a scene with its reference as a benchmark for other simulators");
  const auto a = std::make_shared<ExportArguments>();
  add_scene_option(command, a->choice);
  command.add_option("--out", a->out, "new or empty folder for it")->required()->type_name("DIR")->check(output_name());
  add_overrides(command, a->choice);
  command.add_option("--every", a->every, "simulated seconds between two frames of the reference")
      ->type_name("SECONDS")
      ->check(positive())
      ->capture_default_str();
  add_agreement(command, a->agreement);
  add_verbosity_options(command);
  command.callback([=] { export_scene(*a); });
}

}  // namespace drape::bench
