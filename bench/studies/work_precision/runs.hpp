#pragma once

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "bench/runs/checkpoint.hpp"
#include "bench/runs/timing.hpp"
#include "bench/studies/work_precision/candidates.hpp"
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
  std::vector<double> asked = {};  ///< errors at which somebody asks for the quickest, beside the usual ones
};

/// Of 1e-1 to 1e-7 the errors that the truth of a scene resolves.
std::vector<double> levels(const Problem& problem);

/// These, and those that are asked for besides.
std::vector<double> asked(const Problem& problem);

/// What became of a candidate of a family.
struct Trial {
  const Family* family = nullptr;
  std::size_t candidate = 0;        ///< its place in the family
  std::string outcome = "success";  ///< or why it failed
  /// The largest error at all times; the one time of the first run, or those of repetitions.
  results::Measured measured = {std::nan(""), {}};
  bool timed = false;  ///< repeatedly
  std::int64_t forces = 0, factorisations = 0, steps = 0;

  const Candidate& configuration() const { return family->candidates.at(candidate); }
};

/// As a unit of work, to which its family is known.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Trial, candidate, outcome, measured, forces, factorisations, steps)

/// How long a study may take, and what times are.
struct Effort {
  double cap = 1;       ///< time of a run before it is given up [s]
  int repetitions = 7;  ///< of those near a front; fewer of slow ones
  TimeOf time_of = TimeOf::process;
};

/// Runs every candidate once, from coarse to fine until it takes too long or is more exact than the truth.
std::vector<Trial> try_all(const Problem& problem, const std::vector<Family>& families, const Effort& effort,
                           Checkpoint& checkpoint);

/// Whose results are compared: a name and the trials that belong to it.
struct Contender {
  std::string name;
  std::vector<std::size_t> members;
};

/// "ours": all that the program offers; of that "implicit", "explicit", "thesis", "defaults" (automatic stages and linear
/// solvers) and of these each method, "default bdf2 by steps"; "sundials": all of SUNDIALS, and each of its packages; and every
/// family, by its name.
std::vector<Contender> contenders(const std::vector<Trial>& trials);

/// Times what is near the front of any contender, all interleaved; of the families only those that are named.
void time_fronts(const Problem& problem, std::vector<Trial>& trials, const Effort& effort, const std::set<std::string>& named,
                 Checkpoint& checkpoint);

/// The same of some contenders.
void time_fronts(const Problem& problem, const std::vector<Contender>& who, std::vector<Trial>& trials, const Effort& effort,
                 Checkpoint& checkpoint);

/// The trials of a contender as they were measured repeatedly; the others count as failed.
std::vector<results::Measured> timed(const Contender& contender, const std::vector<Trial>& trials);

}  // namespace drape::bench
