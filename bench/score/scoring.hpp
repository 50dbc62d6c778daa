#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/score/measures.hpp"
#include "bench/score/ours.hpp"
#include "bench/score/score.hpp"

namespace drape::bench {

/// An external motion, the true one, and what our methods do on the same scene. Frames are rows, and so are trials.
struct Scoring {
  model::Scene scene;
  ExternalMotion external;
  ScoreOptions options;
  TrueMotion truth;
  std::vector<FrameScore> frames;
  Ours ours;

  double size() const { return model::size(scene); }
};

/// A whole motion in numbers. Errors are over the size of the scene.
struct Summary {
  const Scoring* scoring;
  const FrameScore *worst, *last, *deepest;
  double error, maximum, mean_error, end_error, reference_error, reference_depth;
  Lag late;  ///< what is left: also over the size
  Uncertain damping;
};

/// For users.
const char* source_of_velocities(const ExternalMotion& external);
std::string in_words(const Summary& summary);

}  // namespace drape::bench
