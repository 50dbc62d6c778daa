#pragma once

#include <optional>
#include <vector>

#include "bench/runs/observer.hpp"
#include "model/sheet/edges.hpp"
#include "results/run_record.hpp"
#include "solver/dense_output.hpp"

namespace drape::bench {

/// Throws std::invalid_argument, naming the option, if there are too many frames so far apart up to the end [s].
void check_frames(const char* option, double every, double end);

/// Multiples of `every` after the beginning, up to the end [s].
std::vector<double> frame_times(double every, double begin, double end);

/// Takes the motion out of a run at multiples of `every` [s], beginning with the start, by dense output of its steps.
class TrajectoryObserver : public Observer {
 public:
  explicit TrajectoryObserver(double every) : every_(every) {}

  void begin(const model::Scene& scene, const model::Cloth& cloth, const solver::State& start) override;
  void observe(const solver::StepReport& step) override { output_->observe(step.t, step.y); }

  void finish() override;

  /// All frames that were reached; nothing if the run had no start. To be called once.
  std::optional<results::TrajectoryRecord> result() { return std::move(record_); }

 private:
  double every_;
  const model::Scene* scene_ = nullptr;
  const model::Cloth* cloth_ = nullptr;
  std::vector<model::Edge> edges_;
  void keep_phase();
  void keep(double t, const solver::State& y);

  std::vector<double> times_;  ///< of the phase, after its start [s]
  std::optional<solver::DenseOutput> output_;
  std::optional<results::TrajectoryRecord> record_;
};

}  // namespace drape::bench
