#include "bench/peers/peers.hpp"

#include <fmt/format.h>

#include <limits>
#include <optional>

#include "bench/commands/argument_checks.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/output.hpp"
#include "bench/commands/scene_choice.hpp"
#include "bench/runs/certified_reference.hpp"
#include "bench/runs/interruption.hpp"
#include "bench/runs/progress.hpp"
#include "bench/studies/peers/runs.hpp"
#include "results/file/motion_file.hpp"
#include "solver/base/atomic_file.hpp"
#include "solver/base/largest.hpp"
#include "solver/base/printable.hpp"

namespace drape::bench {
namespace {

struct PeersArguments {
  SceneChoice choice;
  std::vector<std::string> peers;
  std::vector<double> steps;
  std::string out, format = "table";
  double limit = std::numeric_limits<double>::infinity();
  double agreement = SweepOptions().agreement;
};

/// All peers with all steps. Throws std::invalid_argument if one of them cannot run the scene.
std::vector<peers::Entrant> entrants(const PeersArguments& a, const model::Scene& scene) {
  std::vector<peers::Entrant> all;
  for (const std::string& name : a.peers)
    for (const double step : a.steps) {
      if (const std::string why = reason_against(peers::peer(name), scene, step); !why.empty())
        throw std::invalid_argument(why);
      all.push_back({name, true, step});
    }
  return all;
}

/// As `score` reads it.
std::string motion_file(const model::Scene& scene, const peers::PeerMotion& motion) {
  const model::Cloth cloth = model::compile(scene);
  results::ReferenceMotion file{scene.name, motion.simulator, {{0}, {cloth.start.x}, {cloth.start.v}}, {}};
  file.motion.times.insert(file.motion.times.end(), motion.times.begin(), motion.times.end());
  for (const solver::State& y : motion.states) {
    file.motion.positions.push_back(y.x);
    file.motion.velocities.push_back(y.v);
  }
  file.uncertainty.assign(file.motion.times.size(), std::numeric_limits<double>::quiet_NaN());
  const std::vector<std::byte> bytes = results::to_bytes(file);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};  // NOLINT
}

void run_peers(const PeersArguments& a) {
  const model::Scene scene = a.choice.load();
  peers::PeerResult result{{.name = scene.name, .scene = scene, .entrants = entrants(a, scene)}};
  if (!a.out.empty()) base::require_empty_folder(a.out, "the motions");
  Progress progress(static_cast<int>(result.sheet.entrants.size()) + 1);
  const auto say = [&](const std::string& pace) { progress.report("reference of " + scene.name + ": " + pace); };
  const reference::Reference truth = References(a.agreement, {.say = say})(scene, model::compile(scene));
  progress.advance();
  result.uncertainty = base::largest(truth.error);
  std::map<std::string, std::string> files;
  for (const peers::Entrant& who : result.sheet.entrants) {
    progress.show(who.setting());
    try {
      const peers::PeerMotion motion = run_peer(peers::peer(who.name), scene, who.value, a.limit);
      result.runs.push_back({.who = who,
                             .simulator = motion.simulator,
                             .errors = errors_of(who, motion, scene, truth.trajectory, a.limit),
                             .seconds = {motion.seconds / scene.end}});
      if (!a.out.empty()) files[fmt::format("{}-{:g}.h5", who.name, who.value)] = motion_file(scene, motion);
    } catch (const peers::PeerError& error) {
      result.runs.push_back({.who = who, .reason = error.what()});
    }
    check_interruption();
    progress.advance();
  }
  print_table(peers::peer_table({result}), a.format);
  if (files.empty()) return;
  base::publish_folder(a.out, files);
  if (a.format == "table") fmt::print("\nmotions for score in {}\n", base::printable(a.out));
}

}  // namespace

void add_peers(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("peers", "run other simulators on a scene and measure them by the reference");
  const auto a = std::make_shared<PeersArguments>();
  add_scene_option(command, a->choice);
  command.add_option("--peer", a->peers, "peers; names: list peers")
      ->required()
      ->type_name("A,B")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_option("--step", a->steps, "steps in seconds, which divide a tenth of the scene's end")
      ->required()
      ->type_name("H,H")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(positive());
  add_overrides(command, a->choice);
  command.add_option("--out", a->out, "new or empty folder for the motions [none]")->type_name("DIR")->check(output_name());
  command.add_option("--time-limit", a->limit, "wall time of a run, which ends as out of time beyond it [none]")
      ->type_name("SECONDS")
      ->check(positive());
  command.add_option("--format", a->format, "what is printed")
      ->type_name("table|csv|json")
      ->check(CLI::IsMember({"table", "csv", "json"}).description(""))
      ->capture_default_str();
  add_agreement(command, a->agreement);
  command.callback([=] { run_peers(*a); });
}

}  // namespace drape::bench
