#include "bench/runs/identity.hpp"

#include <fmt/format.h>

#include "model/garment.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/hash.hpp"
#include "solver/base/threads.hpp"

namespace drape::bench {
namespace {

std::string all_of(const solver::Options& o, int threads) {
  return fmt::format("{} {} {} {} {} {} {}\n{} {} {}\n{} {} {} {} {}\n{} {} {}x{}\n{} {} {}\n", o.loop_tolerance,
                     o.cg_tolerance, o.max_updates, o.max_cg_iterations, o.verlet_fraction, o.stage_accuracy, threads,
                     o.control.min_updates, o.control.max_updates, o.control.factor, o.error_control.tolerance,
                     o.error_control.length, o.error_control.duration, o.error_control.global, o.error_control.most_steps,
                     o.stage->name, o.linear_solver->name, o.sub_steps, o.sweeps, o.passes, o.chebyshev_radius,
                     o.ends_at_kinks);
}

}  // namespace

std::string identity(const RunSpec& spec, const SweepOptions& options) {
  const std::string errors = options.reference ? fmt::format("errors to {}", options.agreement) : "no errors";
  const std::string frames = options.frames_every ? fmt::format("\nframes every {} s", *options.frames_every) : "";
  return base::long_hash_text(fmt::format("{}\n{} {}\n{}{}{}", model::to_toml(spec.scene), spec.method->name, spec.step,
                                          all_of(spec.options, base::threads_for(model::nodes(spec.scene))), errors, frames));
}

std::string identity(const std::vector<Group>& groups, const SweepOptions& options) {
  std::string all =
      fmt::format("{} times, {} s, {} MB\n", options.repetitions, options.limits.seconds, options.limits.megabytes);
  for (const Group& group : groups) {
    for (const RunSpec& spec : group) all += identity(spec, options) + ' ';
    all += '\n';
  }
  return base::long_hash_text(all);
}

}  // namespace drape::bench
