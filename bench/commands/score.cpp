#include "bench/score/score.hpp"

#include <fmt/format.h>

#include <optional>

#include "bench/commands/argument_checks.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/output.hpp"
#include "bench/commands/scene_choice.hpp"
#include "bench/score/ours.hpp"
#include "solver/base/printable.hpp"

namespace drape::bench {
namespace {

struct ScoreArguments {
  SceneChoice choice;
  std::vector<std::string> files;
  std::optional<double> frame_time, cost;
  std::vector<std::string> methods = usual_methods;
  Output output;
};

void score(const ScoreArguments& a) {
  const model::Scene scene = a.choice.load();
  check_methods(a.methods, scene);
  const ExternalMotion external = read_external_motion(a.files, a.frame_time, scene);
  const ScoreOptions options{a.cost, a.methods, a.output.sweep.agreement, a.output.sweep.repetitions};
  SweepOptions sweep = a.output.sweep;
  sweep.out = out_file(a.output, "score");
  const Results all = record_in_file(sweep, score_identity(scene, external, options), {score_job(scene, external, options)});
  if (a.output.format == "table") fmt::print("{}", base::printable_lines(all.summary));
  print_tables(all.tables, a.output.format);
  say_end(sweep.out, a.output.format);
}

}  // namespace

void add_score(CLI::App& app, const SweepOptions& defaults) {
  CLI::App& command = *app.add_subcommand("score", "measure another simulator's motion of a scene against the reference");
  const auto a = std::make_shared<ScoreArguments>();
  a->output.sweep = defaults;
  add_scene_option(command, a->choice);
  command
      .add_option("FILE", a->files,
                  "an HDF5 file with /time, /positions and maybe /velocities, or meshes (OBJ, PLY, VTK, VTU), one a frame")
      ->required()
      ->type_name("...")
      ->check(not_empty());
  command.add_option("--frame-time", a->frame_time, "simulated seconds from one mesh to the next, the first at 0")
      ->type_name("SECONDS")
      ->check(positive());
  command.add_option("--cost", a->cost, "what the other simulator took on this machine, to compare it")
      ->type_name("SECONDS")
      ->check(positive());
  command.add_option("--method", a->methods, "methods of ours to stand beside it")
      ->type_name("A,B")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  add_overrides(command, a->choice);
  add_table_options(command, a->output);
  command.callback([=] { score(*a); });
}

}  // namespace drape::bench
