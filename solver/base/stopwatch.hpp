#pragma once

#include <chrono>

namespace drape::base {

/// Adds the wall time of its life to a sum [ms]; reads no clock if that is null. Two readings cost some 50 ns.
class Stopwatch {
 public:
  explicit Stopwatch(double* sum) : sum_(sum) {
    if (sum_ != nullptr) begin_ = Clock::now();
  }
  ~Stopwatch() {
    if (sum_ != nullptr) *sum_ += std::chrono::duration<double, std::milli>(Clock::now() - begin_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  using Clock = std::chrono::steady_clock;

  double* sum_;
  Clock::time_point begin_;
};

}  // namespace drape::base
