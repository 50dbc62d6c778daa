#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/score/measures.hpp"
#include "bench/studies/work_precision/runs.hpp"

namespace drape::bench {

/// Those of our methods that stand beside another simulator unless others are asked for.
inline const std::vector<std::string> usual_methods{"imex-euler", "implicit-euler", "sbdf2", "bdf2", "midpoint", "verlet"};

/// The runs of one method that answer two questions; null where none does.
struct Answers {
  const ComparedRun* as_right = nullptr;  ///< the quickest that is at most as wrong
  const ComparedRun* at_cost = nullptr;   ///< the least wrong one that takes at most as long, if that is known
};

/// Our methods with many steps on the scene of another simulator, to its last frame.
struct Ours {
  std::vector<Configuration> configurations;
  std::vector<ComparedRun> runs;
  std::vector<Answers> answers;  ///< of each configuration
  Answers best;                  ///< of all
};

/// The error of a motion is the largest of its frames' rms, as in the study work-precision; or what the reference is uncertain
/// by, if that is more: no method can be told to be better [m].
double known_error(const std::vector<FrameScore>& frames);

/// Tries the methods from coarse to fine until they are well below the error, or, if its cost [s] is known, take well longer
/// than that; what may be the quickest is timed, interleaved.
Ours try_ours(const TrueMotion& truth, const std::vector<FrameScore>& frames, const std::vector<std::string>& methods,
              std::optional<double> cost, int repetitions, Checkpoint& checkpoint);

/// Throws std::invalid_argument if one of the methods does not exist or cannot do the scene.
void check_methods(const std::vector<std::string>& methods, const model::Scene& scene);

}  // namespace drape::bench
