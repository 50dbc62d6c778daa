#include "bench/commands/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "bench/commands/argument_checks.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/dry_run.hpp"
#include "bench/commands/names_of.hpp"
#include "bench/commands/output.hpp"
#include "bench/runs/identity.hpp"
#include "bench/studies/studies.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/hash.hpp"
#include "solver/base/printable.hpp"

namespace drape::bench {
namespace {

/// The studies that can be made of any scene.
std::string of_any_scene() {
  return names_of(studies(), [](const Study& study) { return study.any_scene; });
}

std::string of_any_methods() { return names_of(studies(), std::mem_fn(&Study::any_methods)); }

std::string of_runs() { return names_of(studies(), std::mem_fn(&Study::makes_runs)); }

void check_scene(const Study& chosen, const SceneChoice& choice) {
  if (!choice.scene.empty() && !chosen.any_scene)
    throw std::invalid_argument(
        fmt::format("--scene: the study {} has scenes of its own; it is for {}", chosen.name, of_any_scene()));
  if (choice.scene.empty() && !choice.sets.empty()) throw std::invalid_argument("--set: expected --scene beside it");
}

/// Those that were named, each once, in the order of their names on the command line.
Methods methods_of(const Study& chosen, const std::vector<std::string>& names) {
  if (!names.empty() && !chosen.any_methods)
    throw std::invalid_argument(
        fmt::format("--method: the study {} has methods of its own; it is for {}", chosen.name, of_any_methods()));
  Methods methods;
  for (const std::string& name : names)
    if (const solver::Method* method = &solver::method(name); std::ranges::find(methods, method) == methods.end())
      methods.push_back(method);
  return methods;
}

/// The runs of some methods.
std::vector<Group> runs_of(std::vector<Group> groups, const Methods& methods) {
  if (methods.empty()) return groups;
  for (Group& group : groups)
    std::erase_if(group, [&](const RunSpec& spec) { return std::ranges::find(methods, spec.method) == methods.end(); });
  std::erase_if(groups, [](const Group& group) { return group.empty(); });
  return groups;
}

/// Limits and motions are for runs.
void check_options_of_tables(const Study& chosen, const SweepOptions& options) {
  if (options.frames_every)
    throw std::invalid_argument(fmt::format("--trajectory: the study {} makes tables; runs make {}", chosen.name, of_runs()));
  if (std::isfinite(options.limits.seconds) || std::isfinite(options.limits.megabytes))
    throw std::invalid_argument(
        fmt::format("--time-limit, --memory-limit: expected run, or one of the studies {}, not {}", of_runs(), chosen.name));
}

/// Hash of all that determines the tables of a study.
std::string identity(const StudyArguments& a, const std::optional<model::Scene>& scene) {
  return base::long_hash_text(fmt::format("{}{}{}{}\n{}", a.name, a.quick ? " quick" : "", a.methods.empty() ? "" : " by ",
                                          fmt::join(a.methods, ","), scene ? model::to_toml(*scene) : ""));
}

}  // namespace

std::filesystem::path run_study(const StudyArguments& a) {
  const Study& chosen = study(a.name);
  check_scene(chosen, a.choice);
  Question question{a.quick, methods_of(chosen, a.methods)};
  if (!a.choice.scene.empty()) question.scene = a.choice.load();
  if (const auto* runs = std::get_if<Study::Runs>(&chosen.answer))
    return sweep_and_print(runs_of((*runs)(question), question.methods), a.output, a.name);
  check_options_of_tables(chosen, a.output.sweep);
  const std::vector<Job> jobs = std::get<Study::Tables>(chosen.answer)(question);
  const std::string sweep = identity(a, question.scene);
  if (a.output.dry_run) {
    print_plan(jobs, sweep, a.name);
    return {};
  }
  SweepOptions options = a.output.sweep;
  options.out = out_file(a.output, a.name);
  if (options.shard) {
    fmt::print("{}\n", base::printable(compute_shard(options, sweep, jobs)));
    return {};
  }
  print_tables(record_in_file(options, sweep, jobs).tables, a.output.format);
  say_end(options.out, a.output.format);
  return options.out;
}

void add_study(CLI::App& app, const SweepOptions& defaults) {
  CLI::App& command = *app.add_subcommand("study", "run one of the studies");
  const auto a = std::make_shared<StudyArguments>();
  a->output.sweep = defaults;
  command.add_option("NAME", a->name, "its name")->required()->type_name("");
  command.add_flag("--quick", a->quick, "a short form, for tests");
  command
      .add_option("--scene", a->choice.scene,
                  fmt::format("a scene, by name or TOML file, instead of the study's own ({})", of_any_scene()))
      ->type_name("SCENE")
      ->check(not_empty());
  command.add_option("--method", a->methods, fmt::format("only these methods ({})", of_any_methods()))
      ->type_name("A,B")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_overrides(command, a->choice);
  add_output_options(command, a->output);
  command.callback([=] {
    const std::filesystem::path out = run_study(*a);
    if (a->output.format == "table" && !out.empty())
      fmt::print("to draw it: bench/run report {} --out DIR\n", base::printable(out.string()));
  });
}

}  // namespace drape::bench
