#pragma once

#include <optional>
#include <vector>

#include "bench/runs/observer.hpp"
#include "reference/reference.hpp"
#include "results/run_record.hpp"
#include "solver/dense_output.hpp"
#include "solver/integrator.hpp"

namespace drape::bench {

/// How much a reference moves, at its times, but no less than a scene that moves by a thousandth of its size in the whole run.
struct MotionScale {
  double distance;  ///< largest rms distance from the start [m]
  double velocity;  ///< largest rms velocity [m/s]
  double energy;    ///< largest sum of kinetic energy and change of potential energy [J]
};
MotionScale motion_scale(const model::Cloth& cloth, const reference::Trajectory& trajectory, double size);

double total_energy(const model::Cloth& cloth, double t, const solver::State& y);

/// The states of a run at given times, taken out of its steps.
class Samples : public Observer {
 public:
  explicit Samples(std::vector<double> times) : times_(std::move(times)) {}

  void begin(const model::Scene&, const model::Cloth&, const solver::State& start) override {
    dense_.emplace(times_, 0, start);
  }
  void observe(const solver::StepReport& step) override { dense_->see(step.t, step.y); }

  /// At all times that were reached.
  const std::vector<solver::State>& states() const { return dense_->states; }

 private:
  const std::vector<double> times_;
  std::optional<solver::DenseOutput> dense_;
};

/// Distance of a run from a reference of its scene: `states` are the run's at all of the reference's times.
results::MotionErrorRecord motion_error(const std::vector<solver::State>& states, const reference::Reference& reference,
                                        const model::Scene& scene, const model::Cloth& cloth);

}  // namespace drape::bench
