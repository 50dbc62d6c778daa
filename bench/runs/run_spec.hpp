#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/scene.hpp"
#include "results/run_record.hpp"
#include "solver/methods.hpp"
#include "solver/options.hpp"

namespace drape::bench {

/// One run: a scene, a method, a step. `scene.end` is the time it runs to.
struct RunSpec {
  model::Scene scene;
  std::string overrides;  ///< what differs from the scene's file, as text for users
  const solver::Method* method;
  double step;  ///< [s]
  solver::Options options;
  std::optional<results::ChoiceRecord> choice = {};  ///< if the program chose method, step and solvers

  /// The method with its sub-steps, sweeps, stage and linear solvers where they are not the usual ones: "bdf2",
  /// "bdf2/fixed-point/ic0", "xpbd/1x20".
  std::string method_name() const;
};

/// Sets method, stage and linear solver from a name like that. Throws std::invalid_argument with all that there is to choose
/// from.
void choose_method(RunSpec& spec, const std::string& name);

/// Whether obstacles answer by altering positions in an implicit equation, which explicit methods do not have.
bool alters_positions(const model::Scene& scene);

/// Why a method cannot run on a scene, in a few words; empty if it can.
std::string reason_against(const solver::Method& method, const model::Scene& scene);

/// Runs that are compared with each other: repetitions are interleaved within a group and it is recorded as a whole.
using Group = std::vector<RunSpec>;

}  // namespace drape::bench
