#pragma once

#include <functional>
#include <string>

#include "model/cloth.hpp"
#include "solver/integrator.hpp"

namespace drape::bench {

/// What looks at a run while it runs. It may end the run by throwing Ending.
class Observer {
 public:
  Observer() = default;
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;
  virtual ~Observer() = default;

  /// The start of the run and of each later phase, at `cloth.begin`; the scene is that of the phase. Both live until finish()
  /// has returned.
  virtual void begin(const model::Scene&, const model::Cloth&, const solver::State&) {}

  /// An accepted step.
  virtual void observe(const solver::StepReport& step) = 0;

  /// The end of a run that had a start, however it ended.
  virtual void finish() {}

  /// What is to be said of a run that has succeeded; empty if nothing.
  virtual std::string remark() const { return {}; }
};

/// How an observer ends a run.
struct Ending {
  solver::Outcome outcome;
  std::string message;
  double last_good_time;  ///< [s]
};

/// A function that sees the start, as a step of no length, and every accepted step.
class FunctionObserver : public Observer {
 public:
  explicit FunctionObserver(solver::Observer function) : function_(std::move(function)) {}
  void begin(const model::Scene&, const model::Cloth& cloth, const solver::State& start) override {
    function_({cloth.begin, 0, 0, 0, start, {}});
  }
  void observe(const solver::StepReport& step) override { function_(step); }

 private:
  solver::Observer function_;
};

}  // namespace drape::bench
