#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "bench/runs/observer.hpp"
#include "solver/dense_output.hpp"

namespace drape::bench {

/// The states of a run at given times, taken out of its steps.
class Samples : public Observer {
 public:
  explicit Samples(std::vector<double> times) : times_(std::move(times)) {}

  void begin(const model::Scene&, const model::Cloth&, const solver::State& start) override {
    dense_.emplace(times_, 0, start);
  }
  void observe(const solver::StepReport& step) override { dense_->observe(step.t, step.y); }

  /// At all times that were reached.
  const std::vector<solver::State>& states() const& { return dense_->states; }
  std::vector<solver::State> states() && { return std::move(dense_->states); }

 private:
  const std::vector<double> times_;
  std::optional<solver::DenseOutput> dense_;
};

}  // namespace drape::bench
