#pragma once

#include <vector>

#include "model/cloth.hpp"
#include "results/run_record.hpp"
#include "solver/dense_output.hpp"

namespace drape::bench {

/// Throws std::invalid_argument, naming the option, if there are too many frames so far apart up to the end [s].
void check_frames(const char* option, double every, double end);

/// Multiples of `every` after the start, up to the end [s].
std::vector<double> frame_times(double every, double end);

/// Takes the motion out of a run at multiples of `every` [s], beginning with the start, by dense output of its steps.
class TrajectoryWatch {
 public:
  TrajectoryWatch(const model::Scene& scene, const model::Cloth& cloth, double every);
  TrajectoryWatch(const TrajectoryWatch&) = delete;

  /// The end of the next step.
  void see(double t, const solver::State& y) { output_.see(t, y); }

  /// All frames that were reached.
  results::TrajectoryRecord result() const;

 private:
  const model::Scene& scene_;
  const model::Cloth& cloth_;
  solver::State start_;
  std::vector<double> times_;  ///< after the start [s]
  solver::DenseOutput output_;
};

}  // namespace drape::bench
