#pragma once

#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "bench/runs/checkpoint.hpp"
#include "bench/runs/timing.hpp"
#include "bench/studies/work_precision/configurations.hpp"
#include "results/analysis/work_precision.hpp"

namespace drape::results {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Measured, error, times)

}  // namespace drape::results

namespace drape::bench {

/// A scene of the study with the positions at the times at which errors are measured.
struct Problem {
  std::string name;
  model::Scene scene;
  double length = 1;               ///< by which errors are divided [m]
  std::vector<double> times = {};  ///< the last is the end [s]
  std::vector<solver::Vectors> truth = {};
  double uncertainty = 0;          ///< of the truth, over `length`
  double growth = 0;               ///< of a small perturbation of the start; 0 if not known
  double motion = 0;               ///< largest distance of the truth from the start, as an error would be; 0 if not known
  double enough = 0;               ///< smaller errors are not sought
  std::vector<double> asked = {};  ///< errors at which the quickest is asked for, beside the usual ones
  bool in_metres = false;          ///< errors are, as the bars about other simulators' sheet have them
  bool against_sundials = false;   ///< whether the study's bars about SUNDIALS are about it
};

/// 1e-1 to 1e-7.
std::vector<double> usual_errors();

/// Whether an error is well above the uncertainty of the truth.
bool resolves(const Problem& problem, double error);

/// The usual errors that the truth of a scene resolves.
std::vector<double> levels(const Problem& problem);

/// These, and those that are asked for beside them.
std::vector<double> asked(const Problem& problem);

/// What became of a variant of a configuration.
struct ComparedRun {
  const Configuration* configuration = nullptr;
  std::size_t place = 0;  ///< of its variant in the configuration
  solver::Outcome outcome = solver::Outcome::success;
  std::string reason = {};  ///< why it does not count; empty if it does
  /// The largest error at all times; the one time of the first run, or those of repetitions.
  results::Measured measured = {std::nan(""), {}};
  std::int64_t forces = 0, factorisations = 0, steps = 0;
  bool timed = false;  ///< repeatedly

  const Variant& variant() const { return configuration->variants.at(place); }
  bool counts() const { return reason.empty(); }

  /// From now on it does not count.
  void exclude(std::string why);
};

/// In a checkpoint, to which its configuration is known.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ComparedRun, place, outcome, reason, measured, forces, factorisations, steps)

/// How long a study may take, and what times are.
struct Effort {
  Limits limits = {.seconds = 1};  ///< of a run
  int repetitions = 7;             ///< of those near a front; fewer of slow ones
  TimeOf time_of = TimeOf::process;
};

/// Runs every variant once, from coarse to fine until it takes too long or is more exact than the truth.
std::vector<ComparedRun> run_all(const Problem& problem, const std::vector<Configuration>& configurations, const Effort& effort,
                                 Checkpoint& checkpoint);

/// Whose runs are compared with those of others: configurations that are taken together.
using Contender = std::function<bool(const Configuration&)>;

/// One of our methods, with automatic stages and linear solvers, and what controls its accuracy.
struct DefaultChoice {
  const solver::Method* method = nullptr;  ///< null: none
  Control control = {};

  bool operator==(const DefaultChoice&) const = default;
  bool operator()(const Configuration& configuration) const {
    return configuration.is_default() && *this == DefaultChoice{configuration.by_default, configuration.control};
  }

  /// "bdf2 by step"; empty if it is none.
  std::string name() const;
};

/// Configurations of one code.
Contender of_code(Code code);

/// The configuration of this name, or this one.
Contender named(const std::string& name);
Contender only(const Configuration& configuration);

/// Times what is near the front of any of these, all interleaved: all of ours, of SUNDIALS, every code, our implicit methods,
/// our defaults and each of them, and the configurations that are named.
void time_fronts(const Problem& problem, std::vector<ComparedRun>& runs, const Effort& effort,
                 const std::set<std::string>& names, Checkpoint& checkpoint);

/// The same of some contenders.
void time_fronts(const Problem& problem, const std::vector<Contender>& who, std::vector<ComparedRun>& runs,
                 const Effort& effort, Checkpoint& checkpoint);

/// The quickest run of a contender with an error of at most `error`, of those that were timed repeatedly; null if there is
/// none.
const ComparedRun* quickest(const Contender& contender, const std::vector<ComparedRun>& runs, double error);

}  // namespace drape::bench
